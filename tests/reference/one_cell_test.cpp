// SPDX-License-Identifier: Apache-2.0
// Tests one trilinear cell with random corners and transfer functions against two other methods
// that know nothing of cubics: a midpoint sum, and many linear pieces.
#include <gtest/gtest.h>

#include <array>

#include "fixtures.h"
#include "optics/segment_integral.h"
#include "reference/chord.h"

namespace lamina {
namespace {

using namespace reference_test;

struct Sample {
    glm::dvec3 color{0};
    double alpha = 0;
};

struct OneCell {
    std::array<float, 8> corners;
    glm::dvec3 front, back;  // ends of the chord

    double value(double t) const {
        const glm::dvec3 p = glm::mix(front, back, t);
        double sum = 0;
        for (int i = 0; i < 8; ++i) {
            sum += corners[static_cast<std::size_t>(i)] * ((i & 1) ? p.x : 1 - p.x) *
                   ((i & 2) ? p.y : 1 - p.y) * ((i & 4) ? p.z : 1 - p.z);
        }
        return sum;
    }
    double length() const { return glm::length(back - front); }
};

Sample trace(const OneCell& cell, const TransferFunction& function, double tolerance,
             double* estimate = nullptr) {
    const Grid grid = make_grid({2, 2, 2}, Centering::node);
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.eye = cell.front;
    camera.center = cell.back;
    camera.up = {0.31, 0.17, 0.9};
    const TraceResult result = trace_volume(
        make_volume<float>(grid, std::vector<float>(cell.corners.begin(), cell.corners.end())),
        function, View(camera, 1, 1), {tolerance});
    if (estimate) *estimate = result.error_estimate;
    const auto& rgba = result.image.rgba;
    return {{rgba[0], rgba[1], rgba[2]}, rgba[3]};
}

// Returns a cell, and a chord through it from a point on one face to a point on the opposite one.
OneCell random_cell(Random& random) {
    OneCell cell;
    for (float& corner : cell.corners) corner = static_cast<float>(random.below(65)) / 64;
    cell.front = random.point();
    cell.back = random.point();
    const int axis = random.below(3);
    cell.front[axis] = random.below(2);
    cell.back[axis] = 1 - cell.front[axis];
    return cell;
}

Sample midpoint_sum(const OneCell& cell, const TransferFunction& function, int count) {
    const double length = cell.length() / count;
    Sample sum;
    double depth = 0;
    for (int i = 0; i < count; ++i) {
        const OpticalProperties optics = function.at(cell.value((i + 0.5) / count));
        const double step = optics.extinction * length;
        sum.color += std::exp(-depth) * -std::expm1(-step) * optics.color;
        depth += step;
    }
    sum.alpha = -std::expm1(-depth);
    return sum;
}

// Bounds the error of midpoint_sum(): step / 2 * TV, the total variation along the ray. A cubic is
// monotone in at most three parts, so TV is at most 3 times that of the transfer function. The
// error of the depth acts on colour through exp(-depth).
double midpoint_bound(const TransferFunction& function, double step) {
    double depth_variation = 0, emission_variation = 0, brightest = 0, densest = 0;
    const auto knots = function.knots();
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const OpticalProperties& b = knots[i].optics;
        brightest = std::max({brightest, b.color.x, b.color.y, b.color.z});
        densest = std::max(densest, b.extinction);
        if (i == 0) continue;
        const OpticalProperties& a = knots[i - 1].optics;
        depth_variation += std::abs(b.extinction - a.extinction);
        emission_variation += a.extinction + b.extinction;  // colours are at most 1
    }
    return step / 2 *
           (3 * (depth_variation * (1 + brightest) + emission_variation) + brightest * densest);
}

// Returns the result for the field as `count` linear pieces, each integrated in closed form by
// src/optics.
Sample linear_pieces(const OneCell& cell, const TransferFunction& function, int count) {
    Sample sum;
    double depth = 0, front = cell.value(0);
    for (int i = 0; i < count; ++i) {
        const double back = cell.value((i + 1.0) / count);
        const SegmentIntegral piece =
            integrate_segment(function, front, back, cell.length() / count);
        sum.color += std::exp(-depth) * piece.color;
        depth += piece.optical_depth;
        front = back;
    }
    sum.alpha = -std::expm1(-depth);
    return sum;
}

double difference(const Sample& a, const Sample& b) {
    const glm::dvec3 color = glm::abs(a.color - b.color);
    return std::max({color.x, color.y, color.z, std::abs(a.alpha - b.alpha)});
}

TEST(OneCell, EqualsAMidpointSum) {
    Random random(11);
    constexpr int count = 100000;
    for (int i = 0; i < 60; ++i) {
        const OneCell cell = random_cell(random);
        const TransferFunction function =
            random_function(random, random.below(4), random.below(4), random.uniform(1, 20));
        const double bound = midpoint_bound(function, cell.length() / count);
        EXPECT_LE(difference(trace(cell, function, 1e-10), midpoint_sum(cell, function, count)),
                  bound + 1e-10)
            << i;
    }
}

// Bounds the error of linear_pieces(). They replace the field f by one within max|f''| / (8 n^2) of
// it, so their error is C / n^2, with a factor that changes irregularly with n where steps and
// knots are crossed. C is taken from the worst of six coarser divisions.
double linear_pieces_error(const OneCell& cell, const TransferFunction& function,
                           const Sample& fine, int count) {
    double worst = 0;
    for (const int divisor : {16, 11, 8, 6, 4, 3}) {
        const Sample coarse = linear_pieces(cell, function, count / divisor);
        worst = std::max(worst, difference(coarse, fine) / (divisor * divisor));
    }
    return 2 * worst;
}

TEST(OneCell, EqualsTheLimitOfLinearPieces) {
    Random random(12);
    constexpr int count = 6000;
    double tightest = 1, loosest = 0;
    for (int i = 0; i < 150; ++i) {
        const OneCell cell = random_cell(random);
        const TransferFunction function =
            random_function(random, random.below(4), random.below(4), random.uniform(1, 20));
        const Sample fine = linear_pieces(cell, function, count);
        const double allowed = linear_pieces_error(cell, function, fine, count) + 1e-10;
        tightest = std::min(tightest, allowed);
        loosest = std::max(loosest, allowed);
        EXPECT_LE(difference(trace(cell, function, 1e-10), fine), allowed) << i;
    }
    EXPECT_LT(tightest, 1e-9);  // linear_pieces() is accurate enough to be a test
    EXPECT_LT(loosest, 1e-4);
}

// In a field that is linear along the ray, the closed form of src/optics is exact for any transfer
// function.
TEST(OneCell, LinearFieldEqualsTheSegmentIntegral) {
    Random random(13);
    for (int i = 0; i < 300; ++i) {
        OneCell cell;
        const double a = random.below(65) / 64.0, b = random.below(65) / 64.0;
        for (int c = 0; c < 8; ++c) {
            cell.corners[static_cast<std::size_t>(c)] = static_cast<float>((c & 1) ? b : a);
        }
        const double y = random.uniform(), z = random.uniform();
        cell.front = {0, y, z};
        cell.back = {1, y, z};
        const TransferFunction function = random_function(random, random.below(4), random.below(4),
                                                          std::pow(10, random.uniform(-3, 3)));
        const SegmentIntegral exact = integrate_segment(function, a, b, 1);
        // The tolerance is 1e-12; both sides round at 1e-13.
        EXPECT_LE(difference(trace(cell, function, 1e-12), {exact.color, exact.alpha}), 1.2e-12)
            << i;
    }
}

// Segments of many cells along an axis are composited front to back.
TEST(OneCell, LinearCellsComposeToSegments) {
    Random random(14);
    for (int i = 0; i < 40; ++i) {
        const Grid grid = make_grid({33, 2, 2}, Centering::node, {0.125, 1, 1});
        std::vector<float> line(33), samples;
        for (float& value : line) value = static_cast<float>(random.below(65)) / 64;
        for (int copy = 0; copy < 4; ++copy)
            samples.insert(samples.end(), line.begin(), line.end());
        const TransferFunction function =
            random_function(random, 2, 2, std::pow(10, random.uniform(-2, 2)));
        Camera camera;
        camera.projection = Projection::orthographic;
        camera.eye = {i % 2 ? 9.0 : -5.0, 0.3, 0.6};
        camera.center = {2, 0.3, 0.6};
        const TraceResult result =
            trace_volume(make_volume<float>(grid, samples), function, View(camera, 1, 1), {1e-12});
        if (i % 2) std::reverse(line.begin(), line.end());
        Sample expected;
        double depth = 0;
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            const SegmentIntegral piece = integrate_segment(function, line[k], line[k + 1], 0.125);
            expected.color += std::exp(-depth) * piece.color;
            depth += piece.optical_depth;
        }
        expected.alpha = -std::expm1(-depth);
        const auto& rgba = result.image.rgba;
        EXPECT_LE(difference({{rgba[0], rgba[1], rgba[2]}, rgba[3]}, expected), 1.2e-12) << i;
    }
}

// The field only touches a knot, from below, at the middle of the ray: a parabola's vertex on a
// peak's tip.
TEST(OneCell, TangentKnotsEqualTheLimitOfLinearPieces) {
    OneCell cell;
    cell.corners = {0, 1, 1, 0,
                    0, 1, 1, 0};  // x + y - 2xy: along the diagonal 2t - 2t^2, vertex 1/2
    cell.front = {0, 0, 0.5};
    cell.back = {1, 1, 0.5};
    const double below = std::nextafter(0.5, 0.0), above = std::nextafter(0.5, 1.0);
    for (const double knot : {0.5, below, above}) {
        const TransferFunction function = TransferFunction::linear(
            {{0, {{1, 0, 0}, 1}}, {knot, {{0, 1, 0}, 5}}, {1, {{0, 0, 1}, 40}}});
        const Sample fine = linear_pieces(cell, function, 6000);
        EXPECT_LE(difference(trace(cell, function, 1e-10), fine),
                  linear_pieces_error(cell, function, fine, 6000) + 1e-10);
        // A step above the vertex is never reached: the whole ray is below it.
        const TransferFunction step = TransferFunction::linear(
            {{0, {glm::dvec3(1), 2}}, {knot, {glm::dvec3(1), 2}}, {knot, {glm::dvec3(0), 9}}});
        const double expected = -std::expm1(-2 * std::sqrt(2.0));
        // Rounding may put the field on the step, but for at most sqrt(1e-16) of the ray.
        EXPECT_NEAR(trace(cell, step, 1e-10).alpha, expected, 1e-6) << knot;
    }
}

}  // namespace
}  // namespace lamina
