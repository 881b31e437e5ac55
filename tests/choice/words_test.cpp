// SPDX-License-Identifier: Apache-2.0
#include "choice/words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "choice/field.h"
#include "choice/open_scene.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "support/expect_error.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

Adjustments adjusted_by(const Words& words) {
    return adjustments_of(words, ImageColorSpace::linear);
}

// A cube of 21 samples along each edge, of values 1 to 100 in a border of 0, or of -1000.
struct Cube {
    explicit Cube(double outside = 0, double factor = 1)
        : volume(test::volume_of<float>(
              test::grid_of({21, 21, 21}, Centering::node),
              [=](double x, double y, double z) {
                  const bool in = std::min({x, y, z}) >= 3 && std::max({x, y, z}) <= 17;
                  return in ? factor * (1 + x + y + z) : outside;
              })),
          bricks(measure_bricks(volume)),
          field(volume, bricks) {}
    Volume volume;
    MinMaxBricks bricks;
    VolumeField field;
};

using test::open_scene;

Scene chosen_with(const Words& words, const Field& field, Scene scene = open_scene()) {
    const Adjustments adjustments = adjusted_by(words);
    adjust_scene(scene, adjustments);
    return choose(std::move(scene), field, adjustments).scene;
}

TEST(ClipWords, AreThePlanesThatTheyStandFor) {
    const auto planes = [](const std::string& text) {
        return adjusted_by({.clip = {text}}).clip.planes;
    };
    const ClipPlane from{{10, 0, 0}, {1, 0, 0}}, up_to{{0, -2.5, 0}, {0, -1, 0}};
    EXPECT_EQ(planes("x:10:"), std::vector{from});
    EXPECT_EQ(planes("x>10"), std::vector{from});
    EXPECT_EQ(planes("y::-2.5"), std::vector{up_to});
    EXPECT_EQ(planes("y<-2.5"), std::vector{up_to});
    EXPECT_EQ(planes("z:1:2"),
              (std::vector<ClipPlane>{{{0, 0, 1}, {0, 0, 1}}, {{0, 0, 2}, {0, 0, -1}}}));
}

TEST(CropWords, AreABoxOrPlanesIfEndsAreOpen) {
    const Clip box = adjusted_by({.crop = "1:2,-3:4,5:6.5"}).clip;
    EXPECT_EQ(box.box, (ClipBox{{1, -3, 5}, {2, 4, 6.5}}));
    EXPECT_TRUE(box.planes.empty());
    const Clip open = adjusted_by({.crop = "1:,:,:6"}).clip;
    EXPECT_FALSE(open.box);
    EXPECT_EQ(open.planes,
              (std::vector<ClipPlane>{{{1, 0, 0}, {1, 0, 0}}, {{0, 0, 6}, {0, 0, -1}}}));
}

TEST(Words, MistakesNameTheWordAndWhatIsExpected) {
    const std::vector<std::pair<Words, std::string>> mistakes{
        {{.up = "z"}, "up z: expected +x, -x, +y, -y, +z or -z"},
        {{.view = "above"}, "view above: expected iso, front, back, left, right, top or bottom"},
        {{.light = "sun"}, "light sun: expected headlight, left, right or two"},
        {{.crop = "1:2,3:4"}, "crop 1:2,3:4: expected x0:x1"},
        {{.crop = "1:2,3:4,5:6,7:8"}, "crop"},
        {{.crop = "2:1,3:4,5:6"}, "crop"},
        {{.opacity = "linea"}, "opacity linea: expected linear"},
        {{.opacity = "colormap"}, "opacity colormap: expected linear"},
        {{.opacity = "sigmoid_21"}, "opacity sigmoid_21: expected"},
        {{.preset = "ct-bones"}, "preset ct-bones: expected one of ct-bone, ct-soft-tissue"},
        {{.range = "3"}, "range 3: expected LO,HI"},
        {{.clip = {"x"}}, "clip x: expected x:10:"},
        {{.clip = {"x:10"}}, "clip x:10: expected x:10:"},
        {{.clip = {"x::"}}, "clip x::: expected x:10:"},
        {{.clip = {"w>1"}}, "clip w>1: expected"},
        {{.clip = {"x>ten"}}, "clip x>ten: expected"},
        {{.clip = {"x>nan"}}, "clip x>nan: expected"}};
    for (const auto& [words, message] : mistakes)
        expect_error([&] { adjusted_by(words); }, {message});
}

TEST(Words, CuttingTwiceCutsOnce) {
    Scene scene;
    const Adjustments adjustments = adjusted_by({.clip = {"x>1", "y<2"}});
    adjust_scene(scene, adjustments);
    adjust_scene(scene, adjustments);
    EXPECT_EQ(scene.clip.planes.size(), 2u);
}

TEST(LightWords, ShineFromTheirSideOfThePicture) {
    Camera camera;
    camera.eye = {3, -4, 2};
    camera.center = {1, 1, 0};
    camera.up = {0, 0, 1};
    const View view(camera, 1, 1);
    EXPECT_EQ(lights_of(LightWord::headlight, camera), std::vector<Light>(1));
    const auto left = lights_of(LightWord::left, camera);
    const auto right = lights_of(LightWord::right, camera);
    ASSERT_TRUE(left.size() == 1 && right.size() == 1);
    EXPECT_LT(glm::dot(*left[0].direction, view.right), 0);
    EXPECT_GT(glm::dot(*right[0].direction, view.right), 0);
    for (const auto& direction : {*left[0].direction, *right[0].direction}) {
        EXPECT_GT(glm::dot(direction, view.up), 0);
        EXPECT_LT(glm::dot(direction, view.forward), 0);
    }
    const auto two = lights_of(LightWord::two, camera);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0], left[0]);
    EXPECT_GT(glm::dot(*two[1].direction, view.right), 0);
    EXPECT_LT(two[1].color.r, two[0].color.r);
}

TEST(LightWords, AreLightsOfTheChosenCamera) {
    const Cube cube;
    const Scene scene = chosen_with({.view = "left", .light = "two"}, cube.field);
    ASSERT_TRUE(scene.lighting);
    EXPECT_EQ((*scene.lighting)->lights, lights_of(LightWord::two, *scene.camera));
    EXPECT_TRUE((*scene.lighting)->smallest_gradient.is_given());
    // A scene's own terms stay.
    Scene shiny = open_scene();
    shiny.lighting = Lighting{};
    (*shiny.lighting)->specular = .9;
    const Scene lit = chosen_with({.light = "left"}, cube.field, shiny);
    EXPECT_EQ((*lit.lighting)->specular, .9);
    EXPECT_EQ((*lit.lighting)->lights.size(), 1u);
}

// The formulas of docs/first-picture.md, written again.
TEST(OpacityWords, FollowTheirFormulas) {
    const auto at = [](const std::string& word, double t) { return opacity_curve(word).at(t); };
    for (const double t : {0., .1, .5, .75, 1.}) {
        EXPECT_EQ(at("linear", t), t);
        EXPECT_EQ(at("linear_r", t), 1 - t);
        EXPECT_NEAR(at("geom", t), std::exp((t - 1) * std::log(255e6)), 1e-14);
        EXPECT_NEAR(at("geom_r", t), std::exp(-t * std::log(255e6)), 1e-14);
        EXPECT_NEAR(at("sigmoid", t), 1 / (1 + std::exp(10 - 20 * t)), 1e-15);
        EXPECT_NEAR(at("sigmoid_3", t), 1 / (1 + std::exp(3 - 6 * t)), 1e-15);
        EXPECT_EQ(at("foreground", t), 1);
    }
    for (const char* const none : {"", "linear_rr", "nan", "a:0,b:1"})
        expect_error([&] { opacity_curve(none); }, {"linear, linear_r, geom"});
    for (const char* const none : {"sigmoid_", "sigmoid_0", "sigmoid_5x", "sigmoid_21"})
        expect_error([&] { opacity_curve(none); }, {"sigmoid_1 to sigmoid_20"});
}

TEST(OpacityWords, StraightPiecesFollowTheCurve) {
    const auto function = TransferFunction::linear({{0, {{1, 0, 0}, 0}}, {40, {{0, 0, 1}, 5}}});
    for (const char* const word : {"linear", "geom", "geom_r", "sigmoid", "sigmoid_20"}) {
        const OpacityCurve curve = opacity_curve(word);
        const auto shaped = with_opacity(function, curve, {10, 30});
        EXPECT_EQ(shaped.at(9.999).extinction, 0) << word;
        for (double t = 1e-9; t <= 1; t += 1. / 512) {
            const auto optics = shaped.at(10 + 20 * t);
            // Twice the tolerance of the pieces, which is tested at their quarters only.
            EXPECT_NEAR(optics.extinction, curve.at(t), 2e-3) << word << " " << t;
            EXPECT_NEAR(optics.color.r, 1 - (10 + 20 * t) / 40, 1e-12) << word;
        }
        EXPECT_NEAR(shaped.at(100).extinction, curve.at(1), 1e-15) << word;
    }
}

TEST(OpacityWords, RunOverWhatShows) {
    const auto function = TransferFunction::linear(
        {{0, {{}, 0}}, {10, {{}, 0}}, {20, {{}, 3}}, {30, {{}, 0}}, {50, {{}, 0}}});
    EXPECT_EQ(shown_range(function), (ValueRange{10, 30}));
    // The function shows nothing above, so neither does the curve.
    const auto flat = with_opacity(function, opacity_curve("foreground"), {10, 50});
    EXPECT_EQ(flat.at(40).extinction, 1);
    EXPECT_EQ(flat.at(50.001).extinction, 0);
}

TEST(OpacityWords, CanBeNumbers) {
    const auto at = [](const std::string& word, double t) { return opacity_curve(word).at(t); };
    EXPECT_EQ(at("0,1", .25), .25);
    EXPECT_EQ(at("0,.5,1,.25", 1. / 3), .5);
    EXPECT_EQ(at("0,.5,1,.25", 1), .25);
    EXPECT_EQ(at("10:0,20:1,50:0", .25), 1);
    EXPECT_NEAR(at("10:0,20:1,50:0", .625), .5, 1e-15);
    const TransferFunction function =
        TransferFunction::linear({{0, {glm::dvec3(1), 1}}, {100, {glm::dvec3(1), 2}}});
    // Numbers in place of t are 0 below; those with values of their own are constant outside.
    const auto spread = with_opacity(function, opacity_curve("1,.5"), {10, 30});
    EXPECT_EQ(spread.at(9).extinction, 0);
    EXPECT_EQ(spread.at(20).extinction, .75);
    const OpacityCurve pairs = opacity_curve("10:1,30:.5");
    ASSERT_TRUE(pairs.range);
    const auto own = with_opacity(function, pairs, *pairs.range);
    EXPECT_EQ(own.at(-5).extinction, 1);
    EXPECT_EQ(own.at(20).extinction, .75);
    EXPECT_EQ(own.at(99).extinction, .5);
}

TEST(OpacityWords, MistakesInNumbersSayWhatIsWrong) {
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"1", "two or more numbers, as in 0,.2,.9"},
        {"1:0", "two or more numbers"},
        {",", "numbers from 0 to 1, found none"},
        {"0,", "numbers from 0 to 1, found none"},
        {",1", "numbers from 0 to 1, found none"},
        {"0,2", "numbers from 0 to 1, found 2"},
        {"-1,1", "numbers from 0 to 1, found -1"},
        {"0,nan", "numbers from 0 to 1, found nan"},
        {"0,1 ", "numbers from 0 to 1, found 1 "},
        {"0,0", "a number above 0"},
        {"1:0,1:1", "rising values, found 1 after 1"},
        {"2:0,1:1", "rising values, found 1 after 2"},
        {"1:0,2", "a value before each number, as in 10:0,20:.5, found 2 without one"},
        {":0,2:1", "a value before each number, found none"},
        {"1:0,2:3", "numbers from 0 to 1 after the values, found 3"}};
    for (const auto& [word, message] : mistakes)
        expect_error([&] { opacity_curve(word); }, {message});
    expect_error([] { adjusted_by({.opacity = "0,2"}); },
                 {"opacity 0,2: expected numbers from 0 to 1, found 2"});
}

// The density is the automatic one: the median ray has an opacity of .9 (docs/first-picture.md).
TEST(OpacityWords, HaveTheAutomaticDensity) {
    const Cube cube;
    for (const char* const word : {"linear", "sigmoid"}) {
        Scene square = open_scene();
        square.width = square.height = 512;  // as the picture in which the density is measured
        const Scene scene = chosen_with({.opacity = word, .range = "5,50"}, cube.field, square);
        const TransferFunction& function = *scene.transfer_function;
        const double full = function.at(50).extinction;
        EXPECT_NEAR(function.at(20).extinction / full, opacity_curve(word).at(1. / 3), 1e-3);
        std::vector<double> depths = cube.field.optical_depths(scene);
        const double least = *std::ranges::max_element(depths) / 500;
        std::erase_if(depths, [&](double depth) { return !(depth > least); });
        const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
        std::ranges::nth_element(depths, middle);
        // float32 sums of some 100 numbers.
        EXPECT_NEAR(*middle, std::log(10), 2e-5 * std::log(10)) << word;
    }
}

TEST(Presets, StandForTheirWords) {
    const Cube cube;
    for (const Preset& preset : presets()) {
        if (std::string(preset.opacity) == "colormap") continue;  // in HU
        const Scene a = chosen_with({.preset = preset.name}, cube.field);
        const Scene b = chosen_with(
            {.light = preset.light, .opacity = preset.opacity, .colormap = preset.colormap},
            cube.field);
        EXPECT_EQ(a.transfer_function, b.transfer_function) << preset.name;
        EXPECT_EQ(a.lighting, b.lighting) << preset.name;
        // A word beside the preset wins.
        const Scene c = chosen_with({.light = "right", .preset = preset.name}, cube.field);
        EXPECT_EQ((*c.lighting)->lights, lights_of(LightWord::right, *c.camera)) << preset.name;
    }
}

TEST(Presets, InHounsfieldUnitsShowTheirValuesOfCt) {
    const Cube ct(-1000, 30);  // air around 300 to 1560 HU
    const Scene scene = chosen_with({.preset = "ct-bone"}, ct.field);
    const TransferFunction& function = *scene.transfer_function;
    EXPECT_EQ(function.at(-1000).extinction, 0);
    EXPECT_EQ(function.at(140).extinction, 0);
    // In proportion to the extinctions of the map's opacities at 300 and 1200 HU.
    EXPECT_NEAR(function.at(300).extinction / function.at(1200).extinction,
                std::log1p(-.06) / std::log1p(-.6), 1e-12);
}

TEST(Presets, AndMapsInHounsfieldUnitsRefuseOtherData) {
    const Cube unsigned_like;  // from 0 on, as headsq.nrrd of the examples
    for (const Words& words : {Words{.preset = "ct-bone"}, Words{.colormap = "ct-soft-tissue"}}) {
        expect_error([&] { chosen_with(words, unsigned_like.field); },
                     {"none is below 0, but air is -1000 HU", "a range LO,HI"});
    }
    const Cube small(-1);  // from -1 to 52
    expect_error([&] { chosen_with({.preset = "ct-bone"}, small.field); },
                 {"which shows", "HU", "a range LO,HI"});
    // A range says where the map lies.
    const Scene scene = chosen_with({.colormap = "ct-bone", .range = "10,50"}, unsigned_like.field);
    EXPECT_EQ(scene.transfer_function->at(10).extinction, 0);
    EXPECT_GT(scene.transfer_function->at(50).extinction, 0);
}

// The camera fits what a crop leaves: it is the camera of the cut cube's corners.
TEST(CropWords, FitTheCameraToWhatIsLeft) {
    const Cube cube;
    const Scene whole = chosen_with({}, cube.field);
    const Scene cut = chosen_with({.crop = "5:12,6:11,4.5:13"}, cube.field);
    std::vector<glm::dvec3> corners;
    for (int corner = 0; corner < 8; ++corner)
        corners.emplace_back((corner & 1) != 0 ? 12 : 5, (corner & 2) != 0 ? 11 : 6,
                             (corner & 4) != 0 ? 13 : 4.5);
    const Orientation from = orientation_of(WorldAxes::unnamed, cube.field.corners());
    const Camera expected =
        fitted_camera(corners, from.front, turn_to(ViewSide::iso, from), 64, 48);
    EXPECT_LT(glm::distance(cut.camera->eye, expected.eye), 1e-9);
    EXPECT_LT(glm::distance(cut.camera->eye, cut.camera->center),
              .7 * glm::distance(whole.camera->eye, whole.camera->center));
}

TEST(CropWords, FitTheCameraToWhatIsLeftOfAMesh) {
    Scene scene = open_scene();
    scene.transfer_function =
        TransferFunction::linear({{0, {glm::dvec3(1), 1}}, {36, {glm::dvec3(1), 2}}});
    const SceneMesh mesh = scene_mesh(
        Scene(), test::kuhn_box({12, 12, 12}, [](const glm::dvec3& p) { return p.x + p.y + p.z; }));
    const MeshField field(mesh);
    const Scene cut = chosen_with({.crop = "2.5:9,3:8.5,4:7"}, field, scene);
    const Orientation from = orientation_of(WorldAxes::named, field.corners());
    const auto corners = box_corners({2.5, 3, 4}, {9, 8.5, 7});
    const Camera expected =
        fitted_camera(corners, from.front, turn_to(ViewSide::iso, from), 64, 48);
    // Corners are where rounded planes cross rounded edges: 1e-10 of the mesh's size.
    EXPECT_LT(glm::distance(cut.camera->eye, expected.eye), 1e-8);
    EXPECT_EQ(cut.camera->up, glm::dvec3(0, 0, 1));
}

TEST(ViewWords, ReplaceTheCameraOfAScene) {
    const Cube cube;
    Scene scene = open_scene();
    scene.camera = Camera{};
    scene.camera->eye = {50, 60, 70};
    const Scene same = chosen_with({}, cube.field, scene);
    EXPECT_EQ(same.camera->eye, scene.camera->eye);
    const Scene front = chosen_with({.up = "+z", .view = "front"}, cube.field, scene);
    const glm::dvec3 toward = glm::normalize(front.camera->eye - front.camera->center);
    EXPECT_LT(glm::distance(toward, glm::dvec3(0, -1, 0)), 1e-12);
    EXPECT_EQ(front.camera->up, glm::dvec3(0, 0, 1));
    // Azimuth and elevation start at the side: this is the three-quarter view.
    const Scene turned =
        chosen_with({.azimuth = 30, .elevation = 20, .up = "+z", .view = "front"}, cube.field);
    const Scene iso = chosen_with({.up = "+z"}, cube.field);
    EXPECT_EQ(turned.camera->eye, iso.camera->eye);
}

}  // namespace
}  // namespace lamina
