// SPDX-License-Identifier: Apache-2.0
// Opacity that is linear between points: compares slicing, projected tets and the tracer with an
// integration of -log1p(-opacity) along rays, without the pieces that they use.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "reference/scene_tracer.h"
#include "render/scene_renderer.h"
#include "support/split_box.h"
#include "support/volume_of.h"
#include "tiles/cpu_capabilities.h"
#include "volume/generate.h"

namespace lamina {
namespace {

struct Case {
    const char* name;
    std::vector<OpacityKnot> points;
    double unit_length;
};

// Transfer functions for the field below, whose values go from 0 to 384.
const Case cases[] = {
    {"ramp", {{0, {0, .2, 1}, 0}, {384, {1, .5, 0}, 1}}, 1},
    {"falling ramp, unit length", {{-20, {1, 1, 1}, 1}, {380, {.2, .5, 0}, 0}}, .4},
    {"tent", {{100, {0, .2, 1}, 0}, {190, {1, 1, 0}, 1}, {300, {1, 0, .3}, 0}}, .7},
    {"half a ramp", {{0, {.3, .9, 1}, 0}, {500, {1, .5, .1}, .6}}, .25},
    {"plateau of one",
     {{50, {1, .2, 1}, 0}, {90, {1, 1, 0}, 1}, {95, {0, 1, 1}, 1}, {300, {1, 0, .3}, 0}},
     2},
    {"steps",
     {{30, {1, 0, 0}, 0}, {30, {1, 0, 0}, .3}, {200, {0, 1, 1}, .9}, {200, {1, 1, 1}, .1}},
     1}};

constexpr int width = 20, height = 16;

double field(const glm::dvec3& place) {
    return 96 * place.x + 32 * place.y + 64 * place.z;
}

// Returns a camera that looks through the box [0, 2]^3. Along its rays the field changes by 85 per
// unit of length, so no ray stays where the opacity is nearly 1.
Camera camera() {
    Camera result;
    result.projection = Projection::orthographic;
    result.center = glm::dvec3(1);
    result.eye = glm::dvec3(-2.5, -1.2, -1);
    result.up = {.1, 1, 0};
    result.height = 3.7;
    return result;
}

// A ray's part inside the box: entry point and length; the length is 0 if the ray misses the box.
struct Chord {
    glm::dvec3 entry{0}, direction{0};
    double length = 0;
};

Chord chord_of(int column, int row) {
    const Camera view = camera();
    Chord chord;
    chord.direction = glm::normalize(view.center - view.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(chord.direction, view.up));
    const glm::dvec3 up = glm::cross(right, chord.direction);
    const double pixel = view.height / height;
    const glm::dvec3 start = view.eye + (column + .5 - width / 2.) * pixel * right +
                             (height / 2. - row - .5) * pixel * up;
    double near = 0, far = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = -start[axis] / chord.direction[axis];
        const double b = (2 - start[axis]) / chord.direction[axis];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    chord.entry = start + near * chord.direction;
    chord.length = std::max(far - near, 0.);
    return chord;
}

// Integrates a function of opacity along a chord, on which the field is linear.
class Integration {
  public:
    explicit Integration(const Case& given) : given_(given) {}

    std::array<double, 4> along(const Chord& chord) const {
        std::array<double, 4> rgba{};
        if (chord.length == 0) return rgba;
        const double from = field(chord.entry);
        const double to = field(chord.entry + chord.length * chord.direction);
        std::vector<double> cuts{from, to};
        for (const OpacityKnot& point : given_.points) {
            if (point.value > std::min(from, to) && point.value < std::max(from, to))
                cuts.push_back(point.value);
        }
        std::ranges::sort(cuts);
        if (to < from) std::ranges::reverse(cuts);
        double depth = 0;
        for (std::size_t i = 1; i < cuts.size(); ++i) {
            const double share = (cuts[i] - cuts[i - 1]) / (to - from);
            add(cuts[i - 1], cuts[i], share * chord.length, depth, rgba);
        }
        rgba[3] = -std::expm1(-depth);
        return rgba;
    }

    static constexpr int steps = 4000;

  private:
    // Adds the part between two cuts, where opacity and colour are linear. So the optical depth of
    // a step is known: the integral of -ln u is u - u ln u, with u = 1 - opacity. Colour is taken
    // in the middle of each step. It changes by at most 1 between two cuts, so each channel is off
    // by at most 1 / (2 steps) of the opacity.
    void add(double from, double to, double length, double& depth,
             std::array<double, 4>& rgba) const {
        const auto at = [&](double share) { return optics(from, to, share); };
        const double step = length / steps / given_.unit_length;
        for (int i = 0; i < steps; ++i) {
            const double u0 = 1 - at(double(i) / steps).opacity;
            const double u1 = 1 - at(double(i + 1) / steps).opacity;
            const double next = depth + step * mean_of_minus_log(u0, u1);
            const double weight = std::exp(-depth) - std::exp(-next);
            const glm::dvec3 color = at((i + .5) / steps).color;
            for (std::size_t c = 0; c < 3; ++c) rgba[c] += weight * color[static_cast<int>(c)];
            depth = next;
        }
    }

    // Returns the mean of -ln u. If both ends are close, their middle serves: its error is ((u1 -
    // u0) / u)^2 / 24, at most 4e-10.
    static double mean_of_minus_log(double u0, double u1) {
        if (u0 <= 0 && u1 <= 0) return 1e9;  // opaque
        if (std::abs(u1 - u0) < 1e-4 * std::max(u0, u1)) return -std::log((u0 + u1) / 2);
        const auto integral = [](double u) { return u > 0 ? u - u * std::log(u) : 0; };
        return (integral(u1) - integral(u0)) / (u1 - u0);
    }

    // Returns opacity and colour between two neighbouring cuts, at `share` of the distance.
    OpacityKnot optics(double from, double to, double share) const {
        const double middle = (from + to) / 2, value = from + share * (to - from);
        const auto& points = given_.points;
        std::size_t above = 0;
        while (above < points.size() && points[above].value < middle) ++above;
        if (above == 0) return points.front();
        if (above == points.size()) return points.back();
        const OpacityKnot &a = points[above - 1], &b = points[above];
        const double way = (value - a.value) / (b.value - a.value);
        return {value, a.color + way * (b.color - a.color),
                a.opacity + way * (b.opacity - a.opacity)};
    }

    const Case& given_;
};

// Error of the pieces (.1 / 255) and of this integration. (Beside opacity 1, extinction is capped
// at 17 per unit length, for the last 4e-8 of opacity, which is negligible.)
constexpr double of_pieces = .1 / 255, of_integration = .5 / Integration::steps;

template <typename Picture>
void expect_near(const Picture& picture, const Case& given, double bound, const char* method) {
    const Integration integration(given);
    double worst = 0, shown = 0;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const auto wanted = integration.along(chord_of(column, row));
            for (std::size_t c = 0; c < 4; ++c) {
                const double found = static_cast<double>(picture.pixel(column, row)[c]);
                worst = std::max(worst, std::abs(found - wanted[c]));
            }
            shown = std::max(shown, wanted[3]);
        }
    }
    EXPECT_LE(worst, bound + of_pieces + of_integration) << given.name << ", " << method;
    EXPECT_GT(shown, .5) << given.name;
}

Scene scene_of(const Case& given, Method method) {
    Scene scene;
    scene.method = method;
    scene.transfer_function = TransferFunction::linear_opacity(given.points, given.unit_length);
    scene.camera = camera();
    scene.width = width;
    scene.height = height;
    scene.trace_tolerance = 1e-6;
    return scene;
}

Volume volume() {
    return test::volume_of(test::grid_of({3, 3, 3}, Centering::node),
                           [](double i, double j, double k) {
                               return field({i, j, k});
                           });
}

std::shared_ptr<const SceneMesh> mesh() {
    MeshData data = test::kuhn_box({2, 2, 2}, field);
    MeshScalar scalar = data.point_scalars.front();
    data.point_scalars.clear();
    return std::make_shared<const SceneMesh>(
        SceneMesh{TetMesh(std::move(data), "mesh"), std::move(scalar), false, {}});
}

TEST(LinearOpacity, IsIntegratedByTheTracer) {
    for (const Case& given : cases) {
        const Scene scene = scene_of(given, Method::trace);
        expect_near(trace(scene, volume()).image, given, scene.trace_tolerance, "traced volume");
        expect_near(trace(scene, *mesh()).image, given, 1e-9, "traced mesh");
    }
}

TEST(LinearOpacity, IsIntegratedBySlicing) {
    const auto data = std::make_shared<const VolumeData>(volume());
    for (const Case& given : cases) {
        SceneRenderer frames(scene_of(given, Method::slice), data, cpu_capabilities());
        const double claimed = frames.plan().slice.found_error();  // .05 / 255: exact segments
        EXPECT_TRUE(frames.plan().slice.integrates_cells());
        expect_near(frames.draw_picture(), given, claimed / 255, "sliced");
    }
}

TEST(LinearOpacity, IsIntegratedByProjectedTets) {
    for (const Case& given : cases) {
        SceneRenderer frames(scene_of(given, Method::project), mesh(), cpu_capabilities());
        // Beside the plan's bound: weights of coloured parts are polynomials good to 3e-5, and sums
        // of tens of float32 fragments are rounded.
        const double claimed = frames.plan().project.trial_error.segments / 255 + 3e-5 + 1e-5;
        expect_near(frames.draw_picture(), given, claimed, "projected");
    }
}

// The field is not linear here, and the tracer is the truth.
TEST(LinearOpacity, SlicingMatchesTheTracerOnCurvedFields) {
    const auto data = std::make_shared<const VolumeData>(
        generate({"gaussians", std::array<std::int64_t, 3>{24, 20, 28}, SampleType::uint8}));
    for (const double top : {120., 255.}) {
        const Case given{
            "curved", {{10, {0, .2, 1}, 0}, {top, {1, 1, 0}, 1}, {256, {1, 0, .3}, .2}}, .03};
        Scene scene = scene_of(given, Method::slice);
        scene.camera->projection = Projection::perspective;
        scene.camera->center = glm::dvec3(.5);
        scene.camera->eye = {1.4, 1.1, 2.2};
        SceneRenderer frames(scene, data, cpu_capabilities());
        const Image picture = frames.draw_picture();
        const PreciseImage truth = trace(scene, data->volume).image;
        double worst = 0;
        for (std::size_t i = 0; i < picture.rgba.size(); ++i)
            worst = std::max(worst, std::abs(static_cast<double>(picture.rgba[i]) - truth.rgba[i]));
        EXPECT_LE(worst, frames.plan().slice.found_error() / 255 + scene.trace_tolerance) << top;
    }
}

}  // namespace
}  // namespace lamina
