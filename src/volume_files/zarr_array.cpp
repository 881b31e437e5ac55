// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2"), and
// numcodecs for the bytes of chunks.
#include "volume_files/zarr_array.h"

#include <blosc.h>
#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "base/input_file.h"
#include "base/lz4_block.h"
#include "volume_files/npy.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

constexpr const char* codec_names[] = {"none", "zlib", "gzip", "zstd", "lz4", "blosc"};

// Decodes zlib and gzip streams alike, each as a whole.
bool inflate_all(std::span<const char> stored, std::span<char> chunk) {
    constexpr int any_header = 15 + 32;
    if (stored.size() > std::numeric_limits<uInt>::max()) return false;
    z_stream stream{};
    if (inflateInit2(&stream, any_header) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data()));
    stream.avail_in = static_cast<uInt>(stored.size());
    std::size_t done = 0;
    int result = Z_OK;
    while (result == Z_OK) {
        const std::size_t room =
            std::min<std::size_t>(chunk.size() - done, std::numeric_limits<uInt>::max());
        stream.next_out = reinterpret_cast<Bytef*>(chunk.data() + done);
        stream.avail_out = static_cast<uInt>(room);
        result = inflate(&stream, room == 0 ? Z_FINISH : Z_NO_FLUSH);
        done += room - stream.avail_out;
    }
    inflateEnd(&stream);
    return result == Z_STREAM_END && done == chunk.size();
}

bool decode_zstd(std::span<const char> stored, std::span<char> chunk) {
    return ZSTD_decompress(chunk.data(), chunk.size(), stored.data(), stored.size()) ==
           chunk.size();
}

// Decodes a block of LZ4. numcodecs puts the length before it, in four bytes.
bool decode_lz4(std::span<const char> stored, std::span<char> chunk) {
    std::uint32_t size = 0;
    if (stored.size() < sizeof size) return false;
    std::memcpy(&size, stored.data(), sizeof size);
    if constexpr (std::endian::native == std::endian::big) size = __builtin_bswap32(size);
    return size == chunk.size() && decode_lz4_block(stored.subspan(sizeof size), chunk);
}

bool decode_blosc(std::span<const char> stored, std::span<char> chunk) {
    std::size_t size = 0;
    if (blosc_cbuffer_validate(stored.data(), stored.size(), &size) != 0) return false;
    if (size != chunk.size()) return false;
    if (size == 0) return true;
    return blosc_decompress_ctx(stored.data(), chunk.data(), chunk.size(), 1) ==
           static_cast<int>(size);
}

bool decode(ZarrCodec codec, std::span<const char> stored, std::span<char> chunk) {
    switch (codec) {
        case ZarrCodec::zlib:
        case ZarrCodec::gzip:
            return inflate_all(stored, chunk);
        case ZarrCodec::zstd:
            return decode_zstd(stored, chunk);
        case ZarrCodec::lz4:
            return decode_lz4(stored, chunk);
        case ZarrCodec::blosc:
            return decode_blosc(stored, chunk);
        case ZarrCodec::none:
            break;
    }
    if (stored.size() != chunk.size()) return false;
    std::memcpy(chunk.data(), stored.data(), chunk.size());
    return true;
}

constexpr std::size_t most_zarr_axes = 16;

const Json& zarray_member(const Json& document, const char* key, const std::string& name) {
    const auto found = document.find(key);
    if (found == document.end()) fail("{}: {}: found none, expected one", name, key);
    return *found;
}

std::vector<std::int64_t> sizes_in(const Json& document, const char* key, const std::string& name) {
    const Json& list = zarray_member(document, key, name);
    std::vector<std::int64_t> sizes;
    bool good = list.is_array() && !list.empty() && list.size() <= most_zarr_axes;
    for (std::size_t i = 0; good && i < list.size(); ++i) {
        good = list[i].is_number_integer() && list[i] >= 1 && list[i] <= (std::int64_t{1} << 40);
        if (good) sizes.push_back(list[i].get<std::int64_t>());
    }
    if (!good) {
        fail("{}: {}: found {}, expected a list of 1 to {} whole numbers above 0", name, key,
             json_excerpt(list), most_zarr_axes);
    }
    return sizes;
}

// Reads NumPy's typestr: byte order, kind, bytes.
void read_type(const Json& document, ZarrArray& array, const std::string& name) {
    const Json& dtype = zarray_member(document, "dtype", name);
    const std::string word = dtype.is_string() ? dtype.get<std::string>() : "";
    const bool ordered = word.size() == 3 && std::string("<>|=").find(word[0]) != std::string::npos;
    const auto type = numpy_type(std::string_view(word).substr(word.empty() ? 0 : 1));
    if (ordered && type) {
        array.type = *type;
        const bool big = std::endian::native == std::endian::big;
        array.swap = (word[0] == '<' && big) || (word[0] == '>' && !big);
        return;
    }
    fail("{}: dtype: found {}, expected a number of 1, 2, 4 or 8 bytes, as in \"<u2\"", name,
         json_excerpt(dtype));
}

double fill_value(const Json& document, const std::string& name) {
    const Json& fill = zarray_member(document, "fill_value", name);
    if (fill.is_null()) return 0;
    if (fill.is_boolean()) return fill.get<bool>() ? 1 : 0;
    if (fill.is_number()) return fill.get<double>();
    if (fill == "NaN") return std::numeric_limits<double>::quiet_NaN();
    if (fill == "Infinity") return std::numeric_limits<double>::infinity();
    if (fill == "-Infinity") return -std::numeric_limits<double>::infinity();
    fail("{}: fill_value: found {}, expected a number", name, json_excerpt(fill));
}

std::string compressor_id(const Json& document, const std::string& name) {
    const Json& compressor = zarray_member(document, "compressor", name);
    if (compressor.is_null()) return "";
    const auto id = compressor.is_object() ? compressor.find("id") : compressor.end();
    if (!compressor.is_object() || id == compressor.end() || !id->is_string())
        fail("{}: compressor: found {}, expected one with an \"id\"", name,
             json_excerpt(compressor));
    return id->get<std::string>();
}

}  // namespace

ZarrCodec zarr_codec(const std::string& id, const std::string& name) {
    if (id.empty()) return ZarrCodec::none;
    for (const ZarrCodec codec :
         {ZarrCodec::zlib, ZarrCodec::gzip, ZarrCodec::zstd, ZarrCodec::lz4, ZarrCodec::blosc}) {
        if (id == codec_names[static_cast<std::size_t>(codec)]) return codec;
    }
    fail("{}: compressor: found \"{}\", expected blosc, zlib, gzip, zstd, lz4 or null", name,
         one_line(id));
}

void decode_chunk(ZarrCodec codec, std::span<const char> stored, std::span<char> chunk,
                  const std::string& name) {
    if (decode(codec, stored, chunk)) return;
    if (codec == ZarrCodec::none)
        fail("{}: found {} bytes, expected {}", name, stored.size(), chunk.size());
    fail("{}: damaged {} data in its {} bytes, or not of the {} bytes that a chunk has", name,
         codec_names[static_cast<std::size_t>(codec)], stored.size(), chunk.size());
}

std::int64_t ZarrArray::chunk_samples() const {
    std::int64_t samples = 1;
    for (const std::int64_t edge : chunks) samples *= edge;
    return samples;
}

ZarrArray read_zarray(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / ".zarray";
    const std::string name = file.string();
    expect_allowed(file);
    const Json document = load_json(file);
    if (!document.is_object())
        fail("{}: found {}, expected an object", name, json_excerpt(document));
    if (const Json& format = zarray_member(document, "zarr_format", name); format != 2)
        fail("{}: zarr_format: found {}, expected 2", name, json_excerpt(format));
    ZarrArray array;
    array.folder = folder;
    array.shape = sizes_in(document, "shape", name);
    array.chunks = sizes_in(document, "chunks", name);
    if (array.chunks.size() != array.shape.size()) {
        fail("{}: chunks: found {} sizes, expected {}, as in its shape", name, array.chunks.size(),
             array.shape.size());
    }
    read_type(document, array, name);
    std::int64_t bytes = static_cast<std::int64_t>(bytes_of(array.type));
    bool overflow = false;
    for (const std::int64_t edge : array.chunks)
        overflow |= __builtin_mul_overflow(bytes, edge, &bytes);
    if (overflow || bytes > std::numeric_limits<std::int32_t>::max())
        fail("{}: chunks: found more than 2 GiB in each, expected fewer", name);
    const Json& order = zarray_member(document, "order", name);
    if (order != "C" && order != "F")
        fail("{}: order: found {}, expected \"C\" or \"F\"", name, json_excerpt(order));
    array.fortran = order == "F";
    array.fill = fill_value(document, name);
    array.codec = zarr_codec(compressor_id(document, name), name);
    if (const auto filters = document.find("filters");
        filters != document.end() && !filters->is_null() && !filters->empty())
        fail("{}: filters: found {}, expected null", name, json_excerpt(*filters));
    if (const auto separator = document.find("dimension_separator"); separator != document.end()) {
        if (*separator != "." && *separator != "/") {
            fail("{}: dimension_separator: found {}, expected \".\" or \"/\"", name,
                 json_excerpt(*separator));
        }
        array.separator = separator->get<std::string>()[0];
    }
    return array;
}

}  // namespace lamina
