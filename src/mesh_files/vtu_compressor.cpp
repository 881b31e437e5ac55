// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtu_compressor.h"

#include <lzma.h>
#include <zlib.h>

#include <new>

#include "base/error.h"
#include "base/lz4_block.h"

namespace lamina {
namespace {

std::int64_t decode_zlib(std::span<const char> stored, std::span<char> block) {
    uLongf size = block.size(), used = stored.size();
    const int result = uncompress2(reinterpret_cast<Bytef*>(block.data()), &size,
                                   reinterpret_cast<const Bytef*>(stored.data()), &used);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    return result == Z_OK && size == block.size() ? static_cast<std::int64_t>(used) : -1;
}

std::int64_t decode_lz4(std::span<const char> stored, std::span<char> block) {
    return decode_lz4_block(stored, block) ? static_cast<std::int64_t>(stored.size()) : -1;
}

// vtkLZMADataCompressor writes .xz streams.
std::int64_t decode_lzma(std::span<const char> stored, std::span<char> block) {
    std::uint64_t most_memory = std::uint64_t{256} << 20;  // xz -9 takes 65 MiB
    std::size_t used = 0, size = 0;
    const lzma_ret result = lzma_stream_buffer_decode(
        &most_memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(stored.data()), &used,
        stored.size(), reinterpret_cast<std::uint8_t*>(block.data()), &size, block.size());
    if (result == LZMA_MEM_ERROR) throw std::bad_alloc();
    return result == LZMA_OK && size == block.size() ? static_cast<std::int64_t>(used) : -1;
}

}  // namespace

VtuCompressor VtuCompressor::named(const std::string& name, const std::string& what) {
    // Deflate codes at most 258 bytes in 2 bits (zlib, "Technical details": 1032:1).
    if (name == "vtkZLibDataCompressor") return {"zlib", 1032, decode_zlib};
    if (name == "vtkLZ4DataCompressor") return {"LZ4", lz4_expansion, decode_lz4};
    // LZMA codes at most 273 bytes in a few adapted bits, each of .02 bits at least: below 2^15.
    if (name == "vtkLZMADataCompressor") return {"LZMA", 1 << 15, decode_lzma};
    fail(
        "{}: compressor: found '{}', expected 'vtkZLibDataCompressor', 'vtkLZ4DataCompressor', "
        "'vtkLZMADataCompressor' or none",
        what, one_line(name));
}

}  // namespace lamina
