// SPDX-License-Identifier: Apache-2.0
// Tets cut at the transfer function's points, in meshes so large that depths on faces are float32.
#include <cstring>

#include "projection/tet_setup.h"
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

// Compares numbers, so that -0 equals 0.
template <typename Record>
void expect_equal(const Record& a, const Record& b) {
    std::array<float, sizeof(Record) / sizeof(float)> of_a, of_b;
    std::memcpy(of_a.data(), &a, sizeof(a));
    std::memcpy(of_b.data(), &b, sizeof(b));
    EXPECT_EQ(of_a, of_b);
}

// Sets up cell fragments in both ways and compares them; returns how many were `done`.
std::size_t compare_careful(const TetsInView& tets, std::span<const CellFragment> all) {
    constexpr std::size_t most = TetSetup::most_cell_fragments;
    const TetProjector projector(tets);
    std::size_t done = 0;
    for (std::size_t first = 0; first < all.size(); first += most) {
        const auto group = all.subspan(first, std::min(most, all.size() - first));
        std::array<SilhouetteRecord, most> records{};
        std::array<GradientRecord, most> gradients{};
        TetSetup found;
        set_up_tets(tets, group, {}, true, records.data(), gradients.data(), found);
        for (std::size_t i = 0; i < group.size(); ++i) {
            if (found.outcomes[i] == TetSetup::Outcome::needs_care) continue;
            SilhouetteRecord record{};
            GradientRecord gradient{};
            ScreenOutline outline;
            const bool visible =
                projector.project(group[i], record, outline, &gradient).has_value();
            EXPECT_EQ(found.outcomes[i] == TetSetup::Outcome::done, visible);
            ++done;
            if (!visible) continue;
            expect_equal(records[i], record);
            expect_equal(gradients[i], gradient);
            const View& view = tets.view();
            const PixelBounds bounds =
                pixel_bounds(outline.points(), tets.margin, view.width, view.height);
            const CoveredArea& area = found.areas[i];
            EXPECT_EQ(area.first_column, bounds.first_column);
            EXPECT_EQ(area.last_column, bounds.last_column);
            EXPECT_EQ(area.first_row, view.height - 1 - bounds.last_row);
            EXPECT_EQ(area.last_row, view.height - 1 - bounds.first_row);
        }
    }
    return done;
}

TEST(TetSetup, CarefulCellFragmentsAreThoseOfTetProjector) {
    const SceneMesh mesh = scene_mesh(test::split_box(7, 1000, 1e-2, ripples));
    const ValueRange range{0, 1};
    const TetPieces pieces(with_peak(3), range);
    std::vector<glm::vec3> gradients;
    for (const glm::dvec3& point : mesh.mesh.points())
        gradients.emplace_back(glm::cross(point, glm::dvec3(.1, .02, .3)));
    std::vector<CellFragment> whole, cut;
    for (std::int32_t tet = 0; tet < std::ssize(mesh.mesh.tets()); ++tet) {
        whole.push_back({tet});
        const auto met = pieces.met(mesh.scalar.values, mesh.mesh.tets()[tet]);
        for (std::int32_t piece = met.first; piece <= met.last; ++piece)
            cut.push_back({tet, piece});
    }
    ASSERT_GT(cut.size(), whole.size());
    for (const auto projection : {Projection::perspective, Projection::orthographic}) {
        for (const glm::dvec3& eye : {glm::dvec3(.5, .5, 3), glm::dvec3(2, 1.7, 1.4)}) {
            Scene scene = projection_scene(with_peak(3), 97, 64);
            scene.camera->projection = projection;
            scene.camera->eye = eye;
            scene.camera->center = {.45, .5, .5};
            scene.camera->up = {0, 1, 0};
            scene.camera->height = 1.4;
            const TetsInView tets{mesh.mesh,
                                  mesh.scalar.values,
                                  range,
                                  pieces,
                                  WindowView(View(*scene.camera, scene.width, scene.height)),
                                  1e-3,
                                  1e-3,
                                  gradients};
            // Only faces that are seen edge-on need more care.
            EXPECT_GT(compare_careful(tets, whole), whole.size() * 9 / 10);
            EXPECT_GT(compare_careful(tets, cut), cut.size() * 9 / 10);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Engines, Parts, every_engine, engine_name);

}  // namespace
}  // namespace lamina
