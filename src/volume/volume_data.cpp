// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_data.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <type_traits>
#include <utility>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/output_file.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

// Max size of ValueCounts::some: 210 samples then make a share of 1e-4, known to 7 % (1/sqrt(210)).
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

namespace {

using Triple = std::array<std::int64_t, 3>;

constexpr std::int64_t brick_edge = MinMaxBricks::edge;

// Most bytes of a block's samples, which a thread holds in memory.
constexpr std::int64_t block_bytes = std::int64_t{1} << 23;

std::int64_t up_to_multiple(std::int64_t number, std::int64_t of) {
    return (number + of - 1) / of * of;
}

// Returns the bricks in a block along each axis: if the source has blocks, about one of these, but
// 32 cells or more along each axis; else whole rows of the volume, about block_bytes in all.
Triple block_of(const Volume& volume, const MinMaxBricks& bricks) {
    const Triple own = volume.store().source().block();
    Triple block{bricks.count[0], 8, 8};
    if (own[0] > 0) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            block[axis] =
                up_to_multiple(std::max<std::int64_t>(own[axis], 32), brick_edge) / brick_edge;
    } else {
        const std::int64_t row =
            volume.grid().size[0] * static_cast<std::int64_t>(bytes_of(volume.type()));
        block[1] = std::max<std::int64_t>(1, block_bytes / (row * 33 * brick_edge));
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        block[axis] = std::min(block[axis], bricks.count[axis]);
    return block;
}

// Makes the index of a volume that stays in its files, block by block on all cores. A block that is
// known to be 0 is not read. Any other is read once, for the ranges of its bricks and the counts of
// its samples; samples on a border between blocks are counted with the next block.
template <typename T>
class IndexMaker {
  public:
    explicit IndexMaker(const Volume& volume)
        : grid_(volume.grid()),
          source_(volume.store().source()),
          step_(sample_step(grid_)),
          codes_(std::is_integral_v<T> ? std::size_t{1} << (8 * sizeof(T)) : 0) {
        index_.bricks = MinMaxBricks::of(grid_, volume.type());
        block_ = block_of(volume, index_.bricks);
        for (std::size_t axis = 0; axis < 3; ++axis)
            blocks_[axis] = (index_.bricks.count[axis] + block_[axis] - 1) / block_[axis];
    }

    VolumeIndex make() {
        const std::int64_t count = blocks_[0] * blocks_[1] * blocks_[2];
        Progress progress("indexing the volume", count);
        parallel_for(count, 1, [&](std::int64_t number) {
            measure({number % blocks_[0] * block_[0], number / blocks_[0] % blocks_[1] * block_[1],
                     number / (blocks_[0] * blocks_[1]) * block_[2]});
            progress.advance();
        });
        std::ranges::sort(index_.values.some);
        index_.values.codes = std::move(codes_);
        return std::move(index_);
    }

  private:
    void measure(const Triple& first) {
        SampleWindow<T> window;
        Triple count{}, owned{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            count[axis] = std::min(block_[axis], index_.bricks.count[axis] - first[axis]);
            const std::int64_t begin = first[axis] * brick_edge, size = grid_.size[axis];
            const bool last = first[axis] + count[axis] == index_.bricks.count[axis];
            window.box.first[axis] = begin;
            window.box.size[axis] = std::min(size - begin, count[axis] * brick_edge + 1);
            owned[axis] = last ? size - begin : count[axis] * brick_edge;
        }
        Found found;
        if (source_.known_as_zero(window.box)) {
            found.zeros = owned[0] * owned[1] * owned[2];
            found.extent.whole = {0, 0};
        } else {
            const auto samples =
                std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(window.box.count()));
            source_.read(window.box, samples.get());
            window.samples = samples.get();
            found.extent =
                measure_block(grid_, window.box, samples.get(), first, count, index_.bricks);
            count_owned(window, owned, found);
        }
        add_sampled_zeros(window.box, owned, found);
        take(found);
    }

    // The results of one block. `zeros`: number of its samples if it is known to be 0; else 0.
    struct Found {
        BlockExtent extent;
        std::vector<std::uint32_t> codes;
        std::vector<float> some;
        std::int64_t zeros = 0;
    };

    // Counts the first `owned` samples of a block along each axis; the next block counts the rest.
    void count_owned(const SampleWindow<T>& window, const Triple& owned, Found& found) const {
        const Triple& first = window.box.first;
        found.codes.resize(codes_.size());
        for (std::int64_t z = first[2]; z < first[2] + owned[2]; ++z) {
            for (std::int64_t y = first[1]; y < first[1] + owned[1]; ++y) {
                const T* const row = window.row(y, z);
                if constexpr (std::is_integral_v<T>) {
                    constexpr int lowest = std::numeric_limits<T>::min();
                    for (std::int64_t x = 0; x < owned[0]; ++x)
                        ++found.codes[static_cast<std::size_t>(int{row[x]} - lowest)];
                } else {
                    for (std::int64_t x = first_sampled(first[0], y, z); x < owned[0]; x += step_)
                        if (std::isfinite(row[x])) found.some.push_back(row[x]);
                }
            }
        }
    }

    // Returns how many samples after (x, y, z), 0 or more, ValueCounts::some takes the next one.
    std::int64_t first_sampled(std::int64_t x, std::int64_t y, std::int64_t z) const {
        const std::int64_t number = (z * grid_.size[1] + y) * grid_.size[0] + x;
        return up_to_multiple(number, step_) - number;
    }

    // Adds the samples that ValueCounts::some takes of a block that is known to be 0.
    void add_sampled_zeros(const SampleBox& box, const Triple& owned, Found& found) const {
        if (std::is_integral_v<T> || found.zeros == 0) return;
        for (std::int64_t z = box.first[2]; z < box.first[2] + owned[2]; ++z) {
            for (std::int64_t y = box.first[1]; y < box.first[1] + owned[1]; ++y)
                for (std::int64_t x = first_sampled(box.first[0], y, z); x < owned[0]; x += step_)
                    found.some.push_back(0);
        }
    }

    void take(const Found& found) {
        const std::scoped_lock lock(taking_);
        MinMaxBricks& bricks = index_.bricks;
        bricks.non_finite += found.extent.non_finite;
        bricks.whole = joined(bricks.whole, found.extent.whole);
        for (std::size_t i = 0; i < found.codes.size(); ++i) codes_[i] += found.codes[i];
        if constexpr (std::is_integral_v<T>)
            codes_[static_cast<std::size_t>(-int{std::numeric_limits<T>::min()})] += found.zeros;
        index_.values.some.insert(index_.values.some.end(), found.some.begin(), found.some.end());
    }

    const Grid& grid_;
    const SampleSource& source_;
    std::int64_t step_;
    Triple block_{}, blocks_{};  // bricks in a block and blocks in the volume, along each axis
    std::mutex taking_;
    VolumeIndex index_;
    Counts codes_;
};

// Returns the index file in the user's cache folder; empty if there is no such folder.
std::filesystem::path cached_index(const Volume& volume) {
    std::filesystem::path folder;
    if (const char* const cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != 0)
        folder = cache;
    else if (const char* const home = std::getenv("HOME"); home != nullptr && *home != 0)
        folder = std::filesystem::path(home) / ".cache";
    else
        return {};
    ContentHash hash;
    hash.add(volume.store().source().name());
    return folder / "lamina" / (hash.hex() + ".lamina-index");
}

// Writes an index to a file. Only warns if that fails, because the picture does not need the file.
void keep(const Volume& volume, const VolumeIndex& index, const std::filesystem::path& file) {
    if (file.empty()) return;
    try {
        make_folder(file.parent_path());
        write_index(volume, index, file);
    } catch (const Error& error) {
        say("the index is not kept: {}", error.what());
    }
}

}  // namespace

VolumeIndex measure_index(const Volume& volume) {
    VolumeIndex index = with_sample_type(
        volume.type(), [&](auto zero) { return IndexMaker<decltype(zero)>(volume).make(); });
    volume.store().source().check_unchanged();
    return index;
}

std::filesystem::path index_file_of(const Volume& volume) {
    return volume.store().source().main_file().string() + ".lamina-index";
}

void write_index(const Volume& volume, const VolumeIndex& index,
                 const std::filesystem::path& file) {
    write_index_file(file, volume.store().source().identity(), volume.grid(), volume.type(), index);
}

VolumeIndex index_of(const Volume& volume) {
    const std::string identity = volume.store().source().identity();
    const std::filesystem::path cached = cached_index(volume);
    expect_allowed(index_file_of(volume));
    for (const std::filesystem::path& file : {index_file_of(volume), cached}) {
        FoundIndex found = read_index_file(file, identity, volume.grid(), volume.type());
        if (found.index) return std::move(*found.index);
        if (!found.wrong.empty()) say("{}: {}, and is made again", file.string(), found.wrong);
    }
    VolumeIndex index = measure_index(volume);
    keep(volume, index, cached);
    return index;
}

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* magic = "lamina index 1";
constexpr std::size_t piece_bytes = std::size_t{1} << 16;

Json header_of(const std::string& identity, const Grid& grid, SampleType type,
               const VolumeIndex& index) {
    const MinMaxBricks& bricks = index.bricks;
    return {{"identity", printable(identity)},  // a name need not be UTF-8
            {"size", grid.size},
            {"type", name_of(type)},
            {"non_finite", bricks.non_finite},
            {"range", {bricks.whole.lo, bricks.whole.hi}},
            {"codes", index.values.codes.size()},
            {"some", index.values.some.size()}};
}

template <typename Value>
std::size_t bytes_of_all(const std::vector<Value>& values) {
    return values.size() * sizeof(Value);
}

// Calls visit(first byte, number of bytes) for each piece of the ranges.
template <typename Bytes, typename Visit>
void for_each_piece(Bytes* data, std::size_t count, const Visit& visit) {
    for (std::size_t at = 0; at < count; at += piece_bytes)
        visit(data + at, std::min(piece_bytes, count - at));
}

template <typename Value>
bool read_values(std::ifstream& stream, std::size_t count, std::vector<Value>& values,
                 ContentHash& hash) {
    values.resize(count);
    const std::size_t bytes = bytes_of_all(values);
    if (!stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(bytes)))
        return false;
    hash.add(values.data(), bytes);
    return true;
}

bool read_ranges(std::ifstream& stream, BrickRanges& ranges, ContentHash& hash) {
    bool good = true;
    for_each_piece(ranges.data(), ranges.byte_count(), [&](std::byte* at, std::size_t count) {
        const int filled = good ? stream.get() : 0;
        good = good && (filled == 0 || filled == 1);
        if (!good || filled == 0) return;
        good = static_cast<bool>(
            stream.read(reinterpret_cast<char*>(at), static_cast<std::streamsize>(count)));
        hash.add(at, count);
    });
    return good;
}

bool begins_as_index(const std::filesystem::path& file) {
    const OwnFilesScope own;
    const std::string first_line = std::string(magic) + "\n";
    return file_beginning(file, first_line.size()) == first_line;
}

void expect_no_link(const std::filesystem::path& file) {
    std::error_code absent;
    if (!std::filesystem::is_symlink(file, absent)) return;
    throw WriteError(
        fmt::format("{}: cannot write: found a link, which is not followed", file.string()));
}

// Reads a line of the header. Real ones are far shorter than the limit.
bool read_line(std::ifstream& stream, std::string& line) {
    constexpr std::size_t most = std::size_t{1} << 16;
    line.clear();
    for (int byte = stream.get(); byte != '\n'; byte = stream.get()) {
        if (byte == std::ifstream::traits_type::eof() || line.size() == most) return false;
        line.push_back(static_cast<char>(byte));
    }
    return true;
}

FoundIndex damaged() {
    return {{}, "the index is damaged"};
}

}  // namespace

void expect_index_or_nothing(const std::filesystem::path& file) {
    std::error_code absent;
    const auto status = std::filesystem::symlink_status(file, absent);
    if (!std::filesystem::exists(status)) return;
    expect_no_link(file);
    if (begins_as_index(file)) return;
    throw WriteError(fmt::format(
        "{}: cannot write: found another file, expected an index that lamina wrote, or nothing",
        file.string()));
}

void write_index_file(const std::filesystem::path& file, const std::string& identity,
                      const Grid& grid, SampleType type, const VolumeIndex& index) {
    expect_no_link(file);
    AtomicFile output(file);
    const auto put = [&](std::string_view text) { output.write(text.data(), text.size()); };
    const std::string header = header_of(identity, grid, type, index).dump();
    put(fmt::format("{}\n{}\n", magic, header));
    ContentHash hash;
    hash.add(header);
    const auto put_values = [&](const auto& values) {
        output.write(values.data(), bytes_of_all(values));
        hash.add(values.data(), bytes_of_all(values));
    };
    put_values(index.values.codes);
    put_values(index.values.some);
    const BrickRanges& ranges = index.bricks.ranges;
    for_each_piece(ranges.data(), ranges.byte_count(), [&](const std::byte* at, std::size_t count) {
        const bool filled = !all_zero(at, count);
        put(std::string_view(filled ? "\1" : "\0", 1));
        if (!filled) return;
        output.write(at, count);
        hash.add(at, count);
    });
    put(hash.hex());
    output.commit();
}

FoundIndex read_index_file(const std::filesystem::path& file, const std::string& identity,
                           const Grid& grid, SampleType type) try {
    std::error_code absent;
    const auto status = std::filesystem::status(file, absent);
    if (!std::filesystem::exists(status)) return {};
    // Opening a pipe may never end, and a device need not have an end.
    if (!std::filesystem::is_regular_file(status)) return {{}, "the index is not a regular file"};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return {{}, "the index cannot be read"};
    std::string line, text;
    if (!read_line(stream, line) || line != magic || !read_line(stream, text)) return damaged();
    const Json header = Json::parse(text);
    if (header.at("identity") != printable(identity) || header.at("size") != Json(grid.size) ||
        header.at("type") != name_of(type))
        return {{}, "the index is of other samples"};
    constexpr std::size_t most_values = std::size_t{1} << 22;  // far more than an index ever has
    const std::size_t codes = header.at("codes"), some = header.at("some");
    if (codes > most_values || some > most_values) return damaged();
    VolumeIndex index{MinMaxBricks::of(grid, type), {}};
    index.bricks.non_finite = header.at("non_finite");
    index.bricks.whole = {header.at("range").at(0), header.at("range").at(1)};
    ContentHash hash;
    hash.add(text);
    if (!read_values(stream, codes, index.values.codes, hash) ||
        !read_values(stream, some, index.values.some, hash) ||
        !read_ranges(stream, index.bricks.ranges, hash))
        return damaged();
    std::string end(16, ' ');
    if (!stream.read(end.data(), 16) || end != hash.hex()) return damaged();
    return {std::move(index), {}};
} catch (const Json::exception&) {
    return damaged();  // its header
}

VolumeData::VolumeData(Volume opened) : volume(std::move(opened)) {
    if (volume.in_memory()) {
        bricks = measure_bricks(volume);
        return;
    }
    VolumeIndex index = index_of(volume);
    bricks = std::move(index.bricks);
    values = std::move(index.values);
}

}  // namespace lamina
