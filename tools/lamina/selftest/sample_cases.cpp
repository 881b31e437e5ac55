// SPDX-License-Identifier: Apache-2.0
// Cases of one trilinear cell, seen along a diagonal: the scalar along the ray is a polynomial, and
// opacity has a closed form. Cases of extreme numbers: coordinates, sizes and sample types.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "selftest/case_makers.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {
namespace {

constexpr glm::dvec3 cell_color{.5, 1, .25};
// Errors of a float32 scalar between 0 and 1 (about four roundings) and of opacity.
constexpr double cell_scalar_error = 0x1p-22, cell_opacity_error = 0x1p-20;

struct CellScene {
    std::string name, about;
    bool saddle = false;  // the scalar is x y; otherwise it is x y z
    TransferFunction transfer_function;
    double opacity = 0;  // exact opacity of the ray
    // Change of optical depth per unit of error of the scalar.
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

// Returns a scene of one ray. It passes through opposite corners of the cell or, for the saddle,
// from (1, 0) to (0, 1).
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

// Returns a case in which the scalar is t^3 along a ray of length sqrt(3).
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
    const double ramp = 4;  // of extinction at scalar 1; the mean of t^3 is a quarter
    cells.push_back({"corner_ramp", "The scalar is t^3, and extinction follows it", false,
                     optics_of({{0, {cell_color, 0}}, {1, {cell_color, ramp}}}),
                     -std::expm1(-std::sqrt(3.) * ramp / 4), ramp * std::sqrt(3.)});
    cells.push_back(corner("peak", "Extinction between the scalars .2 and .3 alone", .2, .3, 7));
    cells.push_back(corner("narrow_peak", "A peak of a thousandth of the range inside one cell", .5,
                           .501, 2000));
    // The scalar is t (1 - t) along a length of sqrt(2), .25 at its maximum.
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

constexpr const char* number_group = "numbers";
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

SelftestScene box_scene(const std::string& name, const std::string& about, const glm::dvec3& corner,
                        const glm::dvec3& size) {
    SelftestScene scene = plain_scene(name, about);
    scene.box.corner = corner;
    scene.box.edges = {{{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}}};
    scene.box.samples = {0, 1, .25};
    const double depth = 1 / scene.box.longest_edge();
    scene.scene.transfer_function =
        optics_of({{0, {{.9, .5, .2}, .2 * depth}}, {1, {{.9, .5, .2}, 3 * depth}}});
    scene.scene.camera = camera_at(scene.box, 1.5, 40);
    return scene;
}

void append_boxes(std::vector<SelftestScene>& scenes) {
    scenes.push_back(box_scene("offset_1e7", "World coordinates around 1e7, a box of size 1",
                               {1e7, -1e7, 1e7}, {1, 1, 1}));
    scenes.push_back(box_scene("size_1e-9", "A box of size 1e-9", {0, 0, 0}, {1e-9, 1e-9, 1e-9}));
    scenes.push_back(box_scene("size_1e9", "A box of size 1e9", {-1e9, 0, 5}, {1e9, 1e9, 1e9}));
    scenes.push_back(
        box_scene("flat_1e4", "A box 1e4 times as wide as thick", {0, 0, 0}, {1, 1, 1e-4}));
    SelftestScene long_box =
        box_scene("long_1e4", "A box 1e4 times as long as wide, seen through its length", {0, 0, 0},
                  {1e-4, 1e-4, 1});
    long_box.scene.camera->eye = long_box.scene.camera->center + glm::dvec3(3e-5, -2e-5, 1.2);
    long_box.scene.camera->fov_y = .01;
    scenes.push_back(long_box);
}

// Returns a ramp, in layers, from the least to the largest value of a type.
SelftestScene type_scene(const std::string& name, SampleType type, double lo, double hi) {
    SelftestScene scene = plain_scene(
        name, fmt::format("Samples of type {} from {:g} to {:g}", name_of(type), lo, hi));
    const double middle = std::trunc(.5 * lo + .5 * hi);
    scene.box.type = type;
    scene.box.samples = {lo, hi, type == SampleType::float32 ? .5 * lo + .5 * hi : middle, lo};
    scene.scene.transfer_function = optics_of({{lo, {{.9, .5, .2}, 0}}, {hi, {{.9, .5, .2}, 3}}});
    return scene;
}

void append_types(std::vector<SelftestScene>& scenes) {
    scenes.push_back(type_scene("uint8", SampleType::uint8, 0, 255));
    scenes.push_back(type_scene("int16_extremes", SampleType::int16, -32768, 32767));
    scenes.push_back(type_scene("uint16_extremes", SampleType::uint16, 0, 65535));
    scenes.push_back(type_scene("float_1e38", SampleType::float32, -0x1p126, 0x1p126));
    scenes.push_back(type_scene("float_subnormal", SampleType::float32, 0, 0x1p-130));
    scenes.push_back(type_scene("float_offset", SampleType::float32, 1048576, 1048576 + 64));
}

void append_shapes(std::vector<SelftestScene>& scenes) {
    SelftestScene constant = plain_scene("constant_volume", "All samples alike, colours are not");
    constant.box.samples = {.5, .5, .5};
    scenes.push_back(constant);
    for (const auto& [name, across] : {std::pair{"volume_1_n_m", std::array<std::int64_t, 2>{1, 4}},
                                       {"volume_n_1_m", std::array<std::int64_t, 2>{4, 1}},
                                       {"volume_1_1_m", std::array<std::int64_t, 2>{1, 1}}}) {
        SelftestScene scene = plain_scene(name, "Axes of one sample: a voxel thick");
        scene.box.samples_across = across;
        scene.box.samples = {0, 1, .25};
        scenes.push_back(scene);
    }
    SelftestScene one = plain_scene("volume_1_1_1", "A volume of one sample");
    one.box.samples_across = {1, 1};
    one.box.samples = {.5};
    one.mesh = nullptr;
    scenes.push_back(one);
}

SelftestScene not_finite(const std::string& name, double value) {
    SelftestScene scene = plain_scene(name, "A layer of samples that are no finite numbers");
    scene.box.samples = {0, 1, value, .5, .25};
    scene.mesh = nullptr;
    return scene;
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

std::vector<SelftestCase> number_cases() {
    std::vector<SelftestScene> scenes;
    append_boxes(scenes);
    append_types(scenes);
    append_shapes(scenes);
    for (const auto& [name, value] : {std::pair{"nan", nan}, {"infinity", infinity}}) {
        SelftestScene scene = not_finite(fmt::format("{}_transparent", name), value);
        scene.scene.nan = NanPolicy::transparent;
        scenes.push_back(scene);
    }
    std::vector<SelftestCase> cases =
        cases_of(number_group, scenes,
                 traces_and({"slice post float32", "slice preintegrated float32", "project float32",
                             "project analytic float32"}));
    const char* const reason = "NaN or infinite samples";
    cases.push_back(refusal_case(number_group, not_finite("nan_error", nan),
                                 way_named("slice post float32"), reason));
    cases.push_back(refusal_case(number_group, not_finite("infinity_error", infinity),
                                 way_named("slice post float32"), reason));
    return cases;
}

}  // namespace lamina::selftest
