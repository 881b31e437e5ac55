// SPDX-License-Identifier: Apache-2.0
// Extreme numbers: coordinates, sizes, anisotropy, sample types and their extremes.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "selftest/case_makers.h"
#include "selftest/selftest_meshes.h"

namespace lamina::selftest {
namespace {

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

// A ramp over all values of a type, in layers.
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
    std::vector<DrawingWay> ways = traces();
    for (const char* name : {"slice post float32", "slice preintegrated float32", "project float32",
                             "project analytic float32"})
        ways.push_back(way_named(name));
    std::vector<SelftestCase> cases;
    for (const SelftestScene& scene : scenes) {
        for (SelftestCase& each : cases_of(number_group, scene, ways)) cases.push_back(each);
    }
    const char* const reason = "NaN or infinite samples";
    cases.push_back(refusal_case(number_group, not_finite("nan_error", nan),
                                 way_named("slice post float32"), reason));
    cases.push_back(refusal_case(number_group, not_finite("infinity_error", infinity),
                                 way_named("slice post float32"), reason));
    return cases;
}

}  // namespace lamina::selftest
