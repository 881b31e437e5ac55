// SPDX-License-Identifier: Apache-2.0
// Pictures of the cpu engine against OpenGL's, for every source of colours and opacities.
#include <algorithm>

#include "projection_fixture.h"
#include "scene/camera.h"
#include "support/split_box.h"

namespace lamina {
namespace {

TransferFunction crooked() {
    return TransferFunction::linear({knot(0, {0, .2, 1}, .2), knot(.3, {0, 1, .3}, 1),
                                     knot(.4, {1, 1, 0}, 0), knot(.45, {1, 1, 0}, 0),
                                     knot(.5, {1, .2, 1}, 9), knot(.55, {1, 0, 0}, .1),
                                     knot(.7, {.3, 0, 1}, .1), knot(.7, {1, .6, 0}, 2)});
}

TransferFunction of_one_color() {
    return TransferFunction::linear({knot(0, {.9, .5, .2}, .1), knot(.4, {.9, .5, .2}, 0),
                                     knot(.5, {.9, .5, .2}, 4), knot(1, {.9, .5, .2}, 1)});
}

// Statistics of the largest difference in each pixel, full scale being 1: its 99.9th percentile,
// and the number of pixels above .001.
struct Difference {
    double p999;
    int above_thousandth;
};

Difference difference(const Image& a, const Image& b) {
    std::vector<double> worst;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        double most = 0;
        for (std::size_t channel = 0; channel < 4; ++channel)
            most = std::max(most, std::abs(double{a.rgba[i + channel]} - b.rgba[i + channel]));
        worst.push_back(most);
    }
    std::ranges::sort(worst);
    return {worst[worst.size() - 1 - worst.size() / 1000],
            static_cast<int>(worst.end() - std::ranges::upper_bound(worst, 1e-3))};
}

class CpuPicture : public gl::GlTest {
  protected:
    CpuPicture() : mesh_(scene_mesh(test::split_box(11, 3000, 1e-2, ripples))) {}

    Scene scene(const TransferFunction& transfer_function) const {
        Scene scene = projection_scene(transfer_function, 101, 83);
        scene.camera->eye = {1.4, -.5, 1.3};
        scene.camera->center = {.5, .5, .5};
        scene.camera->fov_y = 60;
        scene.camera->height = 1.6;
        return scene;
    }

    // Compares both engines' pictures of one plan.
    void expect_same(const Scene& scene, const ProjectPlan& plan, const std::string& name) const {
        const View view(*scene.camera, scene.width, scene.height);
        GlProjectRenderer shaders(mesh_, *scene.transfer_function, plan, capabilities(),
                                  scene.width, scene.height);
        shaders.draw(view);
        CpuProjectRenderer tiles(mesh_, *scene.transfer_function, plan, scene.width, scene.height);
        tiles.draw(view);
        const Difference found = difference(tiles.read(), shaders.read());
        // Both engines have the same formulas; a pixel has a hundred fragments, each good to
        // float32's rounding of a sum or two. The weights of coloured parts as polynomials are good
        // to 3e-5 (front_weights.h): OpenGL chooses between these and the table for 64 parts at a
        // time, the cpu engine for each.
        const bool weights = plan.source == SegmentSource::parts && !plan.single_color;
        EXPECT_LE(found.p999, weights ? 6e-5 : 1e-5) << name;
        // Rays along silhouettes may have a segment in one engine and none in the other. It has
        // length 0, unless a record's numbers are rounded differently.
        EXPECT_EQ(found.above_thousandth, 0) << name;
        EXPECT_EQ(tiles.tets_drawn() > 0, shaders.tets_drawn() > 0) << name;
    }

    // Compares both engines with both projections, both thicknesses, and depths on faces in float32
    // and in double precision.
    void expect_same(Scene scene, SegmentSource source, const std::string& name) const {
        TableCache tables;
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            for (const Thickness thickness : {Thickness::exact, Thickness::dz}) {
                scene.camera->projection = projection;
                scene.project.thickness = thickness;
                ProjectPlan plan = plan_of(mesh_, scene, cpu_capabilities()).project;
                if (source == SegmentSource::cut_table) {
                    plan.source = source;
                    plan.table.request = {
                        plan.range.lo,     plan.range.hi, 0.5, 200, plan.single_color ? 1 : 8,
                        !plan.single_color};
                    plan.table.built = tables.get(in_units(*scene.transfer_function, plan.unit),
                                                  plan.table.request);
                }
                ASSERT_EQ(plan.source, source) << name;
                for (const bool plain : {false, true}) {
                    plan.plain = plain;
                    expect_same(scene, plan,
                                name +
                                    (projection == Projection::perspective ? ", perspective"
                                                                           : ", orthographic") +
                                    (thickness == Thickness::dz ? ", dz" : "") +
                                    (plain ? ", plain" : ""));
                }
            }
        }
    }

    SceneMesh mesh_;
};

TEST_F(CpuPicture, MatchesOpenGlForOneConstant) {
    expect_same(scene(TransferFunction::linear({knot(0, {1, .6, .2}, 1.5)})),
                SegmentSource::constant, "constant");
}

TEST_F(CpuPicture, MatchesOpenGlForTetsCutAtPoints) {
    expect_same(scene(crooked()), SegmentSource::parts, "coloured");
    expect_same(scene(of_one_color()), SegmentSource::parts, "one colour");
}

TEST_F(CpuPicture, MatchesOpenGlForAnalyticSegments) {
    for (const TransferFunction& transfer_function : {crooked(), of_one_color()}) {
        Scene wanted = scene(transfer_function);
        wanted.project.coloring = Coloring::analytic;
        expect_same(wanted, SegmentSource::analytic, "analytic");
    }
}

TEST_F(CpuPicture, MatchesOpenGlForCutTables) {
    expect_same(scene(crooked()), SegmentSource::cut_table, "coloured");
    expect_same(scene(of_one_color()), SegmentSource::cut_table, "one colour");
}

// Tables are bilinear in 64 nodes, so a difference of 4e-8 in a scalar is less than 1e-5 of a
// cell's width, and changes the value by as much of the change over the cell, which is at most 10
// %.
TEST_F(CpuPicture, MatchesOpenGlForTables) {
    for (const bool colored : {true, false}) {
        for (const LengthMapping mapping :
             {LengthMapping::octave, LengthMapping::log2, LengthMapping::linear}) {
            for (const TableStore store : {TableStore::mean_extinction, TableStore::opacity}) {
                for (const int layers : {1, 2, 9}) {
                    if (layers == 1 && store == TableStore::opacity) continue;
                    Scene wanted = scene(colored ? crooked() : of_one_color());
                    wanted.project.table = TableSettings{
                        .scalar = 64, .length = layers, .mapping = mapping, .store = store};
                    expect_same(wanted, SegmentSource::table,
                                std::string(colored ? "coloured" : "one colour") + ", mapping " +
                                    std::to_string(static_cast<int>(mapping)) + ", store " +
                                    std::to_string(static_cast<int>(store)) + ", layers " +
                                    std::to_string(layers));
                }
            }
        }
    }
}

TEST_F(CpuPicture, MatchesOpenGlForEveryTableFormat) {
    for (const TableFormat format :
         {TableFormat::fixed8, TableFormat::fixed16, TableFormat::float16, TableFormat::float32}) {
        Scene wanted = scene(crooked());
        wanted.project.table = TableSettings{.scalar = 64, .length = 4, .format = format};
        const ProjectPlan plan = plan_of(mesh_, wanted, cpu_capabilities()).project;
        expect_same(wanted, plan, "format " + std::to_string(static_cast<int>(format)));
    }
}

// The cpu engine counts tets with a segment of length above 0, OpenGL those whose polygon covers a
// pixel centre: up to 1/128 pixel more on each side of tets that are a few pixels wide.
TEST_F(CpuPicture, CountsNearlyTheTetsOfOpenGl) {
    const Scene wanted = scene(crooked());
    const View view(*wanted.camera, wanted.width, wanted.height);
    const ProjectPlan plan = plan_of(mesh_, wanted, cpu_capabilities()).project;
    GlProjectRenderer shaders(mesh_, *wanted.transfer_function, plan, capabilities(), wanted.width,
                              wanted.height);
    shaders.draw(view);
    CpuProjectRenderer tiles(mesh_, *wanted.transfer_function, plan, wanted.width, wanted.height);
    tiles.draw(view);
    EXPECT_NEAR(static_cast<double>(tiles.tets_drawn()), static_cast<double>(shaders.tets_drawn()),
                0.02 * static_cast<double>(shaders.tets_drawn()));
}

}  // namespace
}  // namespace lamina
