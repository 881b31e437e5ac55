// SPDX-License-Identifier: Apache-2.0
#include "volume/index_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <vector>

#include "base/atomic_file.h"
#include "base/content_hash.h"
#include "base/error.h"

namespace lamina {
namespace {

constexpr const char* magic = "lamina index 1";
constexpr std::size_t piece_bytes = std::size_t{1} << 16;

std::string header_of(const Grid& grid, SampleType type, const VolumeIndex& index) {
    return fmt::format("size {} {} {}\ntype {}\nnon_finite {}\nrange {:a} {:a}\nvalues {} {}\n",
                       grid.size[0], grid.size[1], grid.size[2], name_of(type),
                       index.bricks.non_finite, index.bricks.whole.lo, index.bricks.whole.hi,
                       index.values.codes.size(), index.values.some.size());
}

template <typename Value>
std::size_t bytes_of_all(const std::vector<Value>& values) {
    return values.size() * sizeof(Value);
}

// Calls visit(first byte, bytes) for the pieces of the ranges.
template <typename Bytes, typename Visit>
void for_each_piece(Bytes* data, std::size_t count, const Visit& visit) {
    for (std::size_t at = 0; at < count; at += piece_bytes)
        visit(data + at, std::min(piece_bytes, count - at));
}

bool all_zero(const std::byte* bytes, std::size_t count) {
    return bytes[0] == std::byte{0} && std::memcmp(bytes, bytes + 1, count - 1) == 0;
}

// What stands in the header, as far as it is right.
struct IndexHeader {
    std::string identity;
    std::array<std::int64_t, 3> size{};
    std::string type;
    std::int64_t non_finite = 0;
    double lo = 1, hi = 0;
    std::size_t codes = 0, some = 0;
};

std::optional<IndexHeader> read_header(std::ifstream& stream) {
    std::string line;
    if (!std::getline(stream, line) || line != magic) return {};
    IndexHeader header;
    while (std::getline(stream, line) && line != "end") {
        const std::size_t space = line.find(' ');
        const std::string key = line.substr(0, space);
        const char* const rest = space == std::string::npos ? "" : line.c_str() + space + 1;
        if (key == "identity") header.identity = rest;
        if (key == "type") header.type = rest;
        char* next = nullptr;
        if (key == "size") {
            next = const_cast<char*>(rest);
            for (std::int64_t& number : header.size) number = std::strtoll(next, &next, 10);
        }
        if (key == "non_finite") header.non_finite = std::strtoll(rest, nullptr, 10);
        if (key == "range") {
            header.lo = std::strtod(rest, &next);
            header.hi = std::strtod(next, nullptr);
        }
        if (key == "values") {
            header.codes = std::strtoull(rest, &next, 10);
            header.some = std::strtoull(next, nullptr, 10);
        }
    }
    if (!stream) return {};
    return header;
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

}  // namespace

void write_index_file(const std::filesystem::path& file, const std::string& identity,
                      const Grid& grid, SampleType type, const VolumeIndex& index) {
    AtomicFile output(file);
    const auto put = [&](std::string_view text) { output.write(text.data(), text.size()); };
    put(fmt::format("{}\nidentity {}\n", magic, identity));
    put(header_of(grid, type, index));
    put("end\n");
    ContentHash hash;
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
                           const Grid& grid, SampleType type) {
    std::ifstream stream(file, std::ios::binary);
    const std::optional<IndexHeader> header = read_header(stream);
    if (!header) return {};
    if (header->identity != identity || header->size != grid.size || header->type != name_of(type))
        return {{}, true};
    constexpr std::size_t most_values = std::size_t{1} << 22;  // more than there ever are
    if (header->codes > most_values || header->some > most_values) return {};
    VolumeIndex index{MinMaxBricks::of(grid, type), {}};
    index.bricks.non_finite = header->non_finite;
    index.bricks.whole = {header->lo, header->hi};
    ContentHash hash;
    if (!read_values(stream, header->codes, index.values.codes, hash) ||
        !read_values(stream, header->some, index.values.some, hash) ||
        !read_ranges(stream, index.bricks.ranges, hash))
        return {};
    std::string end(16, ' ');
    if (!stream.read(end.data(), 16) || end != hash.hex()) return {};
    return {std::move(index), false};
}

}  // namespace lamina
