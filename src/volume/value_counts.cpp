// SPDX-License-Identifier: Apache-2.0
#include "volume/value_counts.h"

#include <cmath>
#include <numeric>
#include <type_traits>

namespace lamina {

namespace {

// Number of samples that are looked at: with so many, a share of 1e-4 is known to 7 percent.
constexpr std::int64_t most_float_samples = std::int64_t{1} << 21;

}  // namespace

std::int64_t sample_step(const Grid& grid) {
    std::int64_t step = (grid.sample_count() + most_float_samples - 1) / most_float_samples;
    while (step > 1 && std::gcd(step, grid.size[0]) > 1) ++step;
    return step;
}

ValueCounts count_values(const Volume& volume) {
    const std::int64_t count = volume.grid().sample_count();
    ValueCounts counted;
    volume.visit([&](const auto* samples) {
        if constexpr (std::is_same_v<decltype(samples), const float*>) {
            const std::int64_t step = sample_step(volume.grid());
            for (std::int64_t i = 0; i < count; i += step)
                if (std::isfinite(samples[i])) counted.some.push_back(samples[i]);
        } else {
            counted.codes = count_codes(samples, count);
        }
    });
    return counted;
}

}  // namespace lamina
