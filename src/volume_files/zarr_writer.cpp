// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2").
#include "volume_files/zarr_writer.h"

#include <blosc.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/parallel.h"
#include "base/sparse_bytes.h"
#include "volume_files/chunk_hashes.h"

namespace lamina {
namespace {

constexpr int level = 5;  // Blosc's own default

void write_small_file(const std::filesystem::path& path, const void* bytes, std::size_t count) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    bool written = file != nullptr && std::fwrite(bytes, 1, count, file) == count;
    // Some file systems say only now that the disk is full.
    if (file != nullptr) written &= std::fclose(file) == 0;
    if (!written) fail("{}: cannot write: {}", path.string(), std::strerror(errno));
}

void write_json_file(const std::filesystem::path& path, const nlohmann::json& json) {
    const std::string text = json_text(json, 2) + "\n";
    write_small_file(path, text.data(), text.size());
}

std::string type_text(ValueType type) {
    const char kind = !is_integer(type) ? 'f' : name_of(type)[0] == 'u' ? 'u' : 'i';
    const bool little = std::endian::native == std::endian::little;
    const char order = bytes_of(type) == 1 ? '|' : little ? '<' : '>';
    return fmt::format("{}{}{}", order, kind, bytes_of(type));
}

}  // namespace

ZarrWriter::ZarrWriter(std::filesystem::path folder, const std::array<std::int64_t, 3>& size,
                       const std::array<std::int64_t, 3>& edge, ValueType type,
                       const nlohmann::json& attributes)
    : folder_(std::move(folder)), size_(size), edge_(edge), bytes_(bytes_of(type)) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        counts_[axis] = (size_[axis] + edge_[axis] - 1) / edge_[axis];
    hashes_.assign(static_cast<std::size_t>(chunk_count()), no_chunk);
    const nlohmann::json compressor{{"id", "blosc"},
                                    {"cname", "lz4"},
                                    {"clevel", level},
                                    {"shuffle", BLOSC_SHUFFLE},
                                    {"blocksize", 0}};
    write_json_file(folder_ / ".zarray", {{"zarr_format", 2},
                                          {"shape", {size_[2], size_[1], size_[0]}},
                                          {"chunks", {edge_[2], edge_[1], edge_[0]}},
                                          {"dtype", type_text(type)},
                                          {"order", "C"},
                                          {"fill_value", 0},
                                          {"compressor", compressor},
                                          {"filters", nullptr},
                                          {"dimension_separator", "/"}});
    write_json_file(folder_ / ".zattrs", attributes);
}

std::int64_t ZarrWriter::slices_of(std::int64_t layer) const {
    return std::min(edge_[2], size_[2] - layer * edge_[2]);
}

void ZarrWriter::write_layer(const void* samples) {
    for (std::int64_t y = 0; y < counts_[1]; ++y)
        make_folder(folder_ / fmt::format("{}/{}", next_, y));
    std::atomic<std::uint64_t> written{0};
    parallel_for(counts_[0] * counts_[1], 1, [&](std::int64_t number) {
        written += write_chunk(number % counts_[0], number / counts_[0],
                               static_cast<const char*>(samples));
    });
    bytes_written_ += written;
    ++next_;
}

void ZarrWriter::finish() const {
    write_chunk_hashes(folder_, hashes_);
}

// Beyond the array's border a chunk has zeros. Returns the bytes of its file.
std::uint64_t ZarrWriter::write_chunk(std::int64_t x, std::int64_t y, const char* layer) {
    const std::size_t row = static_cast<std::size_t>(edge_[0]) * bytes_;
    ByteBuffer chunk(row * static_cast<std::size_t>(edge_[1] * edge_[2]));
    std::memset(chunk.data(), 0, chunk.size());
    const std::int64_t first_x = x * edge_[0], first_y = y * edge_[1];
    const std::size_t copied =
        static_cast<std::size_t>(std::min(edge_[0], size_[0] - first_x)) * bytes_;
    const std::int64_t rows = std::min(edge_[1], size_[1] - first_y);
    for (std::int64_t k = 0; k < slices_of(next_); ++k) {
        for (std::int64_t j = 0; j < rows; ++j) {
            const std::int64_t from = (k * size_[1] + first_y + j) * size_[0] + first_x;
            std::memcpy(chunk.data() + static_cast<std::size_t>(k * edge_[1] + j) * row,
                        layer + static_cast<std::size_t>(from) * bytes_, copied);
        }
    }
    const bool first = x == 0 && y == 0 && next_ == 0;  // an array without any is no array
    if (!first && all_zero(chunk.data(), chunk.size())) return 0;
    ByteBuffer packed(chunk.size() + BLOSC_MAX_OVERHEAD);
    const int bytes = blosc_compress_ctx(level, BLOSC_SHUFFLE, bytes_, chunk.size(), chunk.data(),
                                         packed.data(), packed.size(), BLOSC_LZ4_COMPNAME, 0, 1);
    const std::filesystem::path file = folder_ / fmt::format("{}/{}/{}", next_, y, x);
    if (bytes <= 0) fail("{}: Blosc does not pack {} bytes", file.string(), chunk.size());
    write_small_file(file, packed.data(), static_cast<std::size_t>(bytes));
    hashes_[static_cast<std::size_t>((next_ * counts_[1] + y) * counts_[0] + x)] =
        hash_of_chunk(packed.text().substr(0, static_cast<std::size_t>(bytes)));
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace lamina
