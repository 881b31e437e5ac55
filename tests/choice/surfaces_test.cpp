// SPDX-License-Identifier: Apache-2.0
// Automatic pictures of volumes whose parts, noise and surfaces are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <random>

#include "choice/choose.h"
#include "choice/field.h"
#include "choice/open_scene.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr double last_sample = 63, outer_radius = 24, inner_radius = 12;  // samples
constexpr double air = 20, flesh = 100, bone = 200;                       // values
constexpr double sigma = 6;                                               // of the noise

double distance_to_middle(double i, double j, double k) {
    return glm::length(glm::dvec3(i, j, k) - glm::dvec3(last_sample / 2));
}

// A value that goes from `inside` to `outside` at a radius, within some two samples.
double blurred(double distance, double radius, double inside, double outside) {
    const double place = std::clamp((distance - radius) / 2 + .5, 0., 1.);
    return inside + (outside - inside) * place;
}

// A ball of bone in one of flesh, in air.
double scanned(double distance) {
    return distance < (inner_radius + outer_radius) / 2
               ? blurred(distance, inner_radius, bone, flesh)
               : blurred(distance, outer_radius, flesh, air);
}

struct Scan {
    std::mt19937 random{3};
    std::normal_distribution<double> normal{0, sigma};
    Volume volume = test::volume_of<std::int16_t>(
        test::grid_of({64, 64, 64}, Centering::node), [this](double i, double j, double k) {
            return std::round(scanned(distance_to_middle(i, j, k)) + normal(random));
        });
    MinMaxBricks bricks = measure_bricks(volume);
    VolumeField field{volume, bricks};
};

Scene picture_scene(int width = 64, int height = 64) {
    Scene scene = test::open_scene(width, height);
    scene.lighting = automatic;
    return scene;
}

// The opacity of a ray that goes straight from one distance from the middle to another.
double opacity_along(const TransferFunction& function, double from, double to) {
    double depth = 0;
    constexpr double step = .01;
    for (double at = from - step / 2; at > to; at -= step)
        depth += step * function.at(scanned(at)).extinction;
    return -std::expm1(-depth);
}

// White noise has 3 values in 10,000 that are more than 3.6 sigma from the mean.
TEST(Surfaces, NoiseAroundAThingIsTransparent) {
    const Scan scan;
    const TransferFunction function = *choose(picture_scene(), scan.field).scene.transfer_function;
    EXPECT_TRUE(function.transparent(-1e3, air + 3.6 * sigma));
}

TEST(Surfaces, TwoMaterialsGetTwoColorsAndTheOuterOneDoesNotHideTheInner) {
    const Scan scan;
    const auto [scene, reasons] = choose(picture_scene(), scan.field);
    const TransferFunction& function = *scene.transfer_function;
    EXPECT_NE(reasons[0].find("2 materials"), std::string::npos) << reasons[0];
    const glm::dvec3 apart = glm::abs(function.at(flesh).color - function.at(bone).color);
    // A sixteenth of full scale in one channel is a step that everybody sees.
    EXPECT_GT(std::max({apart.r, apart.g, apart.b}), 1. / 16);
    // One material has one colour, whatever its noise.
    EXPECT_EQ(function.at(flesh - 2 * sigma).color, function.at(flesh + 2 * sigma).color);
    EXPECT_EQ(function.at(bone - 2 * sigma).color, function.at(bone + 2 * sigma).color);
    const double shell = opacity_along(function, last_sample / 2, inner_radius + 2);
    EXPECT_GT(shell, .1);
    EXPECT_LT(shell, .7);
    // The surface inside is dense: what shows of it lies within two samples.
    EXPECT_GT(opacity_along(function, inner_radius + 2, inner_radius - 2), .9);
}

// Things with sharp edges have no values between theirs and those of the air.
TEST(Surfaces, OfSharpEdgesInNoiseLieBetweenTheHumps) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, sigma);
    const auto transfer_for = [&](const auto& is_bone) {
        const Volume volume = test::volume_of<std::int16_t>(
            test::grid_of({64, 64, 64}, Centering::node), [&](double i, double j, double k) {
                return std::round((is_bone(i, j, k) ? bone : air) + normal(random));
            });
        const MinMaxBricks bricks = measure_bricks(volume);
        return choose(picture_scene(), VolumeField(volume, bricks));
    };
    const auto [scene, reasons] = transfer_for(
        [](double i, double j, double k) { return distance_to_middle(i, j, k) < outer_radius; });
    EXPECT_NE(reasons[0].find("one material"), std::string::npos) << reasons[0];
    const TransferFunction& function = *scene.transfer_function;
    EXPECT_TRUE(function.transparent(-1e3, air + 4.5 * sigma));  // 1 sample in 150,000 is higher
    EXPECT_GT(function.at((air + bone) / 2).extinction, 0);
    // Samples of either value by chance have no surface.
    const auto mixed = transfer_for([&](double, double, double) { return random() % 3 == 0; });
    EXPECT_EQ(mixed.reasons[0].find("material"), std::string::npos) << mixed.reasons[0];
}

TEST(Surfaces, DoNotDependOnThePicture) {
    const Scan scan;
    const Scene small = choose(picture_scene(200, 150), scan.field).scene;
    for (const auto& [width, height] : {std::pair(800, 600), {400, 400}, {900, 100}}) {
        const Scene other = choose(picture_scene(width, height), scan.field).scene;
        EXPECT_EQ(other.transfer_function, small.transfer_function) << width << " x " << height;
    }
    const Scene turned = choose(picture_scene(), scan.field, {.turn = {70, 20}, .zoom = 3}).scene;
    EXPECT_EQ(turned.transfer_function, small.transfer_function);
}

// The surfaces of a smooth field enclose ever smaller shares of it.
TEST(Surfaces, OfASmoothFieldLetInnerOnesShow) {
    const Volume volume = test::volume_of(
        test::grid_of({64, 64, 64}, Centering::node), [](double i, double j, double k) {
            return std::exp(-std::pow(distance_to_middle(i, j, k) / 12, 2));
        });
    const MinMaxBricks bricks = measure_bricks(volume);
    const auto [scene, reasons] = choose(picture_scene(), VolumeField(volume, bricks));
    const TransferFunction& function = *scene.transfer_function;
    EXPECT_EQ(reasons[0].find("material"), std::string::npos) << reasons[0];
    EXPECT_EQ(function.at(0).extinction, 0);
    const auto knots = function.knots();
    const auto top = [&](std::size_t i) {
        return knots[i].optics.extinction > knots[i - 1].optics.extinction &&
               (i + 1 == knots.size() ||
                knots[i].optics.extinction >= knots[i + 1].optics.extinction);
    };
    std::size_t tops = 0;
    for (std::size_t i = 1; i < knots.size(); ++i) tops += top(i) ? 1 : 0;
    EXPECT_EQ(tops, 4u);
    EXPECT_NE(function.at(knots[2].value).color, knots.back().optics.color);
}

// Most values are near the upper end, and the four shares lie apart from it and from one another.
TEST(Surfaces, AreAtMostFourOfASolidThing) {
    const Volume volume = test::volume_of(
        test::grid_of({100, 20, 20}, Centering::node),
        [](double i, double, double) { return i < 60 ? 0 : .35 + .65 * (i - 60) / 39; });
    const MinMaxBricks bricks = measure_bricks(volume);
    const auto [scene, reasons] = choose(picture_scene(), VolumeField(volume, bricks));
    const auto knots = scene.transfer_function->knots();
    std::size_t tops = 0;
    for (std::size_t i = 1; i + 1 < knots.size(); ++i) {
        tops += knots[i].optics.extinction > knots[i - 1].optics.extinction &&
                knots[i].optics.extinction > knots[i + 1].optics.extinction;
    }
    EXPECT_LE(tops, 4u) << reasons[0];
}

bool is_cool(const glm::dvec3& color) {
    return color.b > color.r;
}

// Waves without a frequent value, as in turbulence.
Volume waves() {
    return test::volume_of(test::grid_of({48, 48, 48}, Centering::node),
                           [](double i, double j, double k) {
                               return std::sin(.31 * i + .2 * j) + std::sin(.37 * j - .17 * k) +
                                      std::sin(.29 * k + .1 * i);
                           });
}

TEST(Surfaces, OfAFieldWithoutABackgroundAreItsEnds) {
    const Volume volume = waves();
    const MinMaxBricks bricks = measure_bricks(volume);
    const auto [scene, reasons] = choose(picture_scene(), VolumeField(volume, bricks));
    const TransferFunction& function = *scene.transfer_function;
    EXPECT_NE(reasons[0].find("no value is a background"), std::string::npos) << reasons[0];
    EXPECT_TRUE(function.transparent(-1, 1));
    EXPECT_GT(function.at(-2.5).extinction, 0);
    EXPECT_GT(function.at(2.5).extinction, 0);
    EXPECT_TRUE(is_cool(function.at(-2.5).color));
    EXPECT_FALSE(is_cool(function.at(2.5).color));
    EXPECT_TRUE(scene.lighting);
}

TEST(Surfaces, OfTwoHalvesShowBoth) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, .04);
    const Volume volume = test::volume_of(test::grid_of({48, 48, 48}, Centering::node),
                                          [&](double i, double j, double k) {
                                              const double wave = 4 * std::sin(.4 * j + .3 * k);
                                              return std::tanh(i - 23.5 + wave) + noise(random);
                                          });
    const MinMaxBricks bricks = measure_bricks(volume);
    const auto [scene, reasons] = choose(picture_scene(), VolumeField(volume, bricks));
    const TransferFunction& function = *scene.transfer_function;
    EXPECT_TRUE(is_cool(function.at(-1).color));
    EXPECT_FALSE(is_cool(function.at(1).color));
    EXPECT_GT(function.at(-1).extinction, 0) << reasons[0];
    EXPECT_GT(function.at(1).extinction, 0);
}

TEST(Surfaces, OfADistanceIsThatAtZero) {
    for (const double sign : {1., -1.}) {
        const Volume volume = test::volume_of(
            test::grid_of({48, 48, 48}, Centering::node), [&](double i, double j, double k) {
                return sign * (glm::length(glm::dvec3(i, j, k) - 23.5) - 14);
            });
        const MinMaxBricks bricks = measure_bricks(volume);
        const auto [scene, reasons] = choose(picture_scene(), VolumeField(volume, bricks));
        const TransferFunction& function = *scene.transfer_function;
        EXPECT_NE(reasons[0].find("distances from a surface at 0"), std::string::npos)
            << reasons[0];
        EXPECT_EQ(function.at(sign * 3).extinction, 0);
        EXPECT_GT(function.at(sign * -3).extinction, 0);
    }
}

// A mesh is a body if its values have no background, or if those that are uncommon lie on its
// surface; not if they are inside, or run through it.
TEST(Surfaces, OfAMeshAreThoseOfABodyIfTheyShowMore) {
    const auto reason_for = [](const auto& value) {
        const SceneMesh mesh = scene_mesh(Scene(), test::kuhn_box({16, 16, 16}, value));
        const auto [scene, reasons] = choose(picture_scene(), MeshField(mesh));
        return reasons[0];
    };
    const auto is_body = [](const std::string& reason) {
        return reason.find("the mesh is a body") != std::string::npos;
    };
    const auto everywhere = reason_for([](const glm::dvec3& p) { return p.x + p.y * p.z; });
    EXPECT_TRUE(is_body(everywhere)) << everywhere;
    const auto at_walls =
        reason_for([](const glm::dvec3& p) { return 1 - std::exp(-(p.z + .1 * p.x) / 1.5); });
    EXPECT_TRUE(is_body(at_walls)) << at_walls;
    const auto inside = reason_for([](const glm::dvec3& p) {
        return std::exp(-std::pow(glm::length(p - glm::dvec3(8)) / 2.5, 2));
    });
    EXPECT_FALSE(is_body(inside)) << inside;
    const auto through = reason_for([](const glm::dvec3& p) {
        return std::exp(-std::pow(glm::length(glm::dvec2(p.x - 8, p.y - 8)) / 2.5, 2));
    });
    EXPECT_FALSE(is_body(through)) << through;
}

TEST(AutomaticLight, ShowsSurfacesButNotNoise) {
    const Scan scan;
    const auto [lit, reasons] = choose(picture_scene(), scan.field);
    ASSERT_TRUE(lit.lighting && lit.lighting->is_given());
    EXPECT_TRUE((*lit.lighting)->smallest_gradient.is_given());
    EXPECT_NE(reasons[2].find("lighting: lit"), std::string::npos) << reasons[2];
    const Volume noise = test::noise(test::grid_of({40, 40, 40}, Centering::node), 9);
    const MinMaxBricks bricks = measure_bricks(noise);
    const auto [unlit, why] = choose(picture_scene(), VolumeField(noise, bricks));
    EXPECT_FALSE(unlit.lighting);
    EXPECT_NE(why[2].find("not lit"), std::string::npos) << why[2];
}

// No sample lies between the values of a ball and of what is around it.
TEST(AutomaticLight, ShowsSharpEdges) {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, 2);
    const Volume volume = test::volume_of(
        test::grid_of({48, 48, 48}, Centering::node), [&](double i, double j, double k) {
            const bool inside = glm::length(glm::dvec3(i, j, k) - 23.5) < 16;
            return (inside ? 100 : 0) + noise(random);
        });
    const MinMaxBricks bricks = measure_bricks(volume);
    const auto [scene, reasons] = choose(picture_scene(), VolumeField(volume, bricks));
    EXPECT_TRUE(scene.lighting) << reasons[2];
    EXPECT_NE(reasons[2].find("edges are sharp"), std::string::npos) << reasons[2];
}

TEST(AutomaticLight, IsNotChosenWhereItWouldBeRefused) {
    const Scan scan;
    const auto reason_for = [&](const auto& change) {
        Scene scene = picture_scene();
        change(scene);
        const auto [chosen, reasons] = choose(scene, scan.field);
        EXPECT_FALSE(chosen.lighting);
        return reasons[2];
    };
    const auto expect = [](const std::string& reason, const char* key) {
        EXPECT_NE(reason.find(key), std::string::npos) << reason;
    };
    expect(reason_for([](Scene& scene) { scene.max_error = .1; }), "render.max_error");
    expect(reason_for([](Scene& scene) {
               scene.method = Method::project;
               scene.project.table = TableSettings{};
           }),
           "render.project.table");
    expect(reason_for([](Scene& scene) {
               scene.slice.tree = [] {
                   TreeSettings tree;
                   tree.factors = {4};
                   tree.nodes = NodeArithmetic::fixed;
                   return tree;
               }();
           }),
           "render.slice.tree");
    expect(reason_for([](Scene& scene) { scene.slice.samples = 255; }), "render.slice.samples");
    expect(reason_for([](Scene& scene) {
               TreeSettings tree;
               tree.factors = {8, 8};
               scene.slice.tree = tree;
           }),
           "render.slice.tree");
    expect(reason_for([](Scene& scene) { scene.slice.filter = Filter::hardware; }),
           "render.slice.filter");
    // Slabs that are asked for are drawn as they are.
    Scene slabs = picture_scene();
    slabs.slice.samples = 32;
    slabs.slice.classification = Classification::post;
    EXPECT_TRUE(choose(slabs, scan.field).scene.lighting);
}

TEST(AutomaticLight, IsNotChosenUnlessTheSceneLeavesItOpen) {
    const Scan scan;
    Scene scene = picture_scene();
    scene.lighting.reset();
    EXPECT_FALSE(choose(scene, scan.field).scene.lighting);
    Lighting dim;
    dim.diffuse = .5;
    scene.lighting = dim;
    const Scene given = choose(scene, scan.field).scene;
    EXPECT_EQ(given_lighting(given.lighting)->diffuse, .5);
}

}  // namespace
}  // namespace lamina
