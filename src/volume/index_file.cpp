// SPDX-License-Identifier: Apache-2.0
#include "volume/index_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/output_file.h"
#include "base/sparse_bytes.h"
#include "base/text.h"

namespace lamina {
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

// Calls visit(first byte, bytes) for the pieces of the ranges.
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

// A line of the header, which is far shorter than this.
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
    constexpr std::size_t most_values = std::size_t{1} << 22;  // more than there ever are
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

}  // namespace lamina
