// SPDX-License-Identifier: Apache-2.0
// Volumes and transfer functions for the tests of exact segments (docs/numerics.md, section 9).
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "slicing_fixture.h"
#include "support/volume_of.h"

namespace lamina {

inline constexpr double full = 255;
// Error, in 1/255, of sums of a few hundred roundings of float32 at full scale.
inline constexpr double float_error = .01;
// Largest error, in 1/255, that exact segments promise (docs/precision.md).
inline constexpr double promised = .05;

inline Scene exact_scene(const TransferFunction& transfer_function, Projection projection) {
    Scene scene = unit_box_scene(transfer_function, projection, 60, 45);
    scene.slice.classification = Classification::exact;
    return scene;
}

// Returns noise: every cell has another cubic.
template <typename Sample>
Volume noise(std::array<std::int64_t, 3> size, Centering centering, double largest) {
    std::uint32_t state = 12345;
    return test::volume_of<Sample>(test::grid_of(size, centering), [&](double, double, double) {
        state = state * 1664525u + 1013904223u;
        return largest * (state >> 8) / 0x1p24;
    });
}

// Calls make(lowest scalar, width of the range, extinction of optical depth `depth` over the box's
// diagonal).
inline TransferFunction in_view_of(
    const Volume& volume, double depth,
    const std::function<TransferFunction(double, double, double)>& make) {
    const ValueRange range = measure_bricks(volume).whole;
    const glm::dvec3 size = volume.grid().index_max() - volume.grid().index_min();
    return make(range.lo, range.hi - range.lo, depth / glm::length(size));
}

inline TransferFunction peak(double lo, double width, double extinction) {
    const double middle = lo + .4 * width;
    return TransferFunction::linear({knot(middle - .01 * width, {1, .2, .1}, 0),
                                     knot(middle, {.1, .9, .4}, 10 * extinction),
                                     knot(middle + .01 * width, {.2, .1, 1}, 0)});
}

inline TransferFunction many_points(double lo, double width, double extinction) {
    std::vector<TransferKnot> knots;
    for (int i = 0; i <= 60; ++i) {
        const double share = i / 60.;
        knots.push_back(knot(lo + share * width, {share, .5 + .5 * std::sin(9 * share), 1 - share},
                             extinction * (1 + std::sin(40 * share))));
    }
    return TransferFunction::linear(knots);
}

inline TransferFunction steps(double lo, double width, double extinction) {
    std::vector<TransferKnot> knots;
    for (int i = 1; i < 6; ++i) {
        const double value = lo + i * width / 6;
        knots.push_back(
            knot(value, {.1 * i, .5, .2}, knots.empty() ? 0 : knots.back().optics.extinction));
        knots.push_back(knot(value, {.9, .2, .1 * i}, i % 2 ? extinction : .2 * extinction));
    }
    return TransferFunction::linear(knots);
}

inline void look_from(const Volume& volume, const glm::dvec3& direction, double distance,
                      Scene& scene) {
    const Grid& grid = volume.grid();
    const glm::dvec3 middle =
        .5 * (grid.to_world(grid.index_min()) + grid.to_world(grid.index_max()));
    const double diagonal =
        glm::length(grid.to_world(grid.index_max()) - grid.to_world(grid.index_min()));
    scene.camera->center = middle;
    scene.camera->eye = middle + distance * diagonal * glm::normalize(direction);
    scene.camera->height = .8 * diagonal;
}

// One cell, seen along its diagonal by a single ray; in corner_cell() the scalar along it is x y z
// = t^3.
inline Scene diagonal_scene(const TransferFunction& transfer_function) {
    Scene scene = exact_scene(transfer_function, Projection::orthographic);
    scene.camera->center = {.5, .5, .5};
    scene.camera->eye = {3, 3, 3};
    scene.camera->up = {0, 1, .1};
    scene.camera->height = 1e-9;
    scene.width = scene.height = 1;
    return scene;
}

inline Volume corner_cell() {
    return test::volume_of<float>(test::grid_of({2, 2, 2}, Centering::node),
                                  [](double x, double y, double z) { return x * y * z; });
}

struct NamedFunction {
    const char* name;
    TransferFunction (*make)(double, double, double);
};
inline constexpr NamedFunction functions[] = {
    {"peak", peak}, {"many points", many_points}, {"steps", steps}};

// Calls check(scene, name) for exact scenes of all functions, in both projections, from outside and
// inside. Extinction jumps by less than .2 a cell: 4 over some 20 cells.
inline void for_each_exact_scene(
    const Volume& volume, const std::function<void(Scene&, const std::string& name)>& check) {
    for (const NamedFunction& function : functions) {
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            Scene scene = exact_scene(in_view_of(volume, 4, function.make), projection);
            for (const double distance : {1.2, .1}) {
                lamina::look_from(volume, {.4, -.7, .9}, distance, scene);
                check(scene, std::string(function.name) + " " + name_of(projection) + " " +
                                 std::to_string(distance));
            }
        }
    }
}

}  // namespace lamina
