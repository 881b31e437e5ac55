// SPDX-License-Identifier: Apache-2.0
#include "volume/examples.h"

#include <algorithm>
#include <cmath>

#include "base/client.h"
#include "base/parallel.h"
#include "volume/generate.h"
#include "volume/gradient_noise.h"

namespace lamina {
namespace {

constexpr std::array<std::int64_t, 3> jet_size{64, 64, 128};
constexpr double jet_spacing = 5;  // mm

// Lengths in units of the box's width, which is 64 samples. A round jet widens by a tenth of its
// length (Pope, "Turbulent Flows", 2000, section 5.1); this one by more, so that it fills the box.
constexpr double nozzle_radius = 0.06;
constexpr double widening = 0.19;     // half width per height
constexpr double core_length = 0.30;  // height up to which the middle is pure
constexpr double jet_edge = 0.22;     // width of the jet's edge, in half widths
constexpr int eddy_octaves = 3;
constexpr double eddy_swing = 0.75;  // displacement by the largest eddies, in half widths
constexpr double decay = 0.62;       // of an octave's displacement, beside the one before
constexpr double eddy_travel = 1.4;  // eddies pass by per time step, in quarters of a half width

double half_width(double height) {
    return nozzle_radius + widening * std::max(0.0, height - 0.4 * core_length);
}

// Heights in units of the local half width, so that eddies grow with the jet: the integral of
// 1 / half_width from the nozzle to each slice.
std::vector<double> stretched_heights() {
    std::vector<double> heights;
    constexpr int steps = 16;
    const double step = 1 / static_cast<double>(jet_size[0]) / steps;
    double sum = 0;
    for (std::int64_t z = 0; z < jet_size[2]; ++z) {
        heights.push_back(sum);
        for (int i = 0; i < steps; ++i)
            sum += step / half_width(step * (static_cast<double>(z * steps + i) + 0.5));
    }
    return heights;
}

// One slice of one time.
class JetSlice {
  public:
    JetSlice(std::int64_t time, double height, double stretched)
        : time_(static_cast<double>(time)),
          width_(half_width(height)),
          stretched_(stretched),
          calm_(smooth_step((height - 0.02) / 0.45)),
          strength_(std::min(1.0, 0.38 + 0.62 * core_length / std::max(height, core_length))) {}

    void row(std::int64_t y, std::uint8_t* samples) const {
        constexpr auto count = static_cast<std::size_t>(jet_size[0]);
        const double across = place(y);
        std::vector<double> moved_x(count), moved_y(count), change(count);
        double amplitude = eddy_swing * calm_;
        double frequency = 0.9;
        for (std::uint64_t octave = 0; octave < eddy_octaves; ++octave) {
            add(octave, across, frequency, amplitude, moved_x);
            add(octave + 16, across, frequency, amplitude, moved_y);
            if (octave > 0) add(octave + 32, across, frequency, amplitude / eddy_swing, change);
            amplitude *= decay;
            frequency *= 2;
        }
        for (std::size_t x = 0; x < count; ++x) {
            const double px = place(static_cast<std::int64_t>(x)) + moved_x[x];
            const double py = across + moved_y[x];
            const double radius = std::sqrt(px * px + py * py);
            const double inside =
                smooth_step((1 + jet_edge - radius) / (2 * jet_edge + 0.8 * calm_));
            const double value = inside * strength_ * (1 + 0.8 * change[x] * calm_);
            samples[x] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 1.0) * 255 + 0.5);
        }
    }

  private:
    // Returns the distance of a sample from the axis in half widths.
    double place(std::int64_t i) const {
        return ((static_cast<double>(i) + 0.5) / static_cast<double>(jet_size[0]) - 0.5) / width_;
    }

    // Adds eddies, which rise with the jet: the smaller ones somewhat faster, so that none returns.
    void add(std::uint64_t seed, double across, double frequency, double amplitude,
             std::vector<double>& values) const {
        const double risen = time_ * eddy_travel / 4 * (1 + 0.06 * static_cast<double>(seed % 16));
        const double step = 1 / (static_cast<double>(jet_size[0]) * width_);
        // Lattice planes stand apart from the axis, where noise would vanish.
        GradientNoise(0x3e70 + seed)
            .add_row((place(0) + 100.37) * frequency, step * frequency,
                     (across + 100.61) * frequency, (stretched_ - risen + 100.5) * frequency,
                     amplitude, static_cast<int>(values.size()), values.data());
    }

    double time_, width_, stretched_;
    double calm_;      // 0 at the nozzle, 1 where the jet is turbulent
    double strength_;  // of the jet's fluid in the middle
};

}  // namespace

Grid jet_grid() {
    Grid grid;
    grid.size = jet_size;
    const double middle = 0.5 * jet_spacing * static_cast<double>(jet_size[0] - 1);
    grid.origin = {-middle, -middle, 0};
    grid.step = {glm::dvec3{jet_spacing, 0, 0}, glm::dvec3{0, jet_spacing, 0},
                 glm::dvec3{0, 0, jet_spacing}};
    grid.unit = "mm";
    return grid;
}

std::vector<std::uint8_t> jet_samples() {
    const std::int64_t slice = jet_size[0] * jet_size[1];
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(slice * jet_size[2] * jet_times));
    const std::vector<double> heights = stretched_heights();
    Progress progress("making the jet", jet_times * jet_size[2]);
    parallel_for(jet_times * jet_size[2], 1, [&](std::int64_t i) {
        const std::int64_t time = i / jet_size[2], z = i % jet_size[2];
        const JetSlice made(time, static_cast<double>(z) / static_cast<double>(jet_size[0]),
                            heights[static_cast<std::size_t>(z)]);
        for (std::int64_t y = 0; y < jet_size[1]; ++y)
            made.row(y, samples.data() + i * slice + y * jet_size[0]);
        progress.advance();
    });
    return samples;
}

}  // namespace lamina
