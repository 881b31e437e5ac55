// SPDX-License-Identifier: Apache-2.0
// Specialisations of the slicing shaders that a plan can ask for. It is enough to test all kinds of
// segments with one way of compositing, and all ways of compositing with two kinds of segments,
// because the text of neither depends on the other. glslangValidator compiles all kinds of segments
// in slabs and in leaves of trees; Mesa, which takes much longer, in slabs alone.
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "executors/gl_code_tree.h"
#include "slicing/gl_shader_tree.h"
#include "slicing/gl_slice_renderer.h"
#include "slicing_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

constexpr int table_nodes = 256;

struct Specialisation {
    std::vector<const char*> shaders;  // a vertex and a fragment shader, or a compute shader
    gl::Defines defines;

    gl::ShaderSources sources() const {
        gl::ShaderSources composed;
        for (const char* name : shaders) composed.push_back(gl::compose_shader(name, defines));
        return composed;
    }
};
// The specialisations, by text: different plans may need the same text, which is compiled once.
struct Specialisations {
    std::map<std::string, Specialisation> by_text;
    // Names and definitions that were added: quicker to compare than texts.
    std::set<std::string> asked;
};

void add(Specialisations& all, std::vector<const char*> shaders, const gl::Defines& defines) {
    std::string names = fmt::format("{}", fmt::join(shaders, " "));
    for (const auto& [name, value] : defines.list) names += fmt::format("\n{} {}", name, value);
    if (!all.asked.insert(names).second) return;
    const Specialisation added{std::move(shaders), defines};
    std::string text;
    for (const gl::ShaderSource& source : added.sources()) text += source.text;
    all.by_text.try_emplace(text, added);
}

// Adds lit plans. Light depends on rays and samples, but not on how samples are stored.
void add_lit_plans(std::vector<SlicePlan>& plans) {
    for (int bits = 0; bits < 16; ++bits) {
        for (const int lights : {1, 2, Lighting::most_lights}) {
            SlicePlan plan;
            plan.classification = Classification::exact;
            plan.orthographic = (bits & 1) != 0;
            plan.precise_rays = (bits & 2) != 0;
            plan.nan_transparent = plan.float_texture = plan.orthographic;
            plan.lighting.emplace().lights.resize(static_cast<std::size_t>(lights));
            if ((bits & 4) != 0) plan.lighting->specular = 0;
            if ((bits & 8) != 0) plan.lighting->lights.back().color = {1, .5, .25};
            plans.push_back(plan);
            for (const Classification each :
                 {Classification::post, Classification::preintegrated}) {
                plan.classification = each;
                plan.table.request.lit = true;
                plan.table.request.length_layers = (bits & 1) != 0 ? 5 : 1;
                plan.table_filtered = (bits & 2) != 0;
                plans.push_back(plan);
            }
        }
    }
}

std::vector<SlicePlan> every_segment_plan() {
    std::vector<SlicePlan> plans;
    for (const VolumeSampling sampling : {VolumeSampling::none, VolumeSampling::fetch,
                                          VolumeSampling::filtered, VolumeSampling::hardware}) {
        for (int bits = 0; bits < 256; ++bits) {
            SlicePlan plan;
            plan.sampling = sampling;
            plan.orthographic = (bits & 1) != 0;
            plan.single_color = (bits & 2) != 0;
            plan.nan_transparent = (bits & 4) != 0;
            plan.classification =
                (bits & 8) != 0 ? Classification::preintegrated : Classification::post;
            plan.table_filtered = (bits & 16) != 0;
            plan.table.request.colored = !plan.single_color;
            plan.table.request.length_layers = (bits & 32) != 0 ? 5 : 1;
            plan.precise_rays = (bits & 64) != 0;
            plan.linear = (bits & 128) != 0;
            plans.push_back(plan);
            // Clip planes affect only rays, so few plans with them are needed.
            if ((bits & ~(1 + 8 + 64)) != 0) continue;
            plans.push_back(plan);
            plans.back().clip.resize(1);
        }
    }
    for (int bits = 0; bits < 64; ++bits) {
        SlicePlan plan;
        plan.classification = Classification::exact;
        plan.orthographic = (bits & 1) != 0;
        plan.single_color = (bits & 2) != 0;
        plan.nan_transparent = (bits & 4) != 0;
        plan.float_texture = (bits & 8) != 0;
        plan.precise_rays = (bits & 16) != 0;
        plan.rays.blocks = plan.single_color;
        plan.nearest = (bits & 32) != 0;
        plans.push_back(plan);
    }
    add_lit_plans(plans);
    return plans;
}

// Returns a plan with almost everything that segments can need, and one with almost nothing, of one
// colour, as trees of fixed-point nodes need it.
std::vector<SlicePlan> two_segment_plans() {
    SlicePlan most;
    most.classification = Classification::preintegrated;
    most.nan_transparent = true;
    most.clip.resize(38);
    most.rays.blocks = true;
    SlicePlan least;
    least.sampling = VolumeSampling::none;
    least.precise_rays = false;
    least.orthographic = true;
    least.single_color = true;
    return {most, least};
}

std::vector<Emulation> every_emulation() {
    std::vector<Emulation> emulations;
    for (const int bits : {8, 16}) {
        for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
            for (const AlphaRounding alpha :
                 {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
                emulations.push_back({bits, alpha, over, 1});
            }
        }
    }
    return emulations;
}

std::vector<SlicePlan> with_every_dither(const SlicePlan& plan) {
    std::vector<SlicePlan> plans(3, plan);
    plans[1].dither = Dither{};
    plans[2].dither = Dither{.color = true, .increment = 3};
    return plans;
}

// Returns plans without a tree, and with a tree of fixed-point nodes, in all ways of compositing.
std::vector<SlicePlan> every_code_plan() {
    std::vector<SlicePlan> plans, plain;
    for (const SlicePlan& segments : two_segment_plans()) {
        for (const Target target : {Target::float32, Target::fixed8, Target::fixed16}) {
            plain.push_back(segments);
            plain.back().target = target;
        }
        for (const Emulation& emulation : every_emulation()) {
            for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                plain.push_back(segments);
                plain.back().target = Target::emulated;
                plain.back().emulation = emulation;
                plain.back().order = order;
            }
        }
    }
    for (const SlicePlan& plan : plain) {
        for (const SlicePlan& dithered : with_every_dither(plan)) {
            if (dithered.dither && dithered.target == Target::float32) continue;
            plans.push_back(dithered);
            if (!dithered.single_color || dithered.target == Target::float32) continue;
            plans.push_back(dithered);
            plans.back().tree = TreePlan{.factors = {4}, .nodes = NodeArithmetic::fixed};
        }
    }
    return plans;
}

// Returns plans with a tree of nodes in float.
std::vector<SlicePlan> every_node_plan(const SlicePlan& segments) {
    std::vector<SlicePlan> plans;
    for (const NodeCode code : {NodeCode::minimax, NodeCode::phi, NodeCode::alpha}) {
        for (const Target target : {Target::float32, Target::fixed8}) {
            for (const int alpha_bits : {8, 16}) {
                for (const int bricks : {1, 2}) {
                    plans.push_back(segments);
                    plans.back().target = target;
                    plans.back().tree =
                        TreePlan{.factors = {4}, .code = code, .alpha_bits = alpha_bits};
                    plans.back().bricks.resize(static_cast<std::size_t>(bricks));
                    for (const bool ends_early : {false, true}) {
                        plans.push_back(plans.back());
                        plans.back().occupied_only = true;
                        if (ends_early) plans.back().opaque_depth = 9;
                    }
                }
            }
        }
    }
    return plans;
}

// Return plans in which exact segments become codes, and nodes of several bricks.
SlicePlan exact_codes(bool lit) {
    SlicePlan plan;
    plan.classification = Classification::exact;
    if (lit) plan.lighting.emplace();
    plan.target = Target::emulated;
    plan.emulation = Emulation{16, AlphaRounding::stochastic, OverRounding::separate, 1};
    return plan;
}

SlicePlan exact_nodes(bool lit) {
    SlicePlan plan;
    plan.classification = Classification::exact;
    if (lit) plan.lighting.emplace();
    plan.rays = lit ? RayDispatch{128, true, true, true} : RayDispatch{32, false, false, true};
    plan.tree = TreePlan{.factors = {4}};
    plan.occupied_only = true;
    plan.opaque_depth = 9;
    plan.bricks.resize(2);
    return plan;
}

void add_slabs(Specialisations& all) {
    for (const SlicePlan& plan : every_segment_plan()) {
        for (const int intervals : {1, 6}) {
            const gl::Defines segments =
                segment_defines(plan, intervals, table_nodes, intervals > 1);
            add(all, {"slicing/slab.vert", "slicing/slab.frag"}, slab_defines(plan, segments));
        }
    }
    for (const bool lit : {false, true}) {
        add(all, {"slicing/codes.comp"},
            slab_defines(exact_codes(lit),
                         segment_defines(exact_codes(lit), 6, table_nodes, true)));
    }
    for (const SlicePlan& plan : every_code_plan()) {
        const gl::Defines defines = slab_defines(plan, segment_defines(plan, 6, table_nodes, true));
        if (plan.emulation) {
            add(all, {"slicing/codes.comp"}, defines);
            if (!plan.tree) continue;
            add(all, {"slicing/swizzle.comp"}, code_tree_defines(plan));
            add(all, {"slicing/colorize.comp"}, code_tree_defines(plan));
            continue;
        }
        add(all, {"slicing/slab.vert", "slicing/slab.frag"}, defines);
        if (!plan.has_tree(NodeArithmetic::fixed)) continue;
        add(all, {"gl/full_screen.vert", "slicing/swizzle.frag"}, swizzle_defines(plan));
        add(all, {"gl/full_screen.vert", "slicing/colorize.frag"}, {});
    }
}

enum class LeafSegments { two, every };

void add_nodes(Specialisations& all, LeafSegments leaves) {
    const auto add_leaf = [&](const SlicePlan& plan, int intervals, NodePlace place) {
        const gl::Defines segments = segment_defines(plan, intervals, table_nodes, intervals > 1);
        add(all, {"slicing/leaf.comp"}, leaf_defines(plan, segments, place));
    };
    const bool every = leaves == LeafSegments::every;
    for (SlicePlan plan : every ? every_segment_plan() : std::vector<SlicePlan>()) {
        plan.tree = TreePlan{.factors = {4}};
        for (const int intervals : {1, 6}) add_leaf(plan, intervals, NodePlace::inner);
        plan.occupied_only = true;
        plan.opaque_depth = 9;
        add_leaf(plan, 6, NodePlace::inner);
    }
    for (const bool lit : {false, true}) add_leaf(exact_nodes(lit), 6, NodePlace::inner);
    for (const SlicePlan& segments : two_segment_plans()) {
        for (const SlicePlan& plan : every_node_plan(segments)) {
            for (const NodePlace place : {NodePlace::inner, NodePlace::root}) {
                add_leaf(plan, 6, place);
                const gl::Defines node = node_defines(plan, place);
                add(all, {"slicing/node.comp"}, node);
            }
        }
    }
}

void expect_to_compile(const Specialisations& all) {
    for (const auto& [text, program] : all.by_text) EXPECT_NO_THROW(gl::Program(program.sources()));
}

TEST_F(SlicingTest, EverySlabShaderCompiles) {
    Specialisations all;
    add_slabs(all);
    EXPECT_GE(all.by_text.size(), 600u);  // the plans above ask for different texts
    expect_to_compile(all);
}

TEST_F(SlicingTest, NodeShadersCompileWithTwoKindsOfSegments) {
    Specialisations all;
    add_nodes(all, LeafSegments::two);
    EXPECT_GE(all.by_text.size(), 60u);
    expect_to_compile(all);
}

TEST(SlicingShaders, EverySpecialisationPassesGlslang) {
    if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "no glslangValidator";
    Specialisations all;
    add_slabs(all);
    add_nodes(all, LeafSegments::every);
    EXPECT_GE(all.by_text.size(), 1050u);
    // Programs share stages, so each text is tested once.
    std::map<std::string, std::string> extensions;
    for (const auto& [text, program] : all.by_text) {
        for (const gl::ShaderSource& source : program.sources()) {
            extensions.try_emplace(source.text,
                                   std::filesystem::path(source.name).extension().string());
        }
    }
    TemporaryFolder folder;
    std::string files;
    int number = 0;
    for (const auto& [text, extension] : extensions) {
        const auto file = folder / (std::to_string(number++) + extension);
        write_bytes_to(file, text);
        files += file.string() + "\n";
    }
    write_bytes_to(folder / "files", files);
    const std::string command = "xargs glslangValidator < '" + (folder / "files").string() +
                                "' > '" + (folder / "log").string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_bytes_of(folder / "log");
}

}  // namespace
}  // namespace lamina
