// SPDX-License-Identifier: Apache-2.0
#include "scene_files/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "scene/camera.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

constexpr double degree = std::numbers::pi / 180;

Camera camera_at(double azimuth, double elevation, double distance, const glm::dvec3& center = {}) {
    Camera camera;
    camera.center = center;
    camera.eye =
        center + distance * glm::dvec3(std::sin(azimuth * degree) * std::cos(elevation * degree),
                                       std::sin(elevation * degree),
                                       std::cos(azimuth * degree) * std::cos(elevation * degree));
    return camera;
}

bool same(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.center == b.center && a.up == b.up && a.fov_y == b.fov_y &&
           a.height == b.height && a.projection == b.projection;
}

std::vector<Keyframe> random_keyframes(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<Keyframe> keyframes;
    double time = -3;
    for (int i = 0; i < 6; ++i) {
        Keyframe keyframe{time, camera_at(360 * share(random), 140 * share(random) - 70,
                                          std::exp(3 * share(random)),
                                          {share(random), share(random), share(random)})};
        keyframe.camera.fov_y = 10 + 90 * share(random);
        keyframes.push_back(keyframe);
        time += .2 + share(random);
    }
    return keyframes;
}

// Largest differences of direction, place, and logarithms between two cameras.
double difference_of(const Camera& a, const Camera& b) {
    const View x(a, 1, 1), y(b, 1, 1);
    const double size = std::log(glm::length(a.eye - a.center) / glm::length(b.eye - b.center));
    return std::max({glm::length(x.forward - y.forward), glm::length(x.up - y.up),
                     glm::length(a.center - b.center), std::abs(size),
                     std::abs(std::log(a.fov_y / b.fov_y))});
}

TEST(CameraPath, PassesThroughEachKeyframeExactly) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const std::vector<Keyframe> keyframes = random_keyframes(seed);
        const CameraPath path(keyframes);
        for (const Keyframe& keyframe : keyframes) {
            const double time = keyframe.time - keyframes.front().time;
            EXPECT_TRUE(same(path.at(time), keyframe.camera));
            // And the curve beside it tends to it: in 1e-6 s no camera here changes by more than
            // 1e-4, at rates below 100 a second.
            EXPECT_LT(difference_of(path.at(time + 1e-6), keyframe.camera), 1e-4);
            EXPECT_LT(difference_of(path.at(time - 1e-6), keyframe.camera), 1e-4);
        }
        EXPECT_TRUE(same(path.at(-1), keyframes.front().camera));
        EXPECT_TRUE(same(path.at(1e3), keyframes.back().camera));
    }
}

// The change from one moment to the next changes, from moment to moment, by the square of the step
// if the curve has a continuous derivative, but by the step itself at a kink.
TEST(CameraPath, HasNoJumpsAndNoKinks) {
    constexpr double step = 1e-4;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const CameraPath path(random_keyframes(seed));
        const auto change = [&](double time, const glm::dvec3& (*of)(const Camera&)) {
            return of(path.at(time + step)) - of(path.at(time));
        };
        const auto eye = [](const Camera& c) -> const glm::dvec3& { return c.eye; };
        for (double time = step; time < path.seconds() - 2 * step; time += 5e-3) {
            const double bend = glm::length(change(time + step, eye) - change(time, eye));
            EXPECT_LT(bend, 2e4 * step * step) << seed << " " << time;
        }
        for (const Keyframe& keyframe : path.keyframes()) {
            const double time = keyframe.time - path.keyframes().front().time;
            if (time == 0 || time > path.seconds() - step) continue;
            const double bend = glm::length(change(time, eye) - change(time - step, eye));
            EXPECT_LT(bend, 2e4 * step * step) << seed << " at a keyframe";
        }
    }
}

// Equal turns in equal times are one steady turn, at an unchanged elevation, with up upright.
TEST(CameraPath, EqualTurnsAreASteadyTurn) {
    std::vector<Keyframe> keyframes;
    for (int i = 0; i <= 4; ++i) keyframes.push_back({2. * i, camera_at(90 * i, 30, 5)});
    const CameraPath path(keyframes);
    for (double time = 0; time <= 8; time += .125) {
        const Camera camera = path.at(time), expected = camera_at(45 * time, 30, 5);
        EXPECT_LT(glm::length(camera.eye - expected.eye), 1e-12) << time;
        EXPECT_LT(glm::length(View(camera, 1, 1).up - View(expected, 1, 1).up), 1e-12);
    }
}

// Zooms by a factor take equal times for equal factors.
TEST(CameraPath, DistanceAndFieldOfViewChangeByFactors) {
    Camera far = camera_at(0, 0, 16), near = camera_at(0, 0, 1);
    far.fov_y = 64;
    near.fov_y = 4;
    const Camera middle = CameraPath({{0, far}, {4, near}}).at(2);
    EXPECT_NEAR(middle.eye.z, 4, 1e-12);
    EXPECT_NEAR(middle.fov_y, 16, 1e-12);
    far.projection = near.projection = Projection::orthographic;
    far.height = 100;
    near.height = 1;
    EXPECT_NEAR(CameraPath({{0, far}, {4, near}}).at(2).height, 10, 1e-12);
}

TEST(CameraPath, ARestIsARest) {
    const CameraPath path({{0, camera_at(0, 0, 4)},
                           {1, camera_at(90, 20, 3)},
                           {3, camera_at(90, 20, 3)},
                           {4, camera_at(200, -10, 5)}});
    for (double time = 1; time <= 3; time += .1)
        EXPECT_TRUE(same(path.at(time), camera_at(90, 20, 3))) << time;
}

// There and back by nearly half a turn: of the two ways round, each is the shorter one, and the
// curve does not jump to the other.
TEST(CameraPath, GoesBackTheWayItCame) {
    const CameraPath path(
        {{0, camera_at(0, 0, 4)}, {1, camera_at(170, 0, 4)}, {2, camera_at(0, 0, 4)}});
    for (double time = 0; time < 2; time += .01) {
        const Camera camera = path.at(time);
        EXPECT_GT(camera.eye.x, -1e-9) << time;
        EXPECT_LT(glm::length(camera.eye - path.at(time + .01).eye), .3) << time;
    }
}

// The path of a scene that is turned as a whole is the path, turned as a whole.
TEST(CameraPath, DoesNotDependOnTheAxesOfTheWorld) {
    const glm::dquat turn = glm::normalize(glm::dquat(.3, -.5, .7, .2));
    std::vector<Keyframe> keyframes = random_keyframes(7), turned = keyframes;
    for (Keyframe& keyframe : turned) {
        for (glm::dvec3* v : {&keyframe.camera.eye, &keyframe.camera.center, &keyframe.camera.up})
            *v = turn * *v;
    }
    const CameraPath path(keyframes), other(turned);
    for (double time = 0; time < path.seconds(); time += .05)
        EXPECT_LT(glm::length(turn * path.at(time).eye - other.at(time).eye), 1e-9) << time;
}

TEST(CameraPath, AFilmHasBothEnds) {
    const CameraPath path(
        {{0, camera_at(0, 0, 4)}, {1, camera_at(90, 0, 4)}, {2.02, camera_at(0, 0, 4)}});
    const std::vector<Camera> cameras = path.cameras(10);
    ASSERT_EQ(cameras.size(), 21u);
    EXPECT_TRUE(same(cameras[0], path.keyframes()[0].camera));
    EXPECT_TRUE(same(cameras[10], path.keyframes()[1].camera));
    EXPECT_TRUE(same(cameras[20], path.keyframes()[2].camera));
}

json keyframe(double x) {
    return {{"camera", {{"eye", {x, 0, 4}}, {"center", {0, 0, 0}}}}};
}

CameraPath read(const json& document) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "p.json", document.dump());
    return read_camera_path(folder / "p.json");
}

TEST(CameraPathFile, KeyframesWithoutTimesAreASecondApart) {
    const CameraPath path = read({{"keyframes", {keyframe(0), keyframe(1), keyframe(2)}}});
    EXPECT_EQ(path.seconds(), 2);
    EXPECT_EQ(path.at(1).eye, glm::dvec3(1, 0, 4));
}

TEST(CameraPathFile, MistakesNameFileKeyFoundAndExpected) {
    const auto expect_mistake = [](const json& document, std::initializer_list<std::string> parts) {
        expect_error([&] { read(document); }, {"p.json"});
        expect_error([&] { read(document); }, parts);
    };
    const auto with = [](const char* pointer, const json& value) {
        json path{{"keyframes", {keyframe(0), keyframe(1)}}};
        path["keyframes"][0]["time"] = 1;
        path["keyframes"][1]["time"] = 2;
        path[json::json_pointer(pointer)] = value;
        return path;
    };
    expect_mistake(json::array(), {"an object"});
    expect_mistake(json::object(), {"keyframes: is missing", "a list"});
    expect_mistake({{"keyframes", {keyframe(0)}}}, {"keyframes: found 1", "2 to"});
    expect_mistake(with("/frames", 3), {"frames: unknown key"});
    expect_mistake(with("/keyframes/1", 3), {"keyframes.1", "3", "object"});
    expect_mistake(with("/keyframes/1/camera", "auto"), {"keyframes.1.camera: found \"auto\""});
    expect_mistake(with("/keyframes/1/camera/eye", 3), {"keyframes.1.camera.eye: found 3"});
    expect_mistake(with("/keyframes/1/camera/eyes", 3), {"keyframes.1.camera.eyes: unknown key"});
    expect_mistake(with("/keyframes/1/camera/eye", {0, 0, 0}),
                   {"keyframes.1.camera", "same point"});
    expect_mistake(with("/keyframes/1/camera/up", {1, 0, 4}), {"keyframes.1.camera", "parallel"});
    expect_mistake(with("/keyframes/1/camera/fov_y", 180), {"keyframes.1.camera.fov_y: found 180"});
    expect_mistake(with("/keyframes/1/time", "2 s"), {"keyframes.1.time: found \"2 s\""});
    expect_mistake(with("/keyframes/1/time", 1), {"keyframes.1.time: found 1", "more than"});
    expect_mistake(with("/keyframes/1/time", 1e9), {"keyframes.1.time: found", "at most 1e6"});
    expect_mistake(with("/keyframes/1/tme", 1), {"keyframes.1.tme: unknown key"});
    expect_mistake(with("/keyframes/2", keyframe(3)), {"keyframes.2.time: is missing", "seconds"});
    json orthographic = keyframe(3);
    orthographic["time"] = 3;
    orthographic["camera"].update({{"projection", "orthographic"}, {"height", 2}});
    expect_mistake(with("/keyframes/2", orthographic),
                   {"keyframes.2.camera.projection: found orthographic", "expected perspective"});
}

}  // namespace
}  // namespace lamina
