// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "facts/drawn_range.h"
#include "optics/segment_integral.h"
#include "plan/plan.h"
#include "support/transfer_functions.h"
#include "volume/generate.h"

namespace lamina {
namespace {

using test::knot;

// Returns colours and extinctions that go up and down from point to point.
TransferFunction zigzag(int points) {
    std::vector<TransferKnot> knots;
    for (int i = 0; i < points; ++i) {
        const bool odd = i % 2 == 1;
        knots.push_back(knot(i / (points - 1.), odd ? glm::dvec3(1, .2, 0) : glm::dvec3(0, .9, 1),
                             odd ? 6 : .5));
    }
    return TransferFunction::linear(knots);
}

Scene scene_of(const TransferFunction& transfer_function) {
    Scene scene;
    scene.transfer_function = transfer_function;
    scene.slice.classification = Classification::preintegrated;
    scene.camera->eye = {1.7, -.9, 1.3};
    scene.camera->center = {.5, .5, .5};
    scene.width = scene.height = 64;
    scene.slice.samples = 200;
    return scene;
}

// Returns a table request before anything is chosen, over the range of scalars that is drawn.
TablePlan table_of(const Scene& scene, const Facts& facts, double max_length) {
    const ValueRange range = drawn_range(*scene.transfer_function, facts.range);
    TablePlan table;
    table.request.lo = range.lo;
    table.request.hi = range.hi;
    table.request.max_length = max_length;
    return table;
}

Volume blobs() {
    return generate({"gaussians", std::array<std::int64_t, 3>{32, 32, 32}, SampleType::float32});
}

TEST(TableChoice, ManyPointsGetMoreNodesUntilTheErrorIsKept) {
    const Volume volume = blobs();
    Scene scene = scene_of(zigzag(59));
    scene.max_error = 4;
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    ASSERT_FALSE(facts.scalar_rays.rays.empty());
    const double longest = (facts.far_depth - facts.near_depth) / 200 * facts.max_length_per_depth;
    TablePlan coarse = table_of(scene, facts, longest);
    coarse.request.length_layers = 3;
    TableCache tables;
    get_table(scene, facts, coarse, tables);
    const double error = table_error(scene, facts, 200, coarse);
    TablePlan chosen = coarse;
    const double depth = facts.max_extinction * longest;
    refine_table(scene, facts, 200, depth, chosen, tables);
    EXPECT_GT(chosen.request.scalar_nodes, coarse.request.scalar_nodes);
    EXPECT_LE(chosen.error, table_share * scene.max_error);
    // A piece had two cells and now has 17: the error of linear interpolation falls with the square
    // of their number.
    EXPECT_LE(chosen.error, error / 16);
}

TEST(TableChoice, FewPointsKeepTheCoarsestTable) {
    const Volume volume = blobs();
    const Scene scene = scene_of(zigzag(4));
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    TablePlan chosen = table_of(scene, facts, .01);
    TableCache tables;
    refine_table(scene, facts, 200, .06, chosen, tables);
    EXPECT_EQ(chosen.request.scalar_nodes, TableRequest().scalar_nodes);
    EXPECT_GT(chosen.error, 0);
    EXPECT_LE(chosen.error, table_share * scene.max_error);
}

// Long segments need a table even of a single linear piece, and its layers are far apart.
TEST(TableChoice, RaysRevealTheErrorOfLongSegmentsInOnePiece) {
    Scene scene =
        scene_of(TransferFunction::linear({knot(0, {1, .2, 0}, 0), knot(1, {0, .9, 1}, 40)}));
    scene.slice.samples = 2;
    const Volume volume = blobs();
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    ASSERT_EQ(facts.pieces, 1);
    ASSERT_FALSE(facts.scalar_rays.rays.empty());
    for (const ScalarRays::Ray& ray : facts.scalar_rays.rays) {
        EXPECT_LT(ray.near, ray.far);
        EXPECT_GE(ray.near, facts.near_depth - 1e-12);
        EXPECT_LE(ray.far, facts.far_depth + 1e-12);
        EXPECT_TRUE(std::ranges::all_of(ray.scalars, [](float s) { return std::isfinite(s); }));
    }
    const double longest = (facts.far_depth - facts.near_depth) / 2 * facts.max_length_per_depth;
    TablePlan table = table_of(scene, facts, longest);
    TableCache tables;
    refine_table(scene, facts, 2, facts.max_extinction * longest, table, tables);
    // Without rays only segments of the largest length are tried. These lie on a layer, so lengths
    // are not interpolated and make no error.
    Facts without_rays = facts;
    without_rays.scalar_rays.rays.clear();
    EXPECT_GT(table.error, 4 * table_error(scene, without_rays, 2, table));
}

TEST(TableChoice, PlansHaveTheirTablesAndShareThoseOfOneCache) {
    const Volume volume = blobs();
    Capabilities native;
    native.cpu = true;
    native.max_texture_size = native.max_3d_texture_size = 64;
    for (const TransferFunction& transfer_function :
         {zigzag(4), TransferFunction::linear({knot(0, {1, .2, 0}, 0), knot(.4, {1, .2, 0}, 9),
                                               knot(1, {1, .2, 0}, 2)})}) {
        const Scene scene = scene_of(transfer_function);
        const Facts facts = measure(scene, volume, measure_bricks(volume));
        const auto tables = std::make_shared<TableCache>();
        const SlicePlan plan = make_plan(scene, facts, native, {}, {}, tables).slice;
        ASSERT_TRUE(plan.uses_table());
        ASSERT_NE(plan.table.built, nullptr);
        EXPECT_EQ(plan.table.built->request.colored, plan.table.request.colored);
        EXPECT_EQ(plan.table.knot_table()->lengths.size(),
                  static_cast<std::size_t>(plan.table.request.length_layers));
        EXPECT_EQ(make_plan(scene, facts, native, {}, {}, tables).slice.table.built,
                  plan.table.built);
        const SlicePlan other = make_plan(scene, facts, native, {}).slice;
        EXPECT_NE(other.table.built, plan.table.built);
        EXPECT_EQ(other, plan);  // the numbers are those that the table is built from
    }
}

}  // namespace
}  // namespace lamina
