// SPDX-License-Identifier: Apache-2.0
// Small volumes, cameras and transfer functions for the tests of the reference tracer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "reference/tracer.h"

namespace lamina::reference_test {

template <typename Sample>
Volume make_volume(const Grid& grid, std::vector<Sample> samples) {
    const SampleType type = std::is_same_v<Sample, float>          ? SampleType::float32
                            : std::is_same_v<Sample, std::uint8_t> ? SampleType::uint8
                            : std::is_same_v<Sample, std::int16_t> ? SampleType::int16
                                                                   : SampleType::uint16;
    auto shared = std::make_shared<std::vector<Sample>>(std::move(samples));
    return Volume(grid, type, std::shared_ptr<const void>(shared, shared->data()));
}

inline Grid make_grid(std::array<std::int64_t, 3> size, Centering centering,
                      const glm::dvec3& spacing = glm::dvec3(1)) {
    Grid grid;
    grid.size = size;
    grid.centering = {centering, centering, centering};
    for (int axis = 0; axis < 3; ++axis) {
        grid.step[axis] = glm::dvec3(0);
        grid.step[axis][axis] = spacing[axis];
    }
    return grid;
}

inline const Grid unit_box = make_grid({2, 2, 2}, Centering::node);

inline glm::dvec3 middle_of(const Grid& grid) {
    return grid.to_world(0.5 * (grid.index_min() + grid.index_max()));
}

inline double diagonal_of(const Grid& grid) {
    return glm::length(grid.to_world(grid.index_max()) - grid.to_world(grid.index_min()));
}

// Returns a camera that looks at the middle of the grid from `distance` box diagonals away.
inline Camera camera_at(const Grid& grid, Projection projection, const glm::dvec3& direction,
                        double distance) {
    Camera camera;
    camera.projection = projection;
    camera.center = middle_of(grid);
    camera.eye = camera.center + distance * diagonal_of(grid) * glm::normalize(direction);
    camera.up = {0.1, 1, 0.05};
    camera.fov_y = 60;
    camera.height = 1.1 * diagonal_of(grid);
    return camera;
}

// Returns views of a grid from outside and from inside, in both projections.
inline std::vector<Camera> cameras(const Grid& grid) {
    return {camera_at(grid, Projection::perspective, {1, 2, 3}, 1.2),
            camera_at(grid, Projection::perspective, {1, -2, 0.5}, 0.1),
            camera_at(grid, Projection::orthographic, {-3, 1, 1}, 1.2)};
}

// Makes random numbers in [lo, hi), the same on every platform.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double lo = 0, double hi = 1) {
        return lo + (hi - lo) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
    }
    int below(int count) { return static_cast<int>(uniform(0, count)); }
    glm::dvec3 point(double lo = 0, double hi = 1) {
        const double x = uniform(lo, hi), y = uniform(lo, hi);
        return {x, y, uniform(lo, hi)};
    }

  private:
    std::mt19937_64 engine_;
};

inline std::vector<float> random_samples(const Grid& grid, Random& random) {
    std::vector<float> samples(static_cast<std::size_t>(grid.sample_count()));
    // Multiples of 1/64: halves, quarters and eighths of their sums are exact in float.
    for (float& sample : samples) sample = static_cast<float>(random.below(65)) / 64;
    return samples;
}

inline TransferFunction constant_function(double extinction, const glm::dvec3& color) {
    return TransferFunction::linear({{0, {color, extinction}}});
}

// Returns a function with colour and extinction linear over [0, 1].
inline TransferFunction ramp_function(double extinction) {
    return TransferFunction::linear({{0, {{0, 0.25, 1}, 0}}, {1, {{1, 0.5, 0.125}, extinction}}});
}

// Returns a function with `peaks` triangular peaks and `steps` steps at random places in [0, 1],
// over a faint base.
inline TransferFunction random_function(Random& random, int peaks, int steps, double extinction) {
    std::vector<double> values;
    for (int i = 0; i < 3 * peaks + steps; ++i) values.push_back(random.uniform(0.02, 0.98));
    std::sort(values.begin(), values.end());
    std::vector<TransferKnot> knots;
    const auto add = [&](double value, double strength) {
        knots.push_back({value, {random.point(), strength}});
    };
    add(0, 0.1);
    std::size_t next = 0;
    for (int i = 0; i < std::max(peaks, steps); ++i) {
        if (i < peaks) {
            add(values[next], 0);
            add(values[next + 1], extinction);
            add(values[next + 2], random.below(2) * 0.3 * extinction);
            next += 3;
        }
        if (i < steps) {
            add(values[next], random.uniform(0, extinction));
            add(values[next], random.below(2) * random.uniform(0, extinction));
            ++next;
        }
    }
    return TransferFunction::linear(std::move(knots));
}

inline double largest_difference(const PreciseImage& a, const PreciseImage& b) {
    if (a.rgba.size() != b.rgba.size()) return std::numeric_limits<double>::infinity();
    double largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double difference = std::abs(a.rgba[i] - b.rgba[i]);
        if (!(difference <= largest)) largest = difference;  // NaN is kept
    }
    return largest;
}

inline double largest_alpha(const PreciseImage& image) {
    double largest = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        largest = std::max(largest, image.rgba[i]);
    }
    return largest;
}

}  // namespace lamina::reference_test
