// SPDX-License-Identifier: Apache-2.0
#include "slicing/gradient_map.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "volume/brick_cache.h"

namespace lamina {
namespace {

// Lengths below which nothing and above which everything is lit, for any smallest_gradient.
constexpr double least_length = 1e-280, largest_length = 1e280;
constexpr int exponent_bias = 1023, mantissa_bits = 52;  // of doubles

// Computes gradients as differences of neighbouring samples.
template <typename Sample>
class Differences {
  public:
    // `window`: must hold the samples that at() is called for, and their neighbours in the volume.
    Differences(const Grid& grid, const SampleWindow<Sample>& window)
        : samples_(window.samples),
          first_(window.box.first),
          size_(grid.size),
          stride_{1, window.box.size[0], window.box.size[0] * window.box.size[1]} {
        for (std::size_t axis = 0; axis < 3; ++axis)
            per_step_[axis] = 1 / glm::length(grid.step[axis]);
    }

    // Returns the gradient along the grid's axes at a sample; an index outside is clamped first.
    std::array<double, 3> at(std::array<std::int64_t, 3> index) const {
        std::int64_t offset = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            index[axis] = std::clamp<std::int64_t>(index[axis], 0, size_[axis] - 1);
            offset += (index[axis] - first_[axis]) * stride_[axis];
        }
        std::array<double, 3> gradient{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            gradient[axis] = difference(offset, index[axis], axis) * per_step_[axis];
        return gradient;
    }

  private:
    // Returns the central difference; one-sided if a neighbour is missing or not finite.
    double difference(std::int64_t offset, std::int64_t index, std::size_t axis) const {
        const Sample* const here = samples_ + offset;
        const std::int64_t step = stride_[axis];
        const bool below = index > 0 && std::isfinite(static_cast<double>(here[-step]));
        const bool above =
            index + 1 < size_[axis] && std::isfinite(static_cast<double>(here[step]));
        if (below && above)
            return 0.5 * (static_cast<double>(here[step]) - static_cast<double>(here[-step]));
        const auto center = static_cast<double>(*here);
        if (!std::isfinite(center)) return 0;
        if (above) return static_cast<double>(here[step]) - center;
        if (below) return center - static_cast<double>(here[-step]);
        return 0;
    }

    const Sample* samples_;
    std::array<std::int64_t, 3> first_, size_, stride_;
    std::array<double, 3> per_step_{};
};

}  // namespace

StoredGradient store_gradient(const std::array<double, 3>& gradient) {
    double largest = 0;
    for (const double component : gradient) largest = std::max(largest, std::abs(component));
    if (!(largest >= least_length)) return {};
    largest = std::min(largest, largest_length);
    const int octave =
        static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> mantissa_bits) - exponent_bias;
    // The largest component becomes 2^14 to 2^15; clamped, as it may round to 2^15, beyond int16.
    const int exponent = octave - 14;
    const double scale = std::bit_cast<double>(static_cast<std::uint64_t>(exponent_bias - exponent)
                                               << mantissa_bits);
    StoredGradient stored;
    stored.exponent = static_cast<std::int16_t>(exponent);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double scaled = std::clamp(gradient[axis] * scale, -32767.0, 32767.0);
        stored.component[axis] = static_cast<std::int16_t>(std::nearbyint(scaled));
    }
    return stored;
}

void set_gradient_row(const Volume& volume, const TextureBrick& part, std::int64_t y,
                      std::int64_t z, std::span<StoredGradient> row) {
    assert(row.size() == static_cast<std::size_t>(part.size[0]));
    volume.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        const Differences differences(
            volume.grid(), SampleWindow<Sample>{{{0, 0, 0}, volume.grid().size}, samples});
        std::int64_t x = part.first[0];
        for (StoredGradient& stored : row)
            stored = store_gradient(differences.at({x++, part.first[1] + y, part.first[2] + z}));
    });
}

template <typename Sample>
void set_page_gradients(const Grid& grid, const SampleWindow<Sample>& window,
                        const std::array<std::int64_t, 3>& first, StoredGradient* to) {
    const Differences differences(grid, window);
    for (std::int64_t z = 0; z < BrickCache::samples; ++z) {
        for (std::int64_t y = 0; y < BrickCache::samples; ++y) {
            for (std::int64_t x = 0; x < BrickCache::samples; ++x)
                *to++ = store_gradient(differences.at({first[0] + x, first[1] + y, first[2] + z}));
        }
    }
}

template void set_page_gradients(const Grid&, const SampleWindow<std::uint8_t>&,
                                 const std::array<std::int64_t, 3>&, StoredGradient*);
template void set_page_gradients(const Grid&, const SampleWindow<std::int16_t>&,
                                 const std::array<std::int64_t, 3>&, StoredGradient*);
template void set_page_gradients(const Grid&, const SampleWindow<std::uint16_t>&,
                                 const std::array<std::int64_t, 3>&, StoredGradient*);
template void set_page_gradients(const Grid&, const SampleWindow<float>&,
                                 const std::array<std::int64_t, 3>&, StoredGradient*);

std::vector<StoredGradient> make_gradient_map(const Volume& volume, const TextureBrick& part) {
    const auto row_size = static_cast<std::size_t>(part.size[0]);
    const std::int64_t rows = part.size[1] * part.size[2];
    std::vector<StoredGradient> map(row_size * static_cast<std::size_t>(rows));
    parallel_for(rows, 64, [&](std::int64_t number) {
        set_gradient_row(
            volume, part, number % part.size[1], number / part.size[1],
            std::span(map).subspan(static_cast<std::size_t>(number) * row_size, row_size));
    });
    return map;
}

}  // namespace lamina
