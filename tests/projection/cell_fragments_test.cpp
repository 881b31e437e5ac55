// SPDX-License-Identifier: Apache-2.0
// Tets cut at the transfer function's points, in meshes so large that depths on faces are float32.
#include "projection/visible_cell_fragments.h"
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr int cells = 13;  // along each edge of the unit box: 13,182 tets

SceneMesh box() {
    const auto of_cells = [](const glm::dvec3& p) { return ripples(p / double(cells)); };
    MeshData data = test::kuhn_box({cells, cells, cells}, of_cells);
    for (glm::dvec3& point : data.points) point /= double(cells);
    return scene_mesh(std::move(data));
}

// Returns a ramp, a gap, a peak and a step. Tets are opaque in a peak of a `height` of some 1000.
TransferFunction with_peak(double height) {
    return TransferFunction::linear({knot(0, {0, .2, 1}, .2), knot(.3, {0, 1, .3}, 1),
                                     knot(.4, {1, 1, 0}, 0), knot(.45, {1, 1, 0}, 0),
                                     knot(.47, {1, .2, 1}, height), knot(.49, {1, 0, 0}, .1),
                                     knot(.7, {.3, 0, 1}, .1), knot(.7, {1, .6, 0}, 2)});
}

class Parts : public ProjectionTest {
  protected:
    Parts() : mesh_(box()) {}

    Scene scene(const TransferFunction& transfer_function, const glm::dvec3& eye) const {
        Scene scene = projection_scene(transfer_function, 96, 96);
        scene.camera->eye = eye;
        scene.camera->center = {.45, .5, .5};
        scene.camera->up = {0, 1, 0};
        scene.camera->fov_y = 50;
        scene.camera->height = 1.4;
        return scene;
    }

    SceneMesh mesh_;
};

// The weights are off by 3e-5 in thin parts and 5e-4 in opaque ones, times the change of colour
// along the ray: some 6 times full scale in thin parts and, until nothing is seen behind it, once
// in an opaque peak. That makes .05 + .13. Float32's rounding is far below.
TEST_P(Parts, AreExact) {
    const std::vector<glm::dvec3> eyes{{.5, .5, 3}, {2, 1.7, 1.4}, {-1.2, .4, .3}, {.42, .37, .55}};
    for (const double height : {3.0, 1000.0}) {
        for (const glm::dvec3& eye : eyes) {
            for (const auto projection : {Projection::perspective, Projection::orthographic}) {
                Scene wanted = scene(with_peak(height), eye);
                wanted.camera->projection = projection;
                const Plan plan = plan_of(mesh_, wanted, capabilities());
                ASSERT_EQ(plan.project.source, SegmentSource::parts);
                ASSERT_TRUE(plan.project.plain);
                const Image drawn = project(mesh_, wanted, capabilities());
                EXPECT_LE(image_error(drawn, trace(mesh_, wanted)).all.linf, 0.18)
                    << height << ", eye " << eye.x << ", " << static_cast<int>(projection);
            }
        }
    }
}

// The scalar at the eye is exactly a point of the transfer function: that point's surface is seen
// edge-on from within.
TEST_P(Parts, AreExactWithTheEyeOnASurfaceOfAPoint) {
    MeshData data = test::kuhn_box({cells, cells, cells}, [](const glm::dvec3& p) { return p.x; });
    const SceneMesh mesh = scene_mesh(std::move(data));
    Scene wanted = scene(TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(4, {0, 1, 0}, 0),
                                                   knot(4, {0, 0, 1}, .3), knot(9, {1, 1, 0}, 1)}),
                         {4, 6.2, 5.7});
    for (const glm::dvec3& center : {glm::dvec3(4, 9, 8), glm::dvec3(12, 6, 7)}) {
        wanted.camera->center = center;
        const Image drawn = project(mesh, wanted, capabilities());
        EXPECT_LE(image_error(drawn, trace(mesh, wanted)).all.linf, 0.05) << center.x;
    }
}

// The field has labels, like a segmentation. The tets with the last one have a constant value, at
// which the transfer function has a step: its later side counts.
TEST_P(Parts, ShowTheLaterSideOfAStepAtTheLargestValue) {
    MeshData data =
        test::kuhn_box({4, 4, 4}, [](const glm::dvec3& p) { return p.x < 2 ? 0. : 1.; });
    const SceneMesh mesh = scene_mesh(std::move(data));
    Scene wanted = scene(TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(1, {1, .5, 0}, .2),
                                                   knot(1, {0, 0, 1}, .8)}),
                         {7, 6, 9});
    wanted.camera->center = {2, 2, 2};
    for (const Coloring coloring : {Coloring::preintegrated, Coloring::analytic}) {
        wanted.project.coloring = coloring;
        const Image drawn = project(mesh, wanted, capabilities());
        // The range ends 1e-6 of its width beyond the step, so the error is 1e-6 of the edge of a
        // tet that reaches the step.
        EXPECT_LE(image_error(drawn, trace(mesh, wanted)).all.linf, 0.05);
    }
}

TEST_P(Parts, OmitWhatShowsNothing) {
    const TransferFunction peak = TransferFunction::linear(
        {knot(.6, {1, 1, 1}, 0), knot(.65, {1, 1, 1}, 1), knot(.7, {1, 1, 1}, 0)});
    const TetPieces pieces(peak, {0, 1});
    ASSERT_EQ(pieces.pieces().size(), 4u);
    VisibleCellFragments parts(mesh_.mesh, mesh_.scalar.values, pieces, true, false);
    std::vector<std::int32_t> order(mesh_.mesh.tets().size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
    const auto list = parts.list(order, {{.5, .5, 3}, false});
    EXPECT_EQ(std::ssize(list), parts.count());
    std::int64_t expected = 0;
    for (const Tet& tet : mesh_.mesh.tets()) {
        double lo = 1, hi = 0;
        for (const std::int32_t corner : tet) {
            lo = std::min(lo, mesh_.scalar.values[static_cast<std::size_t>(corner)]);
            hi = std::max(hi, mesh_.scalar.values[static_cast<std::size_t>(corner)]);
        }
        expected += (lo < .65 && hi > .6) + (lo < .7 && hi > .65);
    }
    EXPECT_EQ(parts.count(), expected);
    for (const CellFragment& cell_fragment : list)
        EXPECT_TRUE(cell_fragment.piece == 1 || cell_fragment.piece == 2);
}

INSTANTIATE_TEST_SUITE_P(Engines, Parts, every_engine, engine_name);

}  // namespace
}  // namespace lamina
