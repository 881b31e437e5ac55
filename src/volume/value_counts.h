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

// Adds up what `count_part(first, end, counts)` counts in the parts of [0, samples), in parallel. A
// part takes much longer than to add its counts to those of the others, and 32-bit counters can
// count it.
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

// How many samples of 8 or 16 bits have each value that there is, from the lowest on.
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

// Which values a volume has.
struct ValueCounts {
    Counts codes;             // of integers: how many samples have each value, from the lowest on
    std::vector<float> some;  // of floats: every sample_step()-th sample, if it is finite
};

// The step has no factor in common with the length of a row, so that all columns take part.
std::int64_t sample_step(const Grid& grid);

ValueCounts count_values(const Volume& volume);  // in memory

}  // namespace lamina
