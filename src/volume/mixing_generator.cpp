// SPDX-License-Identifier: Apache-2.0
#include "volume/mixing_generator.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "volume/gradient_noise.h"

namespace lamina {
namespace {

// All lengths are in units of the box.
constexpr double layer_begin = 0.08;  // pure light fluid before, pure heavy fluid after layer_end
constexpr double layer_end = 0.92;
constexpr double layer_margin = 0.20;     // over which stirring fades in and out
constexpr double interface_reach = 0.34;  // of spikes and bubbles
constexpr double interface_width = 0.08;
constexpr double stirring = 0.22;
constexpr double entrainment = 0.7;

constexpr int interface_octaves = 3;
constexpr double interface_frequency = 6;
constexpr double stirring_frequency = 6;
constexpr double persistence = 0.70;
constexpr double samples_per_finest_cell = 4;

double smooth_step(double t) {
    return fade(std::clamp(t, 0.0, 1.0));
}

class Mixing final : public Generator {
  public:
    explicit Mixing(const GridSize& size) : size_(size) {
        const auto longest = static_cast<double>(*std::max_element(size.begin(), size.end()));
        for (double frequency = stirring_frequency;
             frequency == stirring_frequency || frequency * samples_per_finest_cell <= longest;
             frequency *= 2) {
            frequencies_.push_back(frequency);
        }
        for (std::int64_t x = 0; x < size[0]; ++x) {
            const double position = unit_position(x, size[0]);
            position_.push_back(position);
            strength_.push_back(smooth_step((position - layer_begin) / layer_margin) *
                                smooth_step((layer_end - position) / layer_margin));
        }
    }

    void row(std::int64_t y, std::int64_t z, double* values) const override {
        const double py = unit_position(y, size_[1]);
        const double pz = unit_position(z, size_[2]);
        std::vector<double> coarse(strength_.size());
        std::vector<double> fine(strength_.size());
        add_eddies(py, pz, coarse.data(), fine.data());
        const double interface = interface_position(py, pz);
        for (std::size_t x = 0; x < position_.size(); ++x) {
            const double stirred =
                position_[x] - interface + stirring * strength_[x] * (coarse[x] + fine[x]);
            const double heavy = smooth_step(0.5 + stirred / (2 * interface_width));
            // Eddies of one fluid in the other appear where the interface is near.
            const double nearness = smooth_step(1 - std::abs(stirred) / (4 * interface_width));
            values[x] =
                std::clamp(heavy + entrainment * nearness * strength_[x] * fine[x], 0.0, 1.0);
        }
    }

  private:
    // Adds the noise of the coarser and of the finer half of the octaves.
    void add_eddies(double py, double pz, double* coarse, double* fine) const {
        const auto begin =
            std::find_if(strength_.begin(), strength_.end(), [](double s) { return s > 0; });
        const auto end = std::find(begin, strength_.end(), 0.0);
        const auto first = static_cast<std::size_t>(begin - strength_.begin());
        if (begin == end) return;
        double amplitude = 1;
        for (std::size_t octave = 0; octave < frequencies_.size(); ++octave) {
            const double frequency = frequencies_[octave];
            const double start = position_[first] * frequency;
            const double step =
                frequency / static_cast<double>(std::max<std::int64_t>(1, size_[0] - 1));
            GradientNoise(stirring_seed + octave)
                .add_row(start, step, py * frequency, pz * frequency, amplitude,
                         static_cast<int>(end - begin),
                         (octave < frequencies_.size() / 2 ? coarse : fine) + first);
            amplitude *= persistence;
        }
    }

    double interface_position(double py, double pz) const {
        double height = 0;
        double amplitude = 2;
        double frequency = interface_frequency;
        for (std::uint64_t octave = 0; octave < interface_octaves; ++octave) {
            height +=
                amplitude *
                GradientNoise(interface_seed + octave).at(0.5, py * frequency, pz * frequency);
            amplitude *= 0.5;
            frequency *= 2;
        }
        height = std::clamp(height, -1.0, 1.0);
        // Spikes (towards small x) are narrow and long, bubbles are broad and flat.
        const double shape = height < 0 ? -height * height * (1.5 + 0.5 * height)
                                        : 0.8 * height * (2 - height) * 0.8;
        return 0.5 + interface_reach * shape;
    }

    static constexpr std::uint64_t interface_seed = 0x5eed0000;
    static constexpr std::uint64_t stirring_seed = 0x5eed1000;

    GridSize size_;
    std::vector<double> frequencies_;  // of stirring, in cells a box
    std::vector<double> position_;     // of samples along x
    std::vector<double> strength_;     // of stirring, at every x: 0 outside the layer
};

}  // namespace

std::unique_ptr<Generator> make_mixing(const GridSize& size) {
    return std::make_unique<Mixing>(size);
}

}  // namespace lamina
