// SPDX-License-Identifier: Apache-2.0
// Rays that walk through meshes (projection/gl_mesh_walk.h). Other tests compare their pictures
// with the tracer's: those of Engine::opengl.
#include "projection/gl_mesh_walk.h"

#include <algorithm>

#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr double extinction = 0.75;

const auto constant_field = [](const glm::dvec3&) { return 0.0; };

// Returns a mesh with its points at from + step * place.
SceneMesh placed(MeshData data, const glm::dvec3& from, const glm::dvec3& step) {
    for (glm::dvec3& point : data.points) point = from + step * point;
    return scene_mesh(std::move(data));
}

TEST(WalkPace, HoldsWholeRaysUnlessTheyTakeLong) {
    constexpr int needed = 20000;  // rounds of a ray
    for (const double ms_per_round : {1e-4, .01, 1.}) {
        WalkPace pace(WalkPace::first_rounds);
        double ms = 0;
        for (int frame = 0; frame < 8; ++frame) {
            ms = ms_per_round * std::min(pace.rounds(), needed);
            pace.took(ms, pace.rounds() < needed);
        }
        EXPECT_LE(ms, WalkPace::most_ms) << ms_per_round;
        EXPECT_EQ(pace.rounds() >= needed, ms_per_round == 1e-4);
        // Those that last 12.5 ms or more grow, too.
        if (ms_per_round == .01) {
            EXPECT_GT(ms, .9 * WalkPace::wanted_ms);
        }
    }
}

TEST(WalkPace, AProgramsFirstUseMakesNoRaysShort) {
    WalkPace pace(WalkPace::first_rounds);
    pace.took(300, true);
    EXPECT_EQ(pace.rounds(), WalkPace::first_rounds);
    pace.took(300, true);
    EXPECT_LT(pace.rounds(), WalkPace::first_rounds);
}

class MeshWalk : public gl::EveryContextTest {
  protected:
    static Scene scene_of_constant(int width, int height) {
        return projection_scene(TransferFunction::linear({knot(0, {1, 1, 1}, extinction)}), width,
                                height);
    }

    Image walk(const SceneMesh& mesh, const Scene& scene) {
        const auto renderer = make_renderer(mesh, scene, capabilities());
        EXPECT_NE(dynamic_cast<const GlMeshWalk*>(renderer.get()), nullptr);
        renderer->draw(View(*scene.camera, scene.width, scene.height));
        return renderer->read();
    }

    // Returns the largest difference of a pixel's opacity from that of a ray of length_of(column,
    // row).
    template <typename Length>
    static double error_of(const Image& image, const Length& length_of) {
        double largest = 0;
        for (int row = 0; row < image.height; ++row)
            for (int column = 0; column < image.width; ++column) {
                const double opacity = -std::expm1(-extinction * length_of(column, row));
                const double found = image.pixel(column, row)[3];
                largest = std::max(largest, std::abs(found - opacity));
            }
        return largest;
    }
};

// Float32 sums of few segments: some roundings of 6e-8, and 3e-7 of opacity_from_depth().
constexpr double few_roundings = 1e-6;

// Looks at the middle of the unit square at z = 0, from above.
void look_down(Scene& scene, double height) {
    scene.camera->projection = Projection::orthographic;
    scene.camera->eye = {.5, .5, 3};
    scene.camera->center = {.5, .5, 0};
    scene.camera->up = {0, 1, 0};
    scene.camera->height = height;
}

// A million rays parallel to edges of 786,432 tets, through their corners, along their edges and
// along their faces, in all fourths of cells. Rays on the mesh's boundary are inside if they are
// when moved to the right and, less so, upwards: ray_perturbation() moves them along the world's x
// and y.
TEST_P(MeshWalk, SeesNoGapAlongParallelEdges) {
    constexpr int cells = 256, rays = 4 * cells + 1;
    const SceneMesh mesh = placed(test::kuhn_box({cells, cells, 2}, constant_field), {0, 0, 0},
                                  {1. / cells, 1. / cells, .5});
    Scene scene = scene_of_constant(rays, rays);
    look_down(scene, static_cast<double>(rays) / (rays - 1));
    const double error = error_of(walk(mesh, scene), [&](int column, int row) {
        return column < rays - 1 && row > 0 ? 1.0 : 0.0;
    });
    EXPECT_LE(error, few_roundings);
}

// The eye lies in planes of the mesh, which are seen edge-on: rays of the middle row and column and
// of the diagonals run inside faces.
TEST_P(MeshWalk, SeesNoGapFromPlanesOfTheMesh) {
    constexpr int cells = 16, rays = 301;
    const glm::dvec3 least(-1), most(1);
    const SceneMesh mesh = placed(test::kuhn_box({cells, cells, cells}, constant_field), least,
                                  (most - least) / static_cast<double>(cells));
    for (const glm::dvec3& eye :
         {glm::dvec3(0, 0, 4), glm::dvec3(.25, -.5, 2.5), glm::dvec3(.125, .125, 1.125)}) {
        Scene scene = scene_of_constant(rays, rays);
        scene.camera->eye = eye;
        scene.camera->center = eye - glm::dvec3(0, 0, 1);
        scene.camera->up = {0, 1, 0};
        scene.camera->fov_y = 50;
        const View view(*scene.camera, rays, rays);
        const double error = error_of(walk(mesh, scene), [&](int column, int row) {
            const View::Ray ray = view.ray(column, row);
            double enter = 0, leave = INFINITY;
            for (int axis = 0; axis < 3; ++axis) {
                const double one = (least[axis] - eye[axis]) / ray.direction[axis],
                             other = (most[axis] - eye[axis]) / ray.direction[axis];
                if (ray.direction[axis] == 0) continue;  // the eye is between both
                enter = std::max(enter, std::min(one, other));
                leave = std::min(leave, std::max(one, other));
            }
            return std::max(leave - enter, 0.0) * glm::length(ray.direction);
        });
        // Up to 60 segments, each of which rounds the sum.
        EXPECT_LE(error, 60 * 6e-8) << eye.x << " " << eye.y << " " << eye.z;
    }
}

// Each ray passes 36000 tets or more, in several dispatches.
TEST_P(MeshWalk, ContinuesInTheNextDispatch) {
    constexpr int cells = 12000;
    const SceneMesh mesh =
        placed(test::kuhn_box({1, 1, cells}, constant_field), {0, 0, 0}, {1, 1, 1. / cells});
    Scene scene = scene_of_constant(8, 8);
    look_down(scene, .5);
    // OVER rounds the sum by half of 2^-24 at most at each tet.
    EXPECT_LE(error_of(walk(mesh, scene), [](int, int) { return 1.0; }), 36000 * 3e-8);
}

// A tile has 131072 faces that a ray may enter by, more than a dispatch tests.
TEST_P(MeshWalk, SearchesManyFacesInSeveralDispatches) {
    constexpr int cells = 256;
    const SceneMesh mesh = placed(test::kuhn_box({cells, cells, 1}, constant_field), {0, 0, 0},
                                  {1. / cells, 1. / cells, 1});
    Scene scene = scene_of_constant(8, 8);
    look_down(scene, 1);
    EXPECT_LE(error_of(walk(mesh, scene), [](int, int) { return 1.0; }), few_roundings);
}

// Forty slabs with gaps between them, each a mesh of its own: rays enter forty times, nearest
// first, which the colours tell.
TEST_P(MeshWalk, EntersAgainBehindGaps) {
    constexpr int slabs = 40;
    MeshData all;
    all.point_scalars.push_back({"s", {}});
    for (int slab = 0; slab < slabs; ++slab) {
        // Not in the order of depth.
        const double depth = (slab * 7) % slabs;
        const MeshData data = test::kuhn_box({2, 2, 1}, constant_field);
        const auto before = static_cast<std::int32_t>(all.points.size());
        for (const glm::dvec3& point : data.points) {
            all.points.emplace_back(point.x, point.y, depth + .5 * point.z);
            all.point_scalars[0].values.push_back(depth);
        }
        for (const Tet& tet : data.tets) {
            all.tets.push_back(tet);
            for (std::int32_t& corner : all.tets.back()) corner += before;
        }
    }
    const SceneMesh mesh = scene_mesh(std::move(all));
    Scene scene = projection_scene(
        TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(slabs - 1, {0, 1, .5}, .2)}), 64,
        64);
    scene.camera->eye = {1.3, .8, -30};
    scene.camera->center = {1, 1, 20};
    scene.camera->fov_y = 8;
    const double error = image_error(walk(mesh, scene), trace(mesh, scene)).all.linf;
    EXPECT_LE(error, .01);  // in 1/255: sums of forty segments in float32
}

// A tet of optical depth 1e6 would be cut to 700,000 pieces if the ray did not end in the first.
TEST_P(MeshWalk, EndsInAnOpaqueTet) {
    const SceneMesh mesh = scene_mesh(
        test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return .2 * p.x + .3 * p.z; }));
    Scene scene = projection_scene(
        TransferFunction::linear({knot(0, {1, 0, 0}, 1e6), knot(1, {0, 1, .5}, 2e6)}), 48, 48);
    scene.camera->eye = {3, 4, 6};
    scene.camera->center = {1, 1, 1};
    EXPECT_LE(image_error(walk(mesh, scene), trace(mesh, scene)).all.linf, .05);
}

// A search for the interval of a scalar takes rounds of the dispatch, of which software has few.
TEST_P(MeshWalk, SearchesManyPointsOfTheTransferFunction) {
    const SceneMesh mesh = scene_mesh(
        test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return .2 * p.x + .3 * p.z; }));
    for (const int many : {190, 5000}) {
        std::vector<TransferKnot> knots{knot(0, {1, 0, 0}, 2), knot(.3, {1, 0, 0}, 0)};
        for (int i = 1; i <= many; ++i)
            knots.push_back(knot(.3 + .4 * i / (many + 1), {.25 * (i % 4), 0, 0}, 0));
        knots.insert(knots.end(), {knot(.7, {0, 1, .5}, 0), knot(1, {0, 1, .5}, 2)});
        Scene scene = projection_scene(TransferFunction::linear(knots), 48, 48);
        scene.camera->eye = {3, 4, 6};
        scene.camera->center = {1, 1, 1};
        const auto renderer = make_renderer(mesh, scene, capabilities());
        EXPECT_EQ(dynamic_cast<const GlMeshWalk*>(renderer.get()) != nullptr,
                  many < 200 || !capabilities().software);
        renderer->draw(View(*scene.camera, scene.width, scene.height));
        EXPECT_LE(image_error(renderer->read(), trace(mesh, scene)).all.linf, .05) << many;
    }
}

// Tables are read as storage blocks or as texels. The transfer function has so many points that its
// intervals are searched for.
TEST_P(MeshWalk, DrawsTheSameFromStorageBlocks) {
    const SceneMesh mesh = scene_mesh(
        test::kuhn_box({5, 4, 3}, [](const glm::dvec3& p) { return .1 * p.x + .3 * p.z * p.y; }));
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= 40; ++i)
        knots.push_back(knot(.1 * i, {.25 * (i % 4), .5, .3 * (i % 3)}, .5 * (i % 5)));
    Scene scene = projection_scene(TransferFunction::linear(knots), 61, 45);
    scene.camera->eye = {9, 12, 17};
    scene.camera->center = {2.5, 2, 1.5};
    for (const bool lit : {false, true}) {
        if (lit) {
            Lighting lighting;
            lighting.smallest_gradient = .05;
            scene.lighting = lighting;
        }
        Capabilities each = capabilities();
        each.software = false;  // else lit rays do not walk
        const auto draw = [&] {
            const auto renderer = make_renderer(mesh, scene, each);
            EXPECT_NE(dynamic_cast<const GlMeshWalk*>(renderer.get()), nullptr);
            renderer->draw(View(*scene.camera, scene.width, scene.height));
            return renderer->read();
        };
        const Image expected = draw();
        each.rays.blocks = true;
        EXPECT_EQ(draw().rgba, expected.rgba) << lit;
        EXPECT_GT(expected.pixel(30, 22)[3], .1);
    }
}

// Faces that cross the eye's plane would have to be listed for all pixels.
TEST_P(MeshWalk, IsNotChosenAroundTheEye) {
    const SceneMesh mesh = scene_mesh(test::kuhn_box({2, 2, 2}, constant_field));
    Scene scene = scene_of_constant(48, 48);
    for (const double place : {1., 1.3}) {
        scene.camera->eye = {place, place, place};
        scene.camera->center = {place, place, 0};
        scene.camera->up = {0, 1, 0};
        const auto renderer = make_renderer(mesh, scene, capabilities());
        EXPECT_EQ(dynamic_cast<const GlMeshWalk*>(renderer.get()), nullptr);
        renderer->draw(View(*scene.camera, scene.width, scene.height));
        EXPECT_LE(image_error(renderer->read(), trace(mesh, scene)).all.linf, .05);
    }
}

INSTANTIATE_TEST_SUITE_P(, MeshWalk, gl::both_contexts, gl::context_name);

}  // namespace
}  // namespace lamina
