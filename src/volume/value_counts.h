// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

#include "base/parallel.h"
#include "lamina/volume.h"

namespace lamina {

using Counts = std::vector<std::int64_t>;

// Adds up, in parallel, the counts that `count_part(first, end, counts)` makes of the parts of [0,
// samples). Parts are so large that counting takes much longer than adding, and so small that
// 32-bit counters suffice.
template <typename CountPart>
Counts count_in_parts(std::int64_t samples, std::size_t counters, const CountPart& count_part) {
    constexpr std::int64_t fewest = std::int64_t{1} << 20, most = std::int64_t{1} << 30;
    const std::int64_t part = std::clamp(16 * static_cast<std::int64_t>(counters), fewest, most);
    Counts total(counters);
    std::mutex adding;
    parallel_for((samples + part - 1) / part, 1, [&](std::int64_t number) {
        std::vector<std::uint32_t> counts(counters);
        const std::int64_t first = number * part;
        count_part(first, std::min(samples, first + part), counts);
        const std::scoped_lock lock(adding);
        for (std::size_t i = 0; i < counters; ++i) total[i] += counts[i];
    });
    return total;
}

// Returns how many samples of 8 or 16 bits have each value of their type, from the lowest on.
template <typename T>
Counts count_codes(const T* samples, std::int64_t count) {
    constexpr int lowest = std::numeric_limits<T>::min();
    return count_in_parts(
        count, std::size_t{1} << (8 * sizeof(T)),
        [&](std::int64_t first, std::int64_t end, std::vector<std::uint32_t>& into) {
            for (std::int64_t i = first; i < end; ++i)
                ++into[static_cast<std::size_t>(int{samples[i]} - lowest)];
        });
}

// The values of a volume.
struct ValueCounts {
    Counts codes;             // for integers: how many samples have each value, from the lowest on
    std::vector<float> some;  // for floats: every sample_step()-th sample, if it is finite
};

// Returns a step that has no factor in common with the length of a row, so that all columns take
// part.
std::int64_t sample_step(const Grid& grid);

ValueCounts count_values(const Volume& volume);  // in memory

}  // namespace lamina
