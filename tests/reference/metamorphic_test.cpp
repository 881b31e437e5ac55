// SPDX-License-Identifier: Apache-2.0
// Tests that scenes which describe the same thing in different ways give the same picture.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "fixtures.h"
#include "lit_fixtures.h"
#include "support/each_instruction_set.h"

namespace lamina {
namespace {

using namespace reference_test;

constexpr double traced_to =
    1e-12;  // of each picture; both err by that at most, and round at some 1e-13
constexpr double allowed = 2 * traced_to + 3e-13;
constexpr int width = 31, height = 25;

struct Scene {
    Grid grid;
    std::vector<float> samples;
    TransferFunction function;

    TraceResult trace(const Camera& camera) const {
        return trace_volume(make_volume<float>(grid, samples), function,
                            View(camera, width, height), {traced_to});
    }
};

Scene make_scene(Centering centering) {
    Random random(21);
    const Grid grid = make_grid({6, 5, 4}, centering, {0.5, 0.75, 1.25});
    std::vector<float> samples = random_samples(grid, random);
    return {grid, std::move(samples), random_function(random, 3, 2, 3)};
}

std::size_t offset(const Grid& grid, const std::array<std::int64_t, 3>& i) {
    return static_cast<std::size_t>((i[2] * grid.size[1] + i[1]) * grid.size[0] + i[0]);
}

// Returns the same scene with its samples stored differently: axis a of the new grid is axis
// order[a] of the old one, reversed if `reversed` says so.
Scene stored_differently(const Scene& scene, const std::array<std::size_t, 3>& order,
                         const std::array<bool, 3>& reversed) {
    Scene result = scene;
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t old_axis = order[a];
        result.grid.size[a] = scene.grid.size[old_axis];
        result.grid.step[a] = scene.grid.step[old_axis] * (reversed[a] ? -1.0 : 1.0);
        if (reversed[a]) {
            result.grid.origin +=
                static_cast<double>(scene.grid.size[old_axis] - 1) * scene.grid.step[old_axis];
        }
    }
    std::array<std::int64_t, 3> i;
    for (i[2] = 0; i[2] < result.grid.size[2]; ++i[2]) {
        for (i[1] = 0; i[1] < result.grid.size[1]; ++i[1]) {
            for (i[0] = 0; i[0] < result.grid.size[0]; ++i[0]) {
                std::array<std::int64_t, 3> old_index{};
                for (std::size_t a = 0; a < 3; ++a) {
                    old_index[order[a]] = reversed[a] ? result.grid.size[a] - 1 - i[a] : i[a];
                }
                result.samples[offset(result.grid, i)] =
                    scene.samples[offset(scene.grid, old_index)];
            }
        }
    }
    return result;
}

TEST(Metamorphic, PermutingAndReversingAxesChangesNothing) {
    for (const Centering centering : {Centering::node, Centering::cell}) {
        const Scene scene = make_scene(centering);
        const Scene others[] = {
            stored_differently(scene, {1, 2, 0}, {false, false, false}),
            stored_differently(scene, {2, 1, 0}, {false, false, false}),
            stored_differently(scene, {0, 1, 2}, {true, false, false}),
            stored_differently(scene, {1, 0, 2}, {false, true, true}),
        };
        for (const Camera& camera : cameras(scene.grid)) {
            const TraceResult expected = scene.trace(camera);
            EXPECT_GT(largest_alpha(expected.image), 0.1);
            for (const Scene& other : others) {
                EXPECT_LE(largest_difference(expected.image, other.trace(camera).image), allowed);
            }
        }
    }
}

// If world and camera are mirrored at x = 0, the picture is mirrored left to right.
TEST(Metamorphic, MirroringTheWorldMirrorsThePicture) {
    const Scene scene = make_scene(Centering::node);
    const auto mirror = [](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, p.z); };
    Scene mirrored = scene;
    mirrored.grid.origin = mirror(scene.grid.origin);
    for (glm::dvec3& step : mirrored.grid.step) step = mirror(step);
    for (const Camera& camera : cameras(scene.grid)) {
        Camera other = camera;
        other.eye = mirror(camera.eye);
        other.center = mirror(camera.center);
        other.up = mirror(camera.up);
        const PreciseImage a = scene.trace(camera).image, b = mirrored.trace(other).image;
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                for (int channel = 0; channel < 4; ++channel) {
                    ASSERT_NEAR(a.pixel(column, row)[channel],
                                b.pixel(width - 1 - column, row)[channel], allowed);
                }
            }
        }
    }
}

TEST(Metamorphic, ScalingWorldAndExtinctionChangesNothing) {
    const Scene scene = make_scene(Centering::cell);
    for (const double s : {3.0, 1e-6, 7e8}) {
        Scene scaled = scene;
        scaled.grid.origin *= s;
        for (glm::dvec3& step : scaled.grid.step) step *= s;
        std::vector<TransferKnot> knots(scene.function.knots().begin(),
                                        scene.function.knots().end());
        for (TransferKnot& knot : knots) knot.optics.extinction /= s;
        scaled.function = TransferFunction::linear(knots);
        for (const Camera& camera : cameras(scene.grid)) {
            Camera other = camera;
            other.eye *= s;
            other.center *= s;
            other.height *= s;
            EXPECT_LE(largest_difference(scene.trace(camera).image, scaled.trace(other).image),
                      allowed)
                << s;
        }
    }
}

TEST(Metamorphic, RefiningTheGridChangesNothing) {
    const Scene scene = make_scene(Centering::node);
    Scene fine = scene;
    for (std::size_t a = 0; a < 3; ++a) {
        fine.grid.size[a] = 2 * scene.grid.size[a] - 1;
        fine.grid.step[a] *= 0.5;
    }
    fine.samples.resize(static_cast<std::size_t>(fine.grid.sample_count()));
    std::array<std::int64_t, 3> i;
    for (i[2] = 0; i[2] < fine.grid.size[2]; ++i[2]) {
        for (i[1] = 0; i[1] < fine.grid.size[1]; ++i[1]) {
            for (i[0] = 0; i[0] < fine.grid.size[0]; ++i[0]) {
                float sum = 0;  // mean of the 8 (not always different) coarse samples around: exact
                                // in float
                for (int corner = 0; corner < 8; ++corner) {
                    std::array<std::int64_t, 3> coarse;
                    for (std::size_t a = 0; a < 3; ++a)
                        coarse[a] = (i[a] + ((corner >> a) & 1)) / 2;
                    sum += scene.samples[offset(scene.grid, coarse)];
                }
                fine.samples[offset(fine.grid, i)] = sum / 8;
            }
        }
    }
    for (const Camera& camera : cameras(scene.grid)) {
        const TraceResult a = scene.trace(camera), b = fine.trace(camera);
        EXPECT_LE(largest_difference(a.image, b.image), allowed);
        EXPECT_GT(b.segments, a.segments);
    }
}

TEST(Metamorphic, SampleTypesAgree) {
    const Grid grid = make_grid({6, 6, 6}, Centering::node);
    Random random(5);
    std::vector<std::uint8_t> bytes(216);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(65));
    const TransferFunction function = TransferFunction::linear(
        {{10, {{1, 0, 0}, 0}}, {40, {{0, 1, 0}, 2}}, {40, {{0, 0, 1}, 0.5}}, {60, {{1, 1, 1}, 3}}});
    const View view(camera_at(grid, Projection::perspective, {1, 2, 3}, 1), width, height);
    const auto trace_as = [&](auto type) {
        using Sample = decltype(type);
        return trace_volume(make_volume<Sample>(grid, {bytes.begin(), bytes.end()}), function, view,
                            {})
            .image.rgba;
    };
    const std::vector<double> expected = trace_as(std::uint8_t{});
    EXPECT_EQ(trace_as(std::int16_t{}), expected);
    EXPECT_EQ(trace_as(std::uint16_t{}), expected);
    EXPECT_EQ(trace_as(float{}), expected);
}

TEST(Metamorphic, NumberOfThreadsDoesNotMatter) {
    const Scene scene = make_scene(Centering::cell);
    const Camera camera = cameras(scene.grid).front();
    const TraceResult many = scene.trace(camera);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const TraceResult one = scene.trace(camera);
    EXPECT_EQ(many.image.rgba, one.image.rgba);
    EXPECT_EQ(many.error_estimate, one.error_estimate);
    EXPECT_EQ(many.segments, one.segments);
}

// Traces a picture, and each of its pixels alone, which must have the same digits. Returns the
// largest component of any pixel.
double compare_alone(const Volume& volume, const TransferFunction& function, const Camera& camera,
                     const TraceOptions& options) {
    const View view(camera, 60, 45);
    std::vector<glm::ivec2> pixels;
    for (int row = 0; row < view.height; ++row)
        for (int column = 0; column < view.width; ++column) pixels.push_back({column, row});
    const TraceResult picture = trace_volume(volume, function, view, options);
    const TracedPixels alone = trace_pixels(volume, function, view, pixels, options);
    double most = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double* const pixel = picture.image.pixel(pixels[i].x, pixels[i].y);
        for (int channel = 0; channel < 4; ++channel) {
            EXPECT_EQ(pixel[channel], alone.rgba[i][channel]) << pixels[i].x << ' ' << pixels[i].y;
            most = std::max(most, pixel[channel]);
        }
    }
    return most;
}

// Pictures leave out cells that show nothing, and trace rays side by side. Single pixels do
// neither, but must be the same.
TEST(Metamorphic, CellsThatShowNothingChangeNothing) {
    const TransferFunction steep = TransferFunction::linear(
        {{.5, {{.2, .4, .6}, 0}}, {.8, {{.9, .5, .1}, 20}}, {1, {{.1, 1, .3}, 10}}});
    // A function with shallow and deep pieces side by side, which use different exponential
    // functions.
    const TransferFunction mixed = TransferFunction::linear(
        {{.3, {{.2, .4, .6}, 0}}, {.6, {{.9, .5, .1}, .1}}, {.8, {{.9, .9, .1}, 2}}});
    for (const auto& [function, centering] :
         {std::pair(steep, Centering::node), std::pair(steep, Centering::cell),
          std::pair(mixed, Centering::node)}) {
        const Grid grid = make_grid({33, 27, 20}, centering, {1, .75, 1.25});
        Random random(4);
        std::vector<float> samples(static_cast<std::size_t>(grid.sample_count()));
        for (int speck = 0; speck < 40; ++speck) {
            samples[static_cast<std::size_t>(random.uniform(0, double(samples.size())))] =
                speck < 8 ? NAN : float(random.uniform(.6, 1));
        }
        samples.front() = samples.back() = 1;
        const Volume volume = make_volume<float>(grid, samples);
        std::vector<Camera> views = cameras(grid);
        for (const glm::dvec3& along : {glm::dvec3(1, 0, 0), {0, -1, 0}, {0, 0, 1}}) {
            views.push_back(camera_at(grid, Projection::orthographic, along, 1));
            views.back().up = {along.y, along.z, along.x};
        }
        // Rays that meet edges of cells up to rounding.
        for (const glm::dvec3& along : {glm::dvec3(1, 0, 1.25), {1, .75, 0}, {-1, .75, 1.25}})
            views.push_back(camera_at(grid, Projection::orthographic, along, 1));
        const TraceOptions plain{traced_to};
        const TraceOptions lit{
            traced_to,
            directional(),
            {{middle_of(grid), {1, .3, -.2}}, {grid.to_world({2, 2, 2}), {.1, 1, .4}}}};
        double most = 0;
        for (const Camera& camera : views)
            most = std::max(most, compare_alone(volume, function, camera, plain));
        test::for_each_instruction_set([&](const std::string&) {
            for (const TraceOptions& options : {plain, lit})
                most = std::max(most, compare_alone(volume, function, views.front(), options));
        });
        EXPECT_GT(most, .1);
    }
}

}  // namespace
}  // namespace lamina
