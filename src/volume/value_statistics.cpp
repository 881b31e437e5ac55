// SPDX-License-Identifier: Apache-2.0
#include "volume/value_statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>

#include "base/parallel.h"
#include "volume/code_counts.h"

namespace lamina {
namespace {

// The leading bits of a float32: sign, exponent and 11 bits of the mantissa, so that keys ascend
// with the values.
struct FloatKeys {
    static constexpr int dropped_bits = 12;
    static constexpr std::size_t count = std::size_t{1} << (32 - dropped_bits);
    static constexpr std::uint32_t negative = count / 2;

    static std::size_t key(float sample) {
        const std::uint32_t bits = std::bit_cast<std::uint32_t>(sample) >> dropped_bits;
        return bits < negative ? bits + negative : count - 1 - bits;
    }
    // The value of the key that is nearest to zero.
    static double value(std::size_t key) {
        const auto bits =
            static_cast<std::uint32_t>(key >= negative ? key - negative : count - 1 - key);
        return static_cast<double>(std::bit_cast<float>(bits << dropped_bits));
    }
};

// The key of the value with this rank.
std::size_t key_of_rank(const Counts& counts, std::int64_t rank) {
    std::size_t key = 0;
    for (std::int64_t below = counts[0]; below < rank; below += counts[key]) ++key;
    return key;
}

template <typename T>
ValueStatistics measure_whole(const T* samples, std::int64_t count) {
    const Counts counts = count_codes(samples, count);
    ValueStatistics found;
    found.count = count;
    const auto value_of = [](std::size_t key) {
        return static_cast<double>(key) + std::numeric_limits<T>::min();
    };
    for (const int place : ValueStatistics::places)
        found.percentiles.push_back(
            value_of(key_of_rank(counts, ValueStatistics::rank(place, count))));

    const std::size_t lo = key_of_rank(counts, 1), values = key_of_rank(counts, count) - lo + 1;
    constexpr auto most = static_cast<std::size_t>(Histogram::most_intervals);
    const std::size_t width = (values + most - 1) / most;
    found.histogram.counts.resize((values + width - 1) / width);
    for (std::size_t i = 0; i < values; ++i) found.histogram.counts[i / width] += counts[lo + i];
    for (std::size_t i = 0; i <= found.histogram.counts.size(); ++i)
        found.histogram.edges.push_back(value_of(lo + i * width));
    return found;
}

ValueStatistics measure_floats(const float* samples, std::int64_t count, const ValueRange& range) {
    ValueStatistics found;
    if (range.empty()) return found;
    found.histogram = Histogram::of_range(range);
    // The keys, then the intervals.
    const Counts counts =
        count_in_parts(count, FloatKeys::count + found.histogram.counts.size(),
                       [&](std::int64_t first, std::int64_t end, std::vector<std::uint32_t>& into) {
                           for (std::int64_t i = first; i < end; ++i) {
                               if (!std::isfinite(samples[i])) continue;
                               ++into[FloatKeys::key(samples[i])];
                               const auto value = static_cast<double>(samples[i]);
                               ++into[FloatKeys::count + found.histogram.place(value)];
                           }
                       });
    for (std::size_t i = 0; i < found.histogram.counts.size(); ++i) {
        found.histogram.counts[i] = counts[FloatKeys::count + i];
        found.count += found.histogram.counts[i];
    }
    for (const int place : ValueStatistics::places) {
        const std::size_t key = key_of_rank(counts, ValueStatistics::rank(place, found.count));
        // Adding 0 makes a zero without a sign.
        found.percentiles.push_back(std::clamp(FloatKeys::value(key), range.lo, range.hi) + 0.0);
    }
    return found;
}

}  // namespace

ValueStatistics measure_values(const Volume& volume, const ValueRange& range) {
    const std::int64_t count = volume.grid().sample_count();
    return volume.visit([&](const auto* samples) {
        if constexpr (std::is_same_v<decltype(samples), const float*>)
            return measure_floats(samples, count, range);
        else
            return measure_whole(samples, count);
    });
}

ValueStatistics measure_values(std::span<const double> values) {
    std::vector<double> sorted;
    sorted.reserve(values.size());
    for (const double value : values) {
        if (std::isfinite(value)) sorted.push_back(value);
    }
    ValueStatistics found;
    found.count = static_cast<std::int64_t>(sorted.size());
    if (sorted.empty()) return found;
    parallel_sort(sorted.begin(), sorted.end(), std::less<>());
    for (const int place : ValueStatistics::places) {
        const std::int64_t rank = ValueStatistics::rank(place, found.count);
        found.percentiles.push_back(sorted[static_cast<std::size_t>(rank - 1)]);
    }
    found.histogram = Histogram::of_range({sorted.front(), sorted.back()});
    for (const double value : sorted) ++found.histogram.counts[found.histogram.place(value)];
    return found;
}

}  // namespace lamina
