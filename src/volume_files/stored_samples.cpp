// SPDX-License-Identifier: Apache-2.0
#include "volume_files/stored_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <set>
#include <type_traits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/enum_words.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "volume/sample_source.h"

namespace lamina {
namespace {

// Calls part(begin, end) for pieces that make up 0 .. count, on all cores.
template <typename Part>
void for_parts(std::int64_t count, const Part& part) {
    constexpr std::int64_t chunk = std::int64_t{1} << 18;  // samples of one task
    parallel_for((count + chunk - 1) / chunk, 1,
                 [&](std::int64_t i) { part(i * chunk, std::min(count, (i + 1) * chunk)); });
}

template <typename Word>
void turn_words(void* memory, std::int64_t count) {
    auto* const words = static_cast<Word*>(memory);
    for (std::int64_t i = 0; i < count; ++i) {
        if constexpr (sizeof(Word) == 2)
            words[i] = __builtin_bswap16(words[i]);
        else if constexpr (sizeof(Word) == 4)
            words[i] = __builtin_bswap32(words[i]);
        else
            words[i] = __builtin_bswap64(words[i]);
    }
}

template <typename T>
struct Range {
    T lo, hi;
};

template <typename From>
Range<From> range_of(const From* from, std::int64_t count) {
    Range<From> all{from[0], from[0]};
    std::mutex merging;
    for_parts(count, [&](std::int64_t begin, std::int64_t end) {
        const auto [lo, hi] = std::minmax_element(from + begin, from + end);
        const std::lock_guard lock(merging);
        all = {std::min(all.lo, *lo), std::max(all.hi, *hi)};
    });
    return all;
}

template <typename T>
bool is_within(T value, int least, int most) {
    if constexpr (std::is_integral_v<T>)
        return std::cmp_greater_equal(value, least) && std::cmp_less_equal(value, most);
    else
        return value >= static_cast<T>(least) && value <= static_cast<T>(most);
}

// Returns the first of uint8, int16 and uint16 that holds lo to hi; float32 if none does.
template <typename T>
SampleType type_for(T lo, T hi) {
    const auto both = [&](int least, int most) {
        return is_within(lo, least, most) && is_within(hi, least, most);
    };
    if (both(0, 255)) return SampleType::uint8;
    if (both(-32768, 32767)) return SampleType::int16;
    return both(0, 65535) ? SampleType::uint16 : SampleType::float32;
}

// Counts of samples that float32 does not hold exactly, and the largest error of finite ones.
struct Rounded {
    std::int64_t inexact = 0, infinite = 0;
    double largest_error = 0;
};

template <typename From>
bool holds_exactly(float to, From from) {
    if constexpr (std::is_integral_v<From>) {
        // A float beyond the range of From, such as 2^63, would overflow when it is converted back.
        const auto above = std::ldexp(1.0F, std::numeric_limits<From>::digits);
        return to < above && static_cast<From>(to) == from;
    } else {
        return static_cast<From>(to) == from || std::isnan(from);
    }
}

template <typename From>
Rounded round_samples(const From* from, std::int64_t count, float* to) {
    Rounded all;
    std::mutex merging;
    for_parts(count, [&](std::int64_t begin, std::int64_t end) {
        Rounded part;
        for (std::int64_t i = begin; i < end; ++i) {
            to[i] = static_cast<float>(from[i]);
            if (holds_exactly(to[i], from[i])) continue;
            if (std::isinf(to[i])) {
                ++part.infinite;
                continue;
            }
            ++part.inexact;
            const long double error =
                static_cast<long double>(to[i]) - static_cast<long double>(from[i]);
            part.largest_error = std::max(part.largest_error, static_cast<double>(std::abs(error)));
        }
        const std::lock_guard lock(merging);
        all.inexact += part.inexact;
        all.infinite += part.infinite;
        all.largest_error = std::max(all.largest_error, part.largest_error);
    });
    return all;
}

void warn_of(const Rounded& rounded, const StoredSamples& samples, std::int64_t count) {
    const char* const type = name_of(samples.type);
    if (rounded.inexact > 0) {
        const char* const hint = is_integer(samples.type)
                                     ? ": \"lookup\": \"nearest\" in the volume keeps labels apart"
                                     : "";
        say("{}: {} of {} {} samples are rounded to float, by up to {:.3g}{}", samples.file,
            rounded.inexact, count, type, rounded.largest_error, hint);
    }
    if (rounded.infinite > 0) {
        say("{}: {} of {} {} samples are beyond float, and infinite", samples.file,
            rounded.infinite, count, type);
    }
}

// Makes `count` samples of a type; make(i) gives the value of sample i.
template <typename Make>
std::shared_ptr<const void> filled(SampleType type, std::int64_t count, const Make& make) {
    const std::shared_ptr<void> memory =
        filled_memory(static_cast<std::size_t>(count) * bytes_of(type));
    with_sample_type(type, [&](auto zero) {
        using To = decltype(zero);
        auto* const to = static_cast<To*>(memory.get());
        for_parts(count, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) to[i] = static_cast<To>(make(i));
        });
    });
    return memory;
}

// Tells if samples are labels: by what is asked for or what the file says, else by measure.
bool are_labels(const Grid& grid, const StoredSamples& samples,
                const std::optional<VolumeLookup>& lookup) {
    if (lookup) return *lookup == VolumeLookup::nearest;
    if (grid.lookup == VolumeLookup::nearest) return true;
    return taken_by_signs(samples.file, label_signs(grid.size, samples.type, samples.bytes.get()));
}

// Returns the values of labels in increasing order; nothing if they are too many or not all whole.
template <typename From>
std::optional<std::vector<From>> label_values(const From* from, std::int64_t count) {
    std::set<From> all;
    bool good = true;
    std::mutex merging;
    for_parts(count, [&](std::int64_t begin, std::int64_t end) {
        std::unordered_set<From> part;
        bool whole = true;
        for (std::int64_t i = begin; i < end && part.size() <= most_label_codes; ++i) {
            if (i > begin && from[i] == from[i - 1]) continue;
            part.insert(from[i]);
            whole &= is_whole_label(from[i]);
        }
        const std::lock_guard lock(merging);
        if (good && whole) all.insert(part.begin(), part.end());
        good = good && whole && all.size() <= most_label_codes;
    });
    if (!good) return {};
    return std::vector<From>(all.begin(), all.end());
}

template <typename From>
std::shared_ptr<const VolumeLabels> table_of_labels(const std::vector<From>& values) {
    VolumeLabels labels{.renumbered = true, .list = {}};
    using Whole = std::conditional_t<std::is_integral_v<From>, From, std::int64_t>;
    for (const From value : values) {
        labels.list.push_back(
            {static_cast<double>(labels.list.size()), std::to_string(static_cast<Whole>(value))});
    }
    return std::make_shared<const VolumeLabels>(std::move(labels));
}

// Returns the volume of labels, whose samples are the file's numbers if 16 bits hold them, else
// their places in increasing order. Returns nothing if they are too many or not whole.
template <typename From>
std::optional<Volume> labelled(Grid grid, const StoredSamples& samples) {
    const auto* const from = static_cast<const From*>(samples.bytes.get());
    const std::int64_t count = grid.sample_count();
    const auto values = label_values(from, count);
    if (!values) return {};
    grid.lookup = VolumeLookup::nearest;
    const SampleType type = type_for(values->front(), values->back());
    if (type != SampleType::float32)
        return Volume(grid, type, filled(type, count, [&](auto i) { return from[i]; }));
    const auto labels = table_of_labels(*values);
    say("{}: its {} labels, from {} to {}, are numbered 0 to {} in increasing order: "
        "lamina info lists them, and a given transfer function means those of the "
        "file",
        samples.file, values->size(), labels->list.front().number, labels->list.back().number,
        values->size() - 1);
    const SampleType codes = values->size() <= 256 ? SampleType::uint8 : SampleType::uint16;
    const auto code = [&](auto i) {
        return std::ranges::lower_bound(*values, from[i]) - values->begin();
    };
    return Volume(grid, codes, filled(codes, count, code)).labelled(labels);
}

// Warns if the file, and not the user, says that samples are labels that are no whole numbers.
void warn_of_no_labels(const Grid& grid, const StoredSamples& samples,
                       const std::optional<VolumeLookup>& lookup) {
    if (lookup || grid.lookup != VolumeLookup::nearest) return;
    say("{}: its samples are labels, but{} no whole numbers, so that no label has a "
        "colour of its own",
        samples.file,
        samples.is_plain()
            ? ""
            : fmt::format(", scaled by {} and shifted by {},", samples.scale, samples.offset));
}

template <typename From>
Volume narrowed(const Grid& grid, const StoredSamples& samples,
                const std::optional<VolumeLookup>& lookup) {
    const auto* const from = static_cast<const From*>(samples.bytes.get());
    const std::int64_t count = grid.sample_count();
    if constexpr (std::is_integral_v<From>) {
        const Range<From> range = range_of(from, count);
        const SampleType type =
            std::is_same_v<From, std::int8_t> ? SampleType::int16 : type_for(range.lo, range.hi);
        if (type != SampleType::float32)
            return Volume(grid, type, filled(type, count, [&](auto i) { return from[i]; }));
    }
    Grid voxels = grid;
    if (are_labels(grid, samples, lookup)) {
        if (auto volume = labelled<From>(grid, samples)) return *volume;
        voxels.lookup = VolumeLookup::nearest;
        if (std::is_integral_v<From>)
            say("{}: more than {} labels, which are drawn as numbers of type float", samples.file,
                most_label_codes);
        else
            warn_of_no_labels(grid, samples, lookup);
    }
    if (std::is_same_v<From, float>) return Volume(voxels, SampleType::float32, samples.bytes);
    const std::shared_ptr<void> memory =
        filled_memory(static_cast<std::size_t>(count) * sizeof(float));
    warn_of(round_samples(from, count, static_cast<float*>(memory.get())), samples, count);
    return Volume(voxels, SampleType::float32, memory);
}

template <typename From>
double scaled_value(const StoredSamples& samples, std::int64_t i) {
    const auto* const from = static_cast<const From*>(samples.bytes.get());
    return samples.scale * static_cast<double>(from[i]) + samples.offset;
}

// Returns how far a scaled value may be from the whole number that it stands for. Programs that
// scale floats to integers round by up to half a step: a small one proves that labels were meant.
// Headers round scale and offset to float.
double label_tolerance(const StoredSamples& samples, double value) {
    constexpr double largest_step = .1, relative = 1e-6, largest = .25;
    const double step = std::abs(samples.scale);
    const double rounded = is_integer(samples.type) && step <= largest_step ? step / 2 : 0;
    return std::min(largest, rounded + relative * (1 + std::abs(samples.offset) + std::abs(value)));
}

// Returns the volume of labels whose numbers are the scaled values; nothing if these are not whole.
template <typename From>
std::optional<Volume> scaled_labels(const Grid& grid, const StoredSamples& samples) {
    const std::int64_t count = grid.sample_count();
    StoredSamples numbers{samples.file, ValueType::float64,
                          filled_memory(static_cast<std::size_t>(count) * sizeof(double))};
    auto* const to = static_cast<double*>(numbers.bytes.get());
    double farthest = 0;
    bool whole = true;
    std::mutex merging;
    for_parts(count, [&](std::int64_t begin, std::int64_t end) {
        double far = 0;
        bool good = true;
        for (std::int64_t i = begin; i < end; ++i) {
            const double value = scaled_value<From>(samples, i);
            to[i] = std::round(value);
            const double distance = std::abs(value - to[i]);
            good = good && distance <= label_tolerance(samples, value);
            far = std::max(far, distance);
        }
        const std::lock_guard lock(merging);
        whole = whole && good;
        farthest = std::max(farthest, far);
    });
    if (!whole) return {};
    if (farthest > 0) {
        say("{}: its labels, scaled by {} and shifted by {}, are the nearest whole "
            "numbers, up to {:.2g} away",
            samples.file, samples.scale, samples.offset, farthest);
    }
    return labelled<double>(grid, numbers);
}

template <typename From>
Volume scaled(const Grid& grid, const StoredSamples& samples,
              const std::optional<VolumeLookup>& lookup) {
    if (lookup.value_or(grid.lookup) == VolumeLookup::nearest) {
        if (auto volume = scaled_labels<From>(grid, samples)) return *volume;
        warn_of_no_labels(grid, samples, lookup);
    }
    const double scale = samples.scale, offset = samples.offset;
    SampleType type = SampleType::float32;
    if (std::is_integral_v<From> && scale == std::trunc(scale) && offset == std::trunc(offset)) {
        const auto* const from = static_cast<const From*>(samples.bytes.get());
        const Range<From> range = range_of(from, grid.sample_count());
        const double ends[] = {scale * static_cast<double>(range.lo) + offset,
                               scale * static_cast<double>(range.hi) + offset};
        type = type_for(std::min(ends[0], ends[1]), std::max(ends[0], ends[1]));
    }
    const auto value = [&](std::int64_t i) { return scaled_value<From>(samples, i); };
    return Volume(grid, type, filled(type, grid.sample_count(), value));
}

}  // namespace

float widened_half(std::uint16_t half) {
    constexpr int fraction_bits = 10, bias = 15, special = 31;
    const int exponent = half >> fraction_bits & special, fraction = half & 1023;
    const int least = 1 - bias - fraction_bits;  // exponent of the smallest number's only bit
    float value = exponent == 0
                      ? std::ldexp(static_cast<float>(fraction), least)
                      : std::ldexp(static_cast<float>(1024 + fraction), exponent - 1 + least);
    if (exponent == special)
        value = fraction == 0 ? std::numeric_limits<float>::infinity()
                              : std::numeric_limits<float>::quiet_NaN();
    return (half >> 15) != 0 ? -value : value;
}

StoredSamples widened_halves(const StoredSamples& halves, std::int64_t count) {
    StoredSamples floats = halves;
    floats.type = ValueType::float32;
    floats.bytes = filled_memory(static_cast<std::size_t>(count) * sizeof(float));
    const auto* const from = static_cast<const std::uint16_t*>(halves.bytes.get());
    auto* const to = static_cast<float*>(floats.bytes.get());
    std::vector<float> values(1 << 16);  // of all halves
    for (std::size_t half = 0; half < values.size(); ++half)
        values[half] = widened_half(static_cast<std::uint16_t>(half));
    for_parts(count, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) to[i] = values[from[i]];
    });
    return floats;
}

void swap_bytes(void* words, std::int64_t count, std::size_t word_bytes) {
    if (word_bytes == 1) return;
    for_parts(count, [&](std::int64_t begin, std::int64_t end) {
        swap_bytes_alone(static_cast<char*>(words) + static_cast<std::size_t>(begin) * word_bytes,
                         end - begin, word_bytes);
    });
}

void swap_bytes_alone(void* words, std::int64_t count, std::size_t word_bytes) {
    if (word_bytes == 2) turn_words<std::uint16_t>(words, count);
    if (word_bytes == 4) turn_words<std::uint32_t>(words, count);
    if (word_bytes == 8) turn_words<std::uint64_t>(words, count);
}

std::optional<ValueType> number_type(std::size_t bytes, bool integers, bool has_sign) {
    for (const ValueType type : value_types) {
        const bool is_signed = name_of(type)[0] != 'u';
        if (bytes_of(type) == bytes && is_integer(type) == integers && is_signed == has_sign)
            return type;
    }
    return {};
}

std::optional<SampleType> drawn_type(ValueType type) {
    return value_of_word<SampleType>(name_of(type));
}

bool taken_by_signs(const std::string& file, const LabelSigns& signs) {
    using Verdict = LabelSigns::Verdict;
    if (signs.verdict == Verdict::none) return false;
    double share = 100 * signs.equal;
    if (signs.verdict == Verdict::scattered && share > 94.9) share = 94.9;  // is fewer than 95
    const std::string equal = fmt::format("{:.3g} % of them equal their six neighbours", share);
    if (signs.are_labels()) {
        say("{}: its samples are taken for labels, as {}; \"lookup\": \"linear\" in "
            "the volume (--set volume.lookup=linear) would interpolate between them",
            file, equal);
        return true;
    }
    const std::string but =
        signs.verdict == Verdict::scattered
            ? fmt::format("but only {}, fewer than 95 %", equal)
            : fmt::format(
                  "as {}, but {:.3g} % of unequal neighbours differ by 1, as in a smooth "
                  "field that was rounded",
                  equal, 100 * signs.by_one);
    say("{}: its samples look like labels, {}: they are taken for a field, which mixes "
        "labels where they meet; \"lookup\": \"nearest\" in the volume (--set "
        "volume.lookup=nearest) takes them for labels",
        file, but);
    return false;
}

Volume drawn_volume(const Grid& grid, const StoredSamples& samples,
                    const std::optional<VolumeLookup>& lookup) {
    const bool plain = samples.is_plain();
    const auto type = drawn_type(samples.type);
    if (plain && type && *type != SampleType::float32) return Volume(grid, *type, samples.bytes);
    return with_type(samples.type, [&](auto zero) {
        using From = decltype(zero);
        return plain ? narrowed<From>(grid, samples, lookup) : scaled<From>(grid, samples, lookup);
    });
}

}  // namespace lamina
