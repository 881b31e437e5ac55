// SPDX-License-Identifier: Apache-2.0
// Every specialisation of the projection shaders that a plan can ask for compiles.
#include <set>
#include <string>

#include "projection/gl_mesh_walk.h"
#include "projection/gl_tet_codes.h"
#include "projection_fixture.h"

namespace lamina {
namespace {

using ProjectionShaders = gl::GlTest;

std::vector<ProjectPlan> geometry_plans() {
    std::vector<ProjectPlan> plans;
    for (int bits = 0; bits < 16; ++bits) {
        ProjectPlan plan;
        plan.geometry = (bits & 1) != 0 ? ProjectGeometry::triangles : ProjectGeometry::silhouette;
        plan.orthographic = (bits & 2) != 0;
        plan.thickness = (bits & 4) != 0 ? Thickness::dz : Thickness::exact;
        plan.interpolation = (bits & 8) != 0 ? Interpolation::linear : Interpolation::perspective;
        if (plan.geometry == ProjectGeometry::silhouette &&
            plan.interpolation == Interpolation::linear)
            continue;
        plans.push_back(plan);
    }
    return plans;
}

std::vector<ProjectPlan> output_plans() {
    std::vector<ProjectPlan> plans(1);
    for (const ProjectDither dither : {ProjectDither::alpha, ProjectDither::after_blend}) {
        ProjectPlan plan;
        plan.target = Target::fixed8;
        plan.dither = dither;
        if (dither == ProjectDither::after_blend) plan.blending = Blending::registers;
        plans.push_back(plan);
    }
    for (const AlphaRounding rounding :
         {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
        for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
            ProjectPlan plan;
            plan.target = Target::emulated;
            plan.emulation = Emulation{8, rounding, over, 1};
            plan.blending = Blending::registers;
            plans.push_back(plan);
        }
    }
    return plans;
}

std::vector<ProjectPlan> lit_plans() {
    Lighting matt;
    matt.specular = 0;
    Lighting two;
    two.lights.push_back({glm::dvec3(1, 2, 3), {1, .5, .2}});
    std::vector<ProjectPlan> plans;
    for (const Lighting& lighting : {Lighting{}, matt, two}) {
        for (const bool orthographic : {false, true}) {
            ProjectPlan plan;
            plan.orthographic = orthographic;
            plan.lighting = lighting;
            plan.lighting->smallest_gradient = 1;
            plans.push_back(plan);
        }
    }
    return plans;
}

TEST_F(ProjectionShaders, EveryPlanCompiles) {
    const TransferFunction transfer_function =
        TransferFunction::linear({knot(0, {1, 0, 0}, .2), knot(.5, {1, 1, 0}, .2),
                                  knot(.5, {0, 1, 0}, .4), knot(1, {0, 0, 1}, .9)});
    std::set<std::string> seen;
    TableCache cache;
    const auto compile = [&](ProjectPlan plan, const SegmentSource source, bool single_color,
                             bool filtered, int lengths) {
        const bool values = source == SegmentSource::mean || source == SegmentSource::vertices;
        const bool fan_of_parts =
            source == SegmentSource::parts && plan.geometry == ProjectGeometry::triangles;
        if (fan_of_parts || (values && plan.geometry == ProjectGeometry::silhouette)) return;
        plan.source = source;
        plan.range = {0, 1};
        plan.single_color = single_color;
        plan.table_filtered = filtered;
        TableRequest& request = plan.table.request;
        request.colored = !single_color;
        if (source == SegmentSource::table) {
            request.kind = TableKind::uniform;
            request.scalar_nodes = 16;
            request.length_layers = lengths;
        } else {
            request.scalar_nodes = 32;
            request.length_layers = single_color ? 1 : lengths;
        }
        plan.table.built = cache.get(transfer_function, request);
        const GlProjectTables tables(transfer_function, plan);
        if (plan.blending == Blending::registers) {
            if (values) return;  // only triangles have them
            const gl::Defines defines = tet_code_defines(plan, tables);
            if (!seen.insert(gl::compose_shader("projection/codes.comp", defines).text).second)
                return;
            EXPECT_NO_THROW(gl::Program("projection/codes.comp", defines));
            return;
        }
        for (const FragmentKind kind :
             {FragmentKind::thin, FragmentKind::plain, FragmentKind::careful}) {
            const bool fan = plan.geometry == ProjectGeometry::triangles;
            if (!has_program(plan, kind)) continue;
            gl::Defines defines = project_defines(plan, kind);
            tables.set_defines(defines);
            const char* const vertex = fan ? "projection/fan.vert" : "projection/silhouette.vert";
            if (!seen.insert(gl::compose_shader(vertex, defines).text +
                             gl::compose_shader("projection/tet.frag", defines).text)
                     .second)
                continue;
            EXPECT_NO_THROW(gl::Program(vertex, "projection/tet.frag", defines));
        }
    };
    const std::vector sources{SegmentSource::constant, SegmentSource::table,
                              SegmentSource::parts,    SegmentSource::cut_table,
                              SegmentSource::analytic, SegmentSource::mean,
                              SegmentSource::vertices};
    for (const SegmentSource source : sources) {
        for (const bool single_color : {false, true})
            for (const bool filtered : {false, true})
                for (const int lengths : {1, 4})
                    compile(ProjectPlan{}, source, single_color, filtered, lengths);
        for (const ProjectPlan& plan : geometry_plans()) compile(plan, source, false, true, 4);
    }
    for (const ProjectPlan& plan : output_plans())
        for (const SegmentSource source : sources) compile(plan, source, false, true, 4);
    for (ProjectPlan plan : output_plans()) {  // leaves of trees, with every source in one colour
        plan.tree = {4};
        for (const SegmentSource source : sources) compile(plan, source, true, true, 1);
    }
    for (ProjectPlan plan : geometry_plans()) {
        plan.windowed = plan.blocks = true;
        for (const SegmentSource source :
             {SegmentSource::table, SegmentSource::cut_table, SegmentSource::analytic})
            compile(plan, source, false, true, 4);
    }
    const std::size_t unlit = seen.size();
    for (ProjectPlan plan : lit_plans()) {
        for (const SegmentSource source : {SegmentSource::parts, SegmentSource::analytic})
            for (const bool filtered : {false, true}) compile(plan, source, false, filtered, 1);
        plan.windowed = true;
        compile(plan, SegmentSource::analytic, false, false, 1);
    }
    for (ProjectPlan plan : output_plans()) {
        plan.lighting = lit_plans().front().lighting;
        compile(plan, SegmentSource::parts, false, true, 1);
    }
    const std::size_t drawn = seen.size();
    const auto compile_walk = [&](ProjectPlan plan, SegmentSource source, bool single_color,
                                  bool filtered) {
        plan.walk = true;
        plan.blocks = plan.orthographic;
        plan.source = source;
        plan.range = {0, 1};
        plan.single_color = single_color;
        plan.table_filtered = filtered;
        TableRequest& request = plan.table.request;
        request.colored = !single_color;
        request.kind = source == SegmentSource::table ? TableKind::uniform : TableKind::knots;
        request.scalar_nodes = 32;
        request.length_layers = single_color ? 1 : 4;
        plan.table.built = cache.get(transfer_function, request);
        const GlProjectTables tables(transfer_function, plan);
        for (const bool copies : {false, true}) {
            const gl::Defines defines = walk_defines(plan, tables, copies);
            if (!seen.insert(gl::compose_shader("projection/walk.comp", defines).text).second)
                continue;
            EXPECT_NO_THROW(gl::Program("projection/walk.comp", defines));
        }
    };
    for (const SegmentSource source :
         {SegmentSource::constant, SegmentSource::table, SegmentSource::parts,
          SegmentSource::cut_table, SegmentSource::analytic}) {
        for (const bool orthographic : {false, true})
            for (const bool single_color : {false, true})
                for (const bool filtered : {false, true}) {
                    ProjectPlan plan;
                    plan.orthographic = orthographic;
                    compile_walk(plan, source, single_color, filtered);
                }
    }
    for (const ProjectPlan& plan : lit_plans())
        for (const SegmentSource source : {SegmentSource::parts, SegmentSource::analytic})
            compile_walk(plan, source, false, true);
    EXPECT_GT(seen.size(), drawn + 60);
    EXPECT_GT(seen.size(), unlit + 50);
    EXPECT_GT(unlit, 200u);
}

}  // namespace
}  // namespace lamina
