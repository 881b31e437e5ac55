// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

using Counts = std::vector<std::int64_t>;

// Sums, in parallel, the counts that count_part(first, end, counts) makes for pieces of 0 ..
// samples - 1. Pieces are large, so that adding is cheap, but small enough for 32-bit counters.
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

// The distribution of a volume's values: exact for integers, by some samples for floats.
struct ValueCounts {
    Counts codes;             // for integers: how many samples have each value, from the lowest on
    std::vector<float> some;  // for floats: every sample_step()-th sample, if it is finite
};

// Returns the step of ValueCounts::some, coprime to a row's length, so that it takes all columns.
std::int64_t sample_step(const Grid& grid);

ValueCounts count_values(const Volume& volume);  // of a volume in memory

// The results of a pass over all samples, kept in a file if the volume stays in its files.
struct VolumeIndex {
    MinMaxBricks bricks;
    ValueCounts values;
};

// Returns the index of a volume that stays in its files. It is read from a file beside these or in
// the user's cache folder, if it fits the present samples. Otherwise a parallel pass over them
// makes it, and it is kept in the cache folder. A warning says what is wrong with an existing file.
VolumeIndex index_of(const Volume& volume);

// Makes an index by a pass over the samples, without looking for index files.
VolumeIndex measure_index(const Volume& volume);

std::filesystem::path index_file_of(const Volume& volume);
void write_index(const Volume& volume, const VolumeIndex& index, const std::filesystem::path& file);

// Writes a volume's index to a file: a line that names the format; a header of one line, in JSON;
// the values' counts or values; the ranges of bricks in pieces, each behind a byte that is 0 if the
// piece is 0 and left out; and a hash of all that follows the first line. Binary numbers are those
// of a little-endian machine. `identity`: SampleSource::identity().
void write_index_file(const std::filesystem::path& file, const std::string& identity,
                      const Grid& grid, SampleType type, const VolumeIndex& index);

// Throws Error if `file` exists and is no index. Like write_index_file(), never follows a link.
void expect_index_or_nothing(const std::filesystem::path& file);

// The result of reading an index file: no index if the file does not exist, is damaged, or is of
// other samples. `wrong` then says what is wrong with an existing file; otherwise it is empty.
struct FoundIndex {
    std::optional<VolumeIndex> index;
    std::string wrong;
};
FoundIndex read_index_file(const std::filesystem::path& file, const std::string& identity,
                           const Grid& grid, SampleType type);

// A volume that is drawn, with its min/max bricks, which are measured once. If the volume stays in
// its files, they come from its index (index_of()).
struct VolumeData {
    explicit VolumeData(Volume opened);

    Volume volume;
    MinMaxBricks bricks;
    std::optional<ValueCounts> values;  // only if the volume stays in its files
};

}  // namespace lamina
