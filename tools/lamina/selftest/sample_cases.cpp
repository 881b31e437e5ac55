// SPDX-License-Identifier: Apache-2.0
// One trilinear cell, seen along a diagonal: the scalar along the ray is a polynomial, and opacity
// has a closed form.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "selftest/case_makers.h"

namespace lamina::selftest {
namespace {

constexpr glm::dvec3 cell_color{.5, 1, .25};
// Roundings of a scalar of float32 between 0 and 1, some four of them, and of opacity.
constexpr double cell_scalar_error = 0x1p-22, cell_opacity_error = 0x1p-20;

struct CellScene {
    std::string name, about;
    bool saddle = false;  // the scalar is x y; otherwise it is x y z
    TransferFunction transfer_function;
    double opacity = 0;
    // How much optical depth moves per unit by which the scalar is off.
    double depth_per_scalar = 0;
};

Volume cell_volume(bool saddle) {
    Grid grid;
    grid.size = {2, 2, 2};
    grid.centering = {Centering::node, Centering::node, Centering::node};
    const auto samples = std::make_shared<std::array<float, 8>>();
    for (std::size_t i = 0; i < 8; ++i) (*samples)[i] = (saddle ? (i & 3) == 3 : i == 7) ? 1 : 0;
    return {grid, SampleType::float32, {samples, samples->data()}};
}

// One ray, from corner to corner of the cell; of the saddle, from (1, 0) to (0, 1).
Scene cell_scene_of(const CellScene& cell) {
    Scene scene;
    scene.transfer_function = cell.transfer_function;
    scene.camera->projection = Projection::orthographic;
    scene.camera->center = {.5, .5, .5};
    scene.camera->eye = cell.saddle ? glm::dvec3(2.5, -1.5, .5) : glm::dvec3(3, 3, 3);
    scene.camera->up = {0, .1, 1};
    scene.camera->height = 1e-9;
    scene.width = scene.height = 1;
    scene.slice.samples = 1;
    return scene;
}

TransferFunction shown_from(double lo) {
    return optics_of({{lo, {cell_color, 0}}, {lo, {cell_color, 50}}});
}

TransferFunction shown_between(double lo, double hi, double extinction) {
    return optics_of({{lo, {cell_color, 0}},
                      {lo, {cell_color, extinction}},
                      {hi, {cell_color, extinction}},
                      {hi, {cell_color, 0}}});
}

// The scalar is t^3 over a length of sqrt(3).
CellScene corner(const std::string& name, const std::string& about, double lo, double hi,
                 double extinction) {
    const double length = std::sqrt(3.) * (std::cbrt(hi) - std::cbrt(lo));
    const auto per_scalar = [&](double s) {
        return extinction * std::sqrt(3.) / (3 * std::cbrt(s) * std::cbrt(s));
    };
    return {name,
            about,
            false,
            shown_between(lo, hi, extinction),
            -std::expm1(-extinction * length),
            per_scalar(lo) + per_scalar(hi)};
}

std::vector<CellScene> all_cells() {
    std::vector<CellScene> cells;
    const double ramp = 4;  // the mean of t^3 is a quarter
    cells.push_back({"corner_ramp", "The scalar is t^3, and extinction follows it", false,
                     optics_of({{0, {cell_color, 0}}, {1, {cell_color, ramp}}}),
                     -std::expm1(-std::sqrt(3.) * ramp / 4), ramp * std::sqrt(3.)});
    cells.push_back(corner("peak", "Extinction between the scalars .2 and .3 alone", .2, .3, 7));
    cells.push_back(corner("narrow_peak", "A peak of a thousandth of the range inside one cell", .5,
                           .501, 2000));
    // The scalar is t (1 - t) over a length of sqrt(2), .25 at its top.
    cells.push_back({"touched_point",
                     "The scalar comes within 1e-6 of a step and does not cross it", true,
                     shown_from(.25 + 1e-6), 0, 0});
    const double open = std::sqrt(4 * .01);
    cells.push_back({"crossed_twice", "The scalar crosses a step upwards and downwards", true,
                     shown_from(.24), -std::expm1(-50 * std::sqrt(2.) * open),
                     50 * std::sqrt(2.) * 2 / open});
    return cells;
}

CaseOutcome outcome_of_cell(const CellScene& cell, const DrawingWay& way,
                            const PictureMaker& maker) {
    const PreciseImage picture =
        maker.draw(way.scene_of(cell_scene_of(cell)), SceneData(cell_volume(cell.saddle)));
    CaseOutcome outcome;
    outcome.bound =
        255 * (cell_scalar_error * cell.depth_per_scalar * (1 - cell.opacity) + cell_opacity_error);
    const double* const pixel = picture.pixel(0, 0);
    for (int channel = 0; channel < 4; ++channel) {
        const double exact = cell.opacity * (channel < 3 ? cell_color[channel] : 1);
        outcome.error = std::max(outcome.error, 255 * std::abs(pixel[channel] - exact));
    }
    outcome.largest_error = outcome.error;
    if (outcome.error <= outcome.bound) return outcome;
    outcome.verdict = Verdict::failed;
    outcome.note = fmt::format("opacity {:.9g}, expected {:.9g}", pixel[3], cell.opacity);
    return outcome;
}

}  // namespace

std::vector<SelftestCase> cell_cases() {
    std::vector<SelftestCase> cases;
    for (const CellScene& cell : all_cells()) {
        for (const DrawingWay& way : {traces().front(), way_named("slice exact float32")}) {
            cases.push_back({"cells", cell.name, way.name,
                             cell.about + ". Exact: opacity in closed form. Bound: a scalar off by "
                                          "four roundings of a float32.",
                             [cell, way](const PictureMaker& maker) {
                                 return outcome_of_cell(cell, way, maker);
                             }});
        }
    }
    return cases;
}

}  // namespace lamina::selftest
