// SPDX-License-Identifier: Apache-2.0
// Rays that run in a face of the volume's box are inside it, as in the reference tracer.
#include "engine_fixture.h"
#include "exact_fixture.h"

namespace lamina {
namespace {

class ClosedBox : public EngineTest {};

INSTANTIATE_TEST_SUITE_P(Contexts, ClosedBox, every_engine, engine_name);

constexpr Classification classifications[] = {Classification::exact, Classification::preintegrated,
                                              Classification::post};

// Fog in [0, 2] x [0, 2] x [0, 2]. Places and directions of the scenes below are exact in binary.
Volume fog() {
    return test::volume_of<std::uint8_t>(
        test::grid_of({3, 3, 3}, Centering::node),
        [](double x, double y, double) { return 40 + 20 * x + 9 * y; });
}

Scene fog_scene(Projection projection) {
    Scene scene =
        exact_scene(TransferFunction::linear({knot(0, {.2, .4, .8}, 0), knot(128, {1, .6, .1}, 1)}),
                    projection);
    scene.camera->up = {0, 1, 0};
    scene.camera->fov_y = 60;
    scene.camera->height = 4;
    scene.width = 29;  // the middle column's rays run straight ahead
    scene.height = 23;
    scene.max_error = .25;
    return scene;
}

// Returns the largest error in 1/255. Post-classified and pre-integrated slabs have an error of
// second order, here some thousandths. A ray that is lost would be off by more than 1 - exp(-.3 *
// 2).
double allowed(Classification classification) {
    return classification == Classification::exact ? promised : .25;
}

// Puts the eye in front of the box at `from`, looking along an axis.
void ahead_along(int axis, double sign, const glm::dvec3& from, Scene& scene) {
    glm::dvec3 ahead(0);
    ahead[axis] = sign;
    scene.camera->eye = from;
    scene.camera->eye[axis] = sign > 0 ? -1 : 3;
    scene.camera->center = scene.camera->eye + ahead;
    scene.camera->up = axis == 1 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
}

TEST_P(ClosedBox, RaysInEachFaceAndEdgeAreInside) {
    const Volume volume = fog();
    for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1., 1.}) {
            for (const glm::dvec3& from : {glm::dvec3(0, 0, 0), glm::dvec3(2, 2, 2),
                                           glm::dvec3(0, 2, 0), glm::dvec3(2, 1, 2)}) {
                Scene scene = fog_scene(Projection::perspective);
                ahead_along(axis, sign, from, scene);
                const Image reference = trace(volume, scene, 1e-8);
                const float* const middle = reference.pixel(14, 11);
                EXPECT_GT(middle[3], .2) << "the tracer's box is closed";
                EXPECT_LE(linf(draw(volume, scene), reference), promised)
                    << axis << " " << sign << " from " << from.x << " " << from.y << " " << from.z;
            }
        }
    }
}

TEST_P(ClosedBox, IncludesItsFacesInEveryClassification) {
    const Volume volume = fog();
    for (const Classification classification : classifications) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Scene scene = fog_scene(projection);
            ahead_along(2, 1, {2, 2, 0}, scene);
            scene.slice.classification = classification;
            scene.slice.samples = 64;
            EXPECT_LE(linf(draw(volume, scene), trace(volume, scene, 1e-8)),
                      allowed(classification))
                << name_of(classification);
        }
    }
}

// A ray in a face between two bricks belongs to one of them, not to both.
TEST_P(ClosedBox, RaysBetweenTwoBricksAreDrawnOnce) {
    const Volume volume = noise<std::uint8_t>({40, 30, 35}, Centering::node, 255);
    Capabilities small = capabilities();
    small.max_texture_bytes = 16 * 64 * 48 + 4 * 1000;
    Scene scene = exact_scene(in_view_of(volume, 4, steps), Projection::orthographic);
    scene.camera->eye = {20, 15, -40};
    scene.camera->center = {20, 15, 0};
    scene.camera->up = {0, 1, 0};
    scene.camera->height = 31;  // rays are 1 apart, and run in planes of samples
    scene.width = 41;
    scene.height = 31;
    EXPECT_LE(linf(draw(volume, scene, {}, small), trace(volume, scene, 1e-8)), promised);
}

// Found by tools/fuzz_scenes --first 9635: one voxel, the eye in the middle of an edge of the box,
// and an odd number of columns. 12 of 696 pixels were empty.
TEST_P(ClosedBox, TheEyeInAnEdgeOfAVoxelSeesIt) {
    Grid grid;
    grid.size = {1, 1, 1};
    grid.centering = {Centering::cell, Centering::cell, Centering::node};
    grid.step = {glm::dvec3(0, 0, 1.440598), glm::dvec3(.7526004, 0, 0),
                 glm::dvec3(0, 1.219747, 0)};
    const Volume voxel =
        test::volume_of<std::uint16_t>(grid, [](double, double, double) { return 0; });
    Scene scene = fog_scene(Projection::perspective);
    scene.transfer_function = TransferFunction::linear(
        {knot(-5.4651e-6, {.5139019, .6756425, .8118434}, 0),
         knot(2.700188e-4, {.9741909, .08278757, .9596987}, 6.732721654247521)});
    scene.camera->eye = {.3763002, .6098735, -.720299};
    scene.camera->center = {.3763002, .6098735, .720299};
    scene.camera->up = {0, 1, 0};
    scene.camera->fov_y = 64.92081;
    scene.width = 29;
    scene.height = 24;
    const Image reference = trace(voxel, scene, 1e-8);
    EXPECT_GT(reference.pixel(14, 20)[3], 0);
    EXPECT_LE(linf(draw(voxel, scene), reference), promised);
}

// Noise, whose cells differ in colour but not in extinction: a cell that a ray leaves out or counts
// twice changes its opacity by that of the cell.
constexpr double cell_extinction = .75;

Scene scene_of_cells(const Volume& volume, int rays, Projection projection) {
    const ValueRange range = measure_bricks(volume).whole;
    Scene scene =
        exact_scene(TransferFunction::linear({knot(range.lo, {1, 0, 0}, cell_extinction),
                                              knot(range.hi, {0, 0, 1}, cell_extinction)}),
                    projection);
    scene.camera->up = {0, 1, 0};
    scene.width = scene.height = rays;
    return scene;
}

// Returns the largest difference of a pixel's opacity from that of its ray's chord of the box.
double worst_opacity(const Image& image, const View& view, const glm::dvec3& box) {
    double worst = 0;
    for (int row = 0; row < image.height; ++row) {
        for (int column = 0; column < image.width; ++column) {
            const View::Ray ray = view.ray(column, row);
            double enter = 0, leave = INFINITY;
            for (int axis = 0; axis < 3; ++axis) {
                if (ray.direction[axis] == 0) continue;  // the box holds all rays
                const double one = -ray.origin[axis] / ray.direction[axis],
                             other = (box[axis] - ray.origin[axis]) / ray.direction[axis];
                enter = std::max(enter, std::min(one, other));
                leave = std::min(leave, std::max(one, other));
            }
            const double chord = std::max(leave - enter, 0.0) * glm::length(ray.direction);
            worst = std::max(worst, std::abs(double{image.pixel(column, row)[3]} +
                                             std::expm1(-cell_extinction * chord)));
        }
    }
    return worst;
}

// Each of up to 3 * 16 segments has two ends, whose places in a cell add a rounding of 2^-24 at
// each cell before, and is composited with a rounding of 2^-24.
constexpr double most_cells = 48;
constexpr double rounding_of_walk = most_cells * (most_cells * cell_extinction + 1) * 0x1p-24;

// A million rays along an axis, through samples, along edges and along faces of cells, in all
// fourths of cells. The box is closed, so it holds all.
TEST_P(ClosedBox, CellsOfParallelRaysHaveNoGap) {
    constexpr int cells = 256, rays = 4 * cells + 1;
    const Volume volume = noise<std::uint8_t>({cells + 1, cells + 1, 3}, Centering::node, 255);
    Scene scene = scene_of_cells(volume, rays, Projection::orthographic);
    scene.camera->eye = {cells / 2., cells / 2., 5};
    scene.camera->center = {cells / 2., cells / 2., 1};
    scene.camera->height = rays / 4.;
    const View view(*scene.camera, rays, rays);
    EXPECT_LE(worst_opacity(draw(volume, scene), view, {cells, cells, 2}), rounding_of_walk);
}

// The eye lies in planes of samples: rays of the middle row and column run in faces of cells, those
// of diagonals through edges.
TEST_P(ClosedBox, CellsSeenFromTheirPlanesHaveNoGap) {
    constexpr int cells = 16, rays = 301;
    const Volume volume =
        noise<std::uint8_t>({cells + 1, cells + 1, cells + 1}, Centering::node, 255);
    for (const glm::dvec3& eye :
         {glm::dvec3(8, 8, 40), glm::dvec3(10, 4, 28), glm::dvec3(9, 9, 17)}) {
        Scene scene = scene_of_cells(volume, rays, Projection::perspective);
        scene.camera->eye = eye;
        scene.camera->center = eye - glm::dvec3(0, 0, 1);
        scene.camera->fov_y = 50;
        const View view(*scene.camera, rays, rays);
        EXPECT_LE(worst_opacity(draw(volume, scene), view, glm::dvec3(cells)), rounding_of_walk)
            << eye.x << " " << eye.y << " " << eye.z;
    }
}

}  // namespace
}  // namespace lamina
