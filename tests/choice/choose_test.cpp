// SPDX-License-Identifier: Apache-2.0
#include "choice/choose.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <random>

#include "choice/field.h"
#include "choice/open_scene.h"
#include "image/coded_image.h"
#include "scene/camera.h"
#include "scene_files/scene_reader.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/split_box.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using test::open_scene;

// Values of a ball in air, growing inwards.
double ball(const glm::dvec3& p, double edge) {
    const glm::dvec3 arm = p - glm::dvec3(edge / 2);
    return std::max(0., 1 - 2.5 * std::sqrt(arm.x * arm.x + arm.y * arm.y + arm.z * arm.z) / edge);
}

struct Ball {
    Volume volume = test::volume_of<std::uint8_t>(test::grid_of({40, 40, 40}, Centering::node),
                                                  [](double x, double y, double z) {
                                                      return std::floor(250 * ball({x, y, z}, 39));
                                                  });
    MinMaxBricks bricks = measure_bricks(volume);
    VolumeField field{volume, bricks};
};

// Expects an opacity of 0.9 for the median of the rays whose optical depth exceeds 1/500 of the
// largest one. Depths are sums of float32 numbers, about 4 for each of 70 voxels along the view:
// 300 roundings of 6e-8 are 2e-5.
void expect_median_opacity(const Scene& scene, const Field& field, double opacity = .9) {
    std::vector<double> depths = field.optical_depths(scene);
    const double least = *std::ranges::max_element(depths) / 500;
    std::erase_if(depths, [&](double depth) { return !(depth > least); });
    ASSERT_GT(depths.size(), 100u);
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::ranges::nth_element(depths, middle);
    const double expected = -std::log1p(-opacity);
    EXPECT_NEAR(*middle, expected, 2e-5 * expected);
}

Scene chosen_of(const Scene& scene, const Field& field, const Adjustments& adjustments = {}) {
    return choose(scene, field, adjustments).scene;
}

TEST(Choose, ChoosesTransferFunctionAndCameraAndSaysBoth) {
    const Ball one;
    const auto [scene, reasons] = choose(open_scene(), one.field);
    EXPECT_FALSE(scene.transfer_function.is_automatic() || scene.camera.is_automatic());
    EXPECT_EQ(reasons.size(), 2u);
}

// Labels have no surfaces of known slope: their extinctions follow from rays in a square picture of
// 512 pixels, whatever the picture that is drawn.
TEST(Choose, TheMedianRayThroughLabelsIsOpaque) {
    const Volume volume = test::volume_of<std::uint8_t>(
        test::grid_of({40, 40, 40}, Centering::node), [](double i, double j, double k) {
            const double value = ball({i, j, k}, 39);
            return value > .5 ? 2 : value > .1 ? 1 : 0;
        });
    const MinMaxBricks bricks = measure_bricks(volume);
    const VolumeField field(volume, bricks);
    Scene scene = open_scene();
    const Scene small = chosen_of(scene, field);
    scene.width = scene.height = 512;
    const Scene square = chosen_of(scene, field);
    expect_median_opacity(square, field, .999);
    EXPECT_EQ(small.transfer_function, square.transfer_function);
}

// A picture does not depend on the unit of length, even if float32 depths in that unit would
// overflow or vanish.
TEST(Choose, TheUnitOfLengthDoesNotMatter) {
    const auto extinction = [](double spacing) {
        Grid grid = test::grid_of({40, 40, 40}, Centering::node);
        for (glm::dvec3& step : grid.step) step *= spacing;
        const Volume volume = test::volume_of<float>(grid, [](double x, double y, double z) {
            return ball({x, y, z}, 39);
        });
        const MinMaxBricks bricks = measure_bricks(volume);
        const Scene scene = chosen_of(open_scene(), VolumeField(volume, bricks));
        return spacing * scene.transfer_function->max_extinction(0, 1);
    };
    // Depths are sums of some 100 numbers of float32.
    for (const double spacing : {1e-90, 1e-40, 1e40, 1e90})
        EXPECT_NEAR(extinction(spacing) / extinction(1), 1, 2e-5) << spacing;
}

TEST(Choose, SetsOnlyWhatTheSceneLeavesOpen) {
    const Ball one;
    Scene scene = open_scene();
    scene.camera = Camera{};
    scene.camera->eye = {100, 20, 30};
    EXPECT_EQ(chosen_of(scene, one.field).camera->eye, scene.camera->eye);
    scene = open_scene();
    scene.transfer_function = Scene().transfer_function;
    const auto [chosen, reasons] = choose(scene, one.field);
    EXPECT_EQ(chosen.transfer_function, scene.transfer_function);
    EXPECT_EQ(reasons.size(), 1u);  // the reason for the camera
}

TEST(Choose, DoesNotDependOnThreads) {
    const Ball one;
    const auto text = [&] { return scene_json(chosen_of(open_scene(), one.field)).dump(); };
    const std::string with_all = text();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(text(), with_all);
}

TEST(Choose, ChosenScenesAreReadBackUnchanged) {
    const Ball one;
    Scene scene = open_scene();
    scene.volume = VolumeFile{"ball.nrrd"};
    scene = chosen_of(scene, one.field);
    const Scene read = read_scene(nlohmann::json(scene_json(scene)), "/scene.json");
    EXPECT_EQ(read.transfer_function, scene.transfer_function);
    EXPECT_EQ(read.camera->eye, scene.camera->eye);
    EXPECT_EQ(read.camera->up, scene.camera->up);
    EXPECT_FALSE(read.transfer_function.is_automatic() || read.camera.is_automatic());
}

TEST(Choose, AppliesTheGivenDensityTurnAndZoom) {
    const Ball one;
    const Scene plain = chosen_of(open_scene(), one.field);
    const Scene dense = chosen_of(open_scene(), one.field, {.density = 2});
    EXPECT_EQ(dense.transfer_function, plain.transfer_function->attenuated(2));
    // A full turn is the same as no turn.
    const Scene around = chosen_of(open_scene(), one.field, {.turn = {360, 0}});
    EXPECT_LT(glm::distance(around.camera->eye, plain.camera->eye), 1e-10);
    EXPECT_LT(chosen_of(open_scene(), one.field, {.zoom = 3}).camera->fov_y,
              plain.camera->fov_y / 2);
}

TEST(Choose, RefusesDataWithoutFiniteValues) {
    const Volume volume = test::volume_of(test::grid_of({9, 9, 9}, Centering::node),
                                          [](double, double, double) { return NAN; });
    const MinMaxBricks bricks = measure_bricks(volume);
    Scene scene = open_scene();
    scene.volume = VolumeFile{"none.nrrd"};
    expect_error([&] { chosen_of(scene, VolumeField(volume, bricks)); },
                 {"none.nrrd: all values are NaN or infinite, expected numbers"});
}

// One vertex of 2197 is .0005 of the mesh; the tets around it do not count for the field. A slope
// is added so that there are more values than the few of labels, among which no marker is sought.
TEST(Choose, AVertexValueFarFromAllOthersIsPadding) {
    const auto sloping_ball = [](const glm::dvec3& p) {
        return ball(p, 12) + 1e-3 * (p.x + .1 * p.y + .01 * p.z);
    };
    MeshData data = test::kuhn_box({12, 12, 12}, sloping_ball);
    const SceneMesh plain = scene_mesh(Scene(), MeshData(data));
    data.point_scalars.front().values[700] = -9999;
    const SceneMesh marked = scene_mesh(Scene(), std::move(data));
    const test::HeardWarnings heard;
    const Scene chosen = chosen_of(open_scene(), MeshField(marked));
    EXPECT_NE(heard.all().find("-9999, "), std::string::npos) << heard.all();
    EXPECT_TRUE(chosen.transfer_function->transparent(-9999, -1));
    // Only 24 of 10,368 tets count otherwise, so the values that show are nearly the same as
    // without the marker.
    const Scene without = chosen_of(open_scene(), MeshField(plain));
    const auto last = [](const Scene& scene) {
        return scene.transfer_function->knots().back().value;
    };
    EXPECT_NEAR(last(chosen), last(without), .02);
}

TEST(Choose, ACameraThatIsTurnedAllAroundFitsAllViews) {
    const Ball one;
    const Scene plain = chosen_of(open_scene(), one.field);
    const Scene around = chosen_of(open_scene(), one.field, {.all_around = true});
    // Seen from all sides the visible bricks reach farther out than from the front, so the camera
    // is farther away.
    EXPECT_GT(glm::distance(around.camera->eye, around.camera->center),
              glm::distance(plain.camera->eye, plain.camera->center));
}

// Messages have enough digits to distinguish values and positions.
TEST(Choose, MessagesDistinguishNumbersFarFromZero) {
    Grid grid = test::grid_of({40, 40, 40}, Centering::node);
    grid.origin = {5e6, 0, 0};
    const Volume volume = test::volume_of<float>(grid, [](double x, double y, double z) {
        return 1e6 + 4 * ball({x, y, z}, 39);
    });
    const MinMaxBricks bricks = measure_bricks(volume);
    const auto reasons = choose(open_scene(), VolumeField(volume, bricks)).reasons;
    EXPECT_NE(reasons[0].find("from 1000000 to 1000000"), std::string::npos) << reasons[0];
    EXPECT_NE(reasons[0].find("up to 1000003."), std::string::npos) << reasons[0];
    EXPECT_NE(reasons[1].find("to (50000"), std::string::npos) << reasons[1];
}

// It is .01 of the range of values, divided by the smallest spacing among axes with more than one
// sample.
TEST(Choose, TheSmallestGradientIsAShareOfTheRange) {
    Grid grid = test::grid_of({5, 4, 1}, Centering::cell);
    grid.step = {glm::dvec3(0, 3, 0), glm::dvec3(0, 0, -2), glm::dvec3(.5, 0, 0)};
    const Volume volume =
        test::volume_of(grid, [](double x, double y, double) { return 10 * x + y - 7; });
    const MinMaxBricks bricks = measure_bricks(volume);
    Scene scene;
    scene.lighting = Lighting{};
    scene.camera->eye = {1, 2, 3};
    const auto [chosen, reasons] = choose(scene, VolumeField(volume, bricks));
    EXPECT_DOUBLE_EQ(*(*chosen.lighting)->smallest_gradient, .01 * 43 / 2);
    EXPECT_EQ(reasons.size(), 1u);
    EXPECT_EQ(chosen.camera->eye, scene.camera->eye);
    EXPECT_FALSE(leaves_something_open(chosen));
    EXPECT_TRUE(leaves_something_open(scene));
    EXPECT_EQ(chosen_of(chosen, VolumeField(volume, bricks)).lighting, chosen.lighting);
}

// The data are a disc of values from 0 to 1000 in a square of -3024, the padding.
TEST(Choose, PaddingDoesNotCountForTheSmallestGradient) {
    const Volume volume = test::volume_of<std::int16_t>(
        test::grid_of({21, 21, 3}, Centering::node), [](double x, double y, double) {
            return std::hypot(x - 10, y - 10) > 10 ? -3024 : 50 * x + y - 10;
        });
    const MinMaxBricks bricks = measure_bricks(volume);
    Scene scene;
    scene.lighting = Lighting{};
    EXPECT_DOUBLE_EQ(*(*chosen_of(scene, VolumeField(volume, bricks)).lighting)->smallest_gradient,
                     .01 * 1000);
}

// The mesh is a cube of edge 1 cut into six tets. The edges of each tet are three edges of the
// cube, two diagonals of its faces and the diagonal of the cube.
TEST(Choose, TheSmallestGradientOfAMeshIsPerItsMeanEdge) {
    Scene scene;
    scene.lighting = Lighting{};
    const SceneMesh mesh =
        scene_mesh(scene, test::kuhn_box({2, 3, 4}, [](const glm::dvec3& p) { return 5 * p.x; }));
    const double mean = (3 + 2 * std::sqrt(2.) + std::sqrt(3.)) / 6;
    EXPECT_NEAR(*(*chosen_of(scene, MeshField(mesh)).lighting)->smallest_gradient, .01 * 10 / mean,
                1e-14);
}

TEST(Choose, DataOfOneValueHaveASmallestGradientOfOne) {
    for (const double value : {4.5, double{NAN}}) {
        const Volume volume = test::volume_of(test::grid_of({3, 3, 3}, Centering::node),
                                              [&](double, double, double) { return value; });
        const MinMaxBricks bricks = measure_bricks(volume);
        Scene scene;
        scene.lighting = Lighting{};
        EXPECT_EQ((*chosen_of(scene, VolumeField(volume, bricks)).lighting)->smallest_gradient, 1);
    }
}

// A slice of 40 by 30 samples with a border of zeros.
TEST(Choose, OneSliceShowsAllOfItAsAPicture) {
    for (const std::size_t thin : {0u, 1u, 2u}) {
        std::array<std::int64_t, 3> size{40, 30, 30};
        if (thin == 0) size = {1, 40, 30};
        size[thin] = 1;
        Grid grid = test::grid_of(size, Centering::cell);
        for (glm::dvec3& step : grid.step) step *= .25;
        const auto is_border = [&](std::size_t axis, double i) {
            return axis != thin && (i < 2 || i > static_cast<double>(size[axis]) - 3);
        };
        const Volume volume =
            test::volume_of<std::uint8_t>(grid, [&](double x, double y, double z) {
                const bool border = is_border(0, x) || is_border(1, y) || is_border(2, z);
                return border ? 0 : 100 - 3 * std::abs(x + y + z - 33);
            });
        const MinMaxBricks bricks = measure_bricks(volume);
        const VolumeField field(volume, bricks);
        Scene open = open_scene();
        open.lighting = automatic;
        const auto [scene, reasons] = choose(open, field);
        EXPECT_EQ(reasons.back(), "lighting: not lit: one slice has no surface");
        EXPECT_NE(reasons[0].find("one slice shows as a picture, in greys from 0 to 100"),
                  std::string::npos);
        EXPECT_TRUE(scene.clip.keeps_all());
        EXPECT_FALSE(scene.lighting);
        // Parallel to the slice's normal, through its middle.
        const glm::dvec3 toward = glm::normalize(scene.camera->eye - scene.camera->center);
        EXPECT_NEAR(std::abs(toward[static_cast<int>(thin)]), 1, 1e-14);
        double before = -1;
        for (const double value : {0., 20., 50., 100.}) {
            const OpticalProperties shown = scene.transfer_function->at(value);
            EXPECT_NEAR(-std::expm1(-.25 * shown.extinction), .999, 1e-12);
            EXPECT_GT(shown.color.x, before);
            EXPECT_EQ(shown.color, glm::dvec3(shown.color.x));
            before = shown.color.x;
        }
        EXPECT_NEAR(scene.transfer_function->at(50).color.x, linear_from_srgb(.95 / 2), .002);
        Adjustments wished;
        wished.transfer.range = ValueRange{10, 60};
        const Scene within = chosen_of(open, field, wished);
        EXPECT_EQ(within.transfer_function->at(9.9).extinction, 0);
        EXPECT_GT(within.transfer_function->at(10.1).extinction, 0);
        EXPECT_NEAR(within.transfer_function->at(60).color.x, linear_from_srgb(.95), 1e-12);
        wished.side = ViewSide::iso;  // a side that is asked for is that of the data
        const Scene oblique = chosen_of(open, field, wished);
        const glm::dvec3 aside = glm::normalize(oblique.camera->eye - oblique.camera->center);
        EXPECT_LT(std::abs(aside[static_cast<int>(thin)]), .9);
    }
}

// A label that nobody hid must not vanish without a word on how it shows.
TEST(Choose, AMarginOfLabelsIsSaid) {
    Grid grid = test::grid_of({9, 9, 9}, Centering::cell);
    grid.lookup = VolumeLookup::nearest;
    const auto is_outer = [](double i) { return i == 0 || i == 8; };
    const Volume volume = test::volume_of<std::uint8_t>(grid, [&](double x, double y, double z) {
        return is_outer(x) || is_outer(y) || is_outer(z) ? 5 : x > 4 ? 3 : y > 4 ? 1 : 0;
    });
    const MinMaxBricks bricks = measure_bricks(volume);
    const VolumeField field(volume, bricks);
    test::HeardWarnings heard;
    EXPECT_EQ(chosen_of(open_scene(), field).transfer_function->at(5).extinction, 0);
    heard.expect_said(
        "label 5 has no name and covers all outer faces, so it is taken for a margin and not "
        "shown: --range 0,5 shows it, too");
    Adjustments wished;
    wished.transfer.range = ValueRange{0, 5};
    const Scene wide = chosen_of(open_scene(), field, wished);
    EXPECT_GT(wide.transfer_function->at(5).extinction, 0);
    EXPECT_GT(wide.transfer_function->at(3).extinction, 0);
    EXPECT_EQ(heard.all(), "");
}

// Degenerate data of every kind get a transfer function and a camera of finite numbers.
TEST(Choose, DegenerateDataGetFiniteCamerasAndFunctions) {
    const auto check = [](const Volume& volume, const std::string& name) {
        const MinMaxBricks bricks = measure_bricks(volume);
        const Scene scene = chosen_of(open_scene(), VolumeField(volume, bricks));
        const View view(*scene.camera, scene.width, scene.height);
        for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(std::isfinite(view.eye[axis])) << name;
        EXPECT_TRUE(std::isfinite(scene.transfer_function->max_extinction(-1e9, 1e9))) << name;
    };
    const auto one = test::grid_of({1, 1, 1}, Centering::cell);
    const auto flat = test::grid_of({9, 1, 7}, Centering::cell);
    const auto small = test::grid_of({3, 2, 2}, Centering::node);
    const auto cube = test::grid_of({9, 9, 9}, Centering::node);
    const auto x = [](double i, double, double) { return i; };
    check(test::volume_of(one, x), "one sample");
    check(test::volume_of(flat, x), "a sheet");
    check(test::volume_of(small, x), "a few samples");
    check(test::volume_of(cube, [](double, double, double) { return 4.5; }), "constant");
    check(test::volume_of(cube, [](double i, double, double) { return i < 1 ? NAN : i; }),
          "some that are none");
    check(test::volume_of<std::uint8_t>(
              cube, [](double i, double j, double) { return i > 3 && j > 3 ? 2
                                                            : i > 6        ? 1
                                                                           : 0; }),
          "labels");
    check(test::volume_of(cube,
                          [](double i, double j, double k) { return i + j + k == 9 ? 1e30 : 0; }),
          "huge");
    check(
        test::volume_of(cube, [](double i, double j, double k) { return i + j + k == 24 ? 1 : 0; }),
        "a single voxel");
}

// A margin of another label would hide what is inside of it.
TEST(Choose, LeavesOutAMarginAroundLabels) {
    Grid grid = test::grid_of({24, 24, 24}, Centering::node);
    grid.lookup = VolumeLookup::nearest;
    const auto chosen = [&](double margin, double inside) {
        const Volume volume =
            test::volume_of<std::uint8_t>(grid, [&](double i, double j, double k) {
                const double least = std::min({i, j, k}), most = std::max({i, j, k});
                return least < 2 || most > 21 ? margin : least > 6 && most < 15 ? 3 : inside;
            });
        const MinMaxBricks bricks = measure_bricks(volume);
        return choose(open_scene(), VolumeField(volume, bricks), {});
    };
    const auto shows = [](const Choices& choices, double label) {
        return choices.scene.transfer_function->at(label).extinction > 0;
    };
    const Choices with_zero = chosen(7, 0);
    EXPECT_FALSE(shows(with_zero, 0));
    EXPECT_FALSE(shows(with_zero, 7));
    EXPECT_TRUE(shows(with_zero, 3));
    EXPECT_NE(chosen_text(with_zero.reasons).find("and so is 7, which lies around the others"),
              std::string::npos)
        << chosen_text(with_zero.reasons);
    const Choices without = chosen(7, 1);  // 1 is more frequent
    EXPECT_FALSE(shows(without, 7));
    EXPECT_TRUE(shows(without, 1));
    EXPECT_TRUE(shows(chosen(7, 7), 3));
    const Choices nothing_else = chosen(3, 0);
    EXPECT_TRUE(shows(nothing_else, 3));
}

// A file names what is wanted, so a named label around the others shows, and so does one in a range
// that asks for it.
TEST(Choose, ShowsALabelAroundTheOthersThatIsNamedOrAskedFor) {
    Grid grid = test::grid_of({24, 24, 24}, Centering::node);
    grid.lookup = VolumeLookup::nearest;
    const auto shows_around = [&](const char* name, std::optional<ValueRange> range) {
        const Volume volume =
            test::volume_of<std::uint8_t>(
                grid,
                [&](double i, double j, double k) {
                    const double least = std::min({i, j, k}), most = std::max({i, j, k});
                    return least < 2 || most > 21 ? 1 : least > 6 && most < 15 ? 3 : 2;
                })
                .labelled(std::make_shared<const VolumeLabels>(
                    VolumeLabels{false, {{1, "1", name}, {2, "2", "body"}, {3, "3", "rod"}}}));
        const MinMaxBricks bricks = measure_bricks(volume);
        const Choices found =
            choose(open_scene(), VolumeField(volume, bricks), {.transfer = {.range = range}});
        return found.scene.transfer_function->at(1).extinction > 0;
    };
    EXPECT_FALSE(shows_around("", {}));
    EXPECT_TRUE(shows_around("skin", {}));  // the body, which is more frequent, is transparent
    EXPECT_TRUE(shows_around("", ValueRange{.5, 1.5}));
}

// Such as rock: the matrix fills the box and its corners, and pores reach the faces, too.
TEST(Choose, TakesNoLabelForAMarginThatOthersInterruptAtTheFaces) {
    Grid grid = test::grid_of({24, 24, 24}, Centering::node);
    grid.lookup = VolumeLookup::nearest;
    const auto chosen = [&](std::size_t axis, double end) {
        const Volume volume =
            test::volume_of<std::uint8_t>(grid, [&](double i, double j, double k) {
                const std::array<double, 3> at{i, j, k};
                if (at[axis] == end && at[(axis + 1) % 3] == 9 && at[(axis + 2) % 3] == 13)
                    return 0;
                const double least = std::min({i, j, k}), most = std::max({i, j, k});
                return least > 6 && most < 15 ? 2 : least > 15 && most < 20 ? 0 : 1;
            });
        const MinMaxBricks bricks = measure_bricks(volume);
        return choose(open_scene(), VolumeField(volume, bricks), {});
    };
    const auto shows_matrix = [](const Choices& choices) {
        EXPECT_GT(choices.scene.transfer_function->at(2).extinction, 0);
        return choices.scene.transfer_function->at(1).extinction > 0;
    };
    EXPECT_FALSE(shows_matrix(chosen(0, 12)));  // a pore inside
    for (const std::size_t axis : {0, 1, 2}) {
        for (const double end : {0, 23}) {
            const Choices found = chosen(axis, end);
            EXPECT_TRUE(shows_matrix(found)) << axis << ", " << end;
            EXPECT_EQ(chosen_text(found.reasons).find("lies around"), std::string::npos);
        }
    }
}

// Noise of few values is a field, and pieces of few values are labels.
TEST(Choose, TellsFewValuesOfNoiseFromLabels) {
    const auto reason_of = [](const auto& value) {
        const Volume volume =
            test::volume_of<std::uint8_t>(test::grid_of({24, 24, 24}, Centering::node), value);
        const MinMaxBricks bricks = measure_bricks(volume);
        return chosen_text(choose(open_scene(), VolumeField(volume, bricks), {}).reasons);
    };
    std::mt19937 random(7);
    const auto noise =
        reason_of([&](double, double, double) { return static_cast<double>(random() % 20); });
    const auto pieces = reason_of(
        [](double i, double j, double k) { return static_cast<int>(i / 5 + j / 7) % 3 + (k > 9); });
    EXPECT_EQ(noise.find("look like labels"), noise.npos) << noise;
    EXPECT_NE(pieces.find("4 whole numbers look like labels"), pieces.npos) << pieces;
    // A label around a body that touches it everywhere is no border, and is the background although
    // the body has more samples, 20^3 - 8^3 of 24^3: else the body would be left out.
    const auto body = reason_of([](double i, double j, double k) {
        const double least = std::min({i, j, k}), most = std::max({i, j, k});
        return least < 2 || most > 21 ? 7 : least > 6 && most < 15 ? 3 : 1;
    });
    EXPECT_EQ(body.find("clip"), body.npos) << body;
    EXPECT_NE(body.find("3 whole numbers look like labels: 7, 42.1 % of the field, is transparent"),
              body.npos)
        << body;
}

}  // namespace
}  // namespace lamina
