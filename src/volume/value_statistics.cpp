// SPDX-License-Identifier: Apache-2.0
#include "volume/value_statistics.h"

#include <bit>
#include <functional>
#include <memory>

#include <fmt/format.h>
#include "base/error.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

// Maps finite float32 values to 32-bit keys in the same order: sets the sign bit of positive
// numbers, inverts all bits of negative ones. Percentiles come from a radix selection in two
// passes: the first counts all samples by the leading 20 bits of their keys; the second counts
// samples whose leading bits belong to a wanted rank by the last 12 bits.
struct FloatKeys {
    static constexpr std::uint32_t negative = std::uint32_t{1} << 31;
    static constexpr int rest_bits = 12;
    static constexpr std::size_t leading_count = std::size_t{1} << (32 - rest_bits);
    static constexpr std::size_t rest_count = std::size_t{1} << rest_bits;

    static std::uint32_t key(float sample) {
        const auto bits = std::bit_cast<std::uint32_t>(sample);
        return bits < negative ? bits + negative : ~bits;
    }
    static std::size_t leading(float sample) { return key(sample) >> rest_bits; }
    static std::size_t rest(float sample) { return key(sample) % rest_count; }
    static double value(std::size_t leading, std::size_t rest) {
        const auto key = static_cast<std::uint32_t>(leading * rest_count + rest);
        return static_cast<double>(std::bit_cast<float>(key >= negative ? key - negative : ~key));
    }
};

// The entry of a table of counts in which a rank (from 1, ascending) falls; the rank in that entry.
struct RankedKey {
    std::size_t key = 0;
    std::int64_t rank = 0;
};
RankedKey ranked_key(std::span<const std::int64_t> counts, std::int64_t rank) {
    std::size_t key = 0;
    while (counts[key] < rank) rank -= counts[key++];
    return {key, rank};
}
// Sums, in parallel, the counts that count_part(samples, count, counts) makes for pieces of a
// volume's samples. If the volume stays in its files, a piece is a slice.
template <typename CountPart>
Counts count_floats(const Volume& volume, std::size_t counters, const CountPart& count_part) {
    const Grid& grid = volume.grid();
    if (volume.in_memory()) {
        const auto* const samples = static_cast<const float*>(volume.data());
        return count_in_parts(
            grid.sample_count(), counters,
            [&](std::int64_t first, std::int64_t end, std::vector<std::uint32_t>& into) {
                count_part(samples + first, end - first, into);
            });
    }
    Counts total(counters);
    std::mutex adding;
    const std::int64_t layer = grid.size[0] * grid.size[1];
    parallel_for(grid.size[2], 1, [&](std::int64_t z) {
        const auto samples =
            std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(layer));
        volume.store().source().read({{0, 0, z}, {grid.size[0], grid.size[1], 1}}, samples.get());
        std::vector<std::uint32_t> counts(counters);
        count_part(samples.get(), layer, counts);
        const std::scoped_lock lock(adding);
        for (std::size_t i = 0; i < counters; ++i) total[i] += counts[i];
    });
    return total;
}

// Returns the values with these ascending ranks. `leading`: counts of samples by leading bits.
std::vector<double> values_of_ranks(const Volume& volume, std::span<const std::int64_t> leading,
                                    const std::vector<std::int64_t>& ranks) {
    std::vector<RankedKey> wanted;
    for (const std::int64_t rank : ranks) wanted.push_back(ranked_key(leading, rank));
    // The rest is counted only for samples with the leading bits of a wanted value.
    std::vector<std::size_t> keys;
    for (const RankedKey& one : wanted) {
        if (keys.empty() || keys.back() != one.key) keys.push_back(one.key);
    }
    const Counts rests = count_floats(
        volume, keys.size() * FloatKeys::rest_count,
        [&](const float* samples, std::int64_t count, std::vector<std::uint32_t>& into) {
            for (std::int64_t i = 0; i < count; ++i) {
                if (!std::isfinite(samples[i])) continue;
                const auto place = std::ranges::lower_bound(keys, FloatKeys::leading(samples[i]));
                if (place == keys.end() || *place != FloatKeys::leading(samples[i])) continue;
                const auto row = static_cast<std::size_t>(place - keys.begin());
                ++into[row * FloatKeys::rest_count + FloatKeys::rest(samples[i])];
            }
        });
    std::vector<double> values;
    for (const RankedKey& one : wanted) {
        const auto row =
            static_cast<std::size_t>(std::ranges::lower_bound(keys, one.key) - keys.begin());
        const auto part = std::span<const std::int64_t>(rests).subspan(row * FloatKeys::rest_count,
                                                                       FloatKeys::rest_count);
        values.push_back(FloatKeys::value(one.key, ranked_key(part, one.rank).key));
    }
    return values;
}

// Measures samples of 8 or 16 bits. `counts`: samples with each value, from `lowest` on.
ValueStatistics measure_whole(const Counts& counts, int lowest) {
    ValueStatistics found;
    for (const std::int64_t count : counts) found.count += count;
    const auto value_of = [&](std::size_t key) { return static_cast<double>(key) + lowest; };
    for (const int place : ValueStatistics::places)
        found.percentiles.push_back(
            value_of(ranked_key(counts, ValueStatistics::rank(place, found.count)).key));

    const std::size_t lo = ranked_key(counts, 1).key,
                      values = ranked_key(counts, found.count).key - lo + 1;
    constexpr auto most = static_cast<std::size_t>(Histogram::most_intervals);
    const std::size_t width = (values + most - 1) / most;
    found.histogram.counts.resize((values + width - 1) / width);
    for (std::size_t i = 0; i < values; ++i) found.histogram.counts[i / width] += counts[lo + i];
    for (std::size_t i = 0; i <= found.histogram.counts.size(); ++i)
        found.histogram.edges.push_back(value_of(lo + i * width));
    return found;
}

ValueStatistics measure_floats(const Volume& volume, const ValueRange& range) {
    ValueStatistics found;
    if (range.empty()) return found;
    found.histogram = Histogram::of_range(range);
    // Counters of the leading bits come first, then those of the intervals.
    const Counts counts = count_floats(
        volume, FloatKeys::leading_count + found.histogram.counts.size(),
        [&](const float* samples, std::int64_t count, std::vector<std::uint32_t>& into) {
            for (std::int64_t i = 0; i < count; ++i) {
                if (!std::isfinite(samples[i])) continue;
                ++into[FloatKeys::leading(samples[i])];
                const auto value = static_cast<double>(samples[i]);
                ++into[FloatKeys::leading_count + found.histogram.place(value)];
            }
        });
    for (std::size_t i = 0; i < found.histogram.counts.size(); ++i) {
        found.histogram.counts[i] = counts[FloatKeys::leading_count + i];
        found.count += found.histogram.counts[i];
    }
    std::vector<std::int64_t> ranks;
    for (const int place : ValueStatistics::places)
        ranks.push_back(ValueStatistics::rank(place, found.count));
    found.percentiles = values_of_ranks(
        volume, std::span<const std::int64_t>(counts).first(FloatKeys::leading_count), ranks);
    for (double& value : found.percentiles) value += 0.0;  // -0 becomes 0
    return found;
}

}  // namespace

ValueStatistics measure_values(const VolumeData& data) {
    const Volume& volume = data.volume;
    if (volume.type() == SampleType::float32) return measure_floats(volume, data.bricks.whole);
    const int lowest =
        volume.type() == SampleType::int16 ? std::numeric_limits<std::int16_t>::min() : 0;
    return measure_whole(data.values ? data.values->codes : count_values(volume).codes, lowest);
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

namespace {

constexpr int bars_high = 160;

// Draws histogram_picture().
class Chart {
  public:
    Chart(const ValueStatistics& statistics, int width)
        : of_(statistics), image_(width, room + line + bars_high + 2 * line + room, 3, 8) {
        fill_rectangle(image_, 0, 0, image_.width, image_.height, paper);
        draw_text(image_, room, room,
                  fmt::format("{} values, height: logarithm of the count", of_.count), dot, ink);
    }

    CodedImage draw() {
        if (of_.histogram.empty()) return std::move(image_);
        for (std::size_t i = 0; i < of_.histogram.counts.size(); ++i) draw_bar(i);
        fill_rectangle(image_, room, bottom, bars_wide(), 1, ink);
        const std::vector<double>& edges = of_.histogram.edges;
        draw_text(image_, room, bottom + 4, label(edges.front()), dot, ink);
        const std::string last = label(edges.back());
        draw_text(image_, image_.width - room - text_width(last, dot), bottom + 4, last, dot, ink);
        draw_marks();
        return std::move(image_);
    }

  private:
    static constexpr int dot = 2, line = (text_dots_high + 3) * dot, room = 8;  // pixels
    static constexpr int bottom = room + line + bars_high;
    static constexpr PixelColor paper{255, 255, 255}, ink{40, 40, 40}, bar_color{70, 110, 160},
        mark_color{200, 60, 40};

    std::string label(double value) const {
        const std::vector<double>& edges = of_.histogram.edges;
        return number_text(value, fineness_of(edges.front(), edges.back()));
    }
    int bars_wide() const { return image_.width - 2 * room; }
    int column(double value) const {
        const double lo = of_.histogram.edges.front(), hi = of_.histogram.edges.back();
        const double share = lo < hi ? (value / 2 - lo / 2) / (hi / 2 - lo / 2) : 0.5;
        return room + static_cast<int>(share * (bars_wide() - 1));
    }

    void draw_bar(std::size_t i) {
        const std::vector<std::int64_t>& counts = of_.histogram.counts;
        const double most = std::log1p(*std::max_element(counts.begin(), counts.end()));
        const int high = static_cast<int>(
            std::lround(bars_high * std::log1p(static_cast<double>(counts[i])) / most));
        const auto at = [&](std::size_t place) {
            return room +
                   static_cast<int>(place * static_cast<std::size_t>(bars_wide()) / counts.size());
        };
        fill_rectangle(image_, at(i), bottom - high, std::max(1, at(i + 1) - at(i)), high,
                       bar_color);
    }

    void draw_marks() {
        std::string text = "percentiles";
        for (const std::size_t i :
             {std::size_t{0}, of_.percentiles.size() / 2, of_.percentiles.size() - 1}) {
            fill_rectangle(image_, column(of_.percentiles[i]), bottom - bars_high, 1, bars_high + 4,
                           mark_color);
            text += fmt::format(" {:g}%={}", 0.1 * ValueStatistics::places[i],
                                label(of_.percentiles[i]));
        }
        draw_text(image_, room, bottom + line + 2, text, dot, mark_color);
    }

    const ValueStatistics& of_;
    CodedImage image_;
};

}  // namespace

CodedImage histogram_picture(const ValueStatistics& statistics, int width) {
    return Chart(statistics, width).draw();
}

}  // namespace lamina
