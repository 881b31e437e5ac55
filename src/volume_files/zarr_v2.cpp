// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2"), and what
// it shares with version 3.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "volume_files/stored_samples.h"
#include "volume_files/volume_formats.h"
#include "volume_files/zarr_array.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_zarr_axes = 16;

// Reads NumPy's typestr: byte order, kind, bytes.
void read_dtype(const Json& document, ZarrArray& array, const std::string& name) {
    const Json& dtype = zarr_member(document, "dtype", name);
    const std::string word = dtype.is_string() ? dtype.get<std::string>() : "";
    const bool ordered = word.size() == 3 && std::string("<>|=").find(word[0]) != std::string::npos;
    array.is_half = ordered && word.ends_with("f2");
    const auto type = array.is_half ? ValueType::float32
                                    : numpy_type(std::string_view(word).substr(!word.empty()));
    if (!ordered || !type) {
        fail("{}: dtype: found {}, expected a number of 1, 2, 4 or 8 bytes, as in \"<u2\"{}", name,
             json_excerpt(dtype), numpy_advice(std::string_view(word).substr(!word.empty())));
    }
    array.type = *type;
    const bool big = std::endian::native == std::endian::big;
    array.swap = (word[0] == '<' && big) || (word[0] == '>' && !big);
}

void read_compressor(const Json& document, ZarrArray& array, const std::string& name) {
    const Json& compressor = zarr_member(document, "compressor", name);
    if (compressor.is_null()) return;
    const Json* const id = member_of(compressor, "id");
    if (id == nullptr || !id->is_string()) {
        fail("{}: compressor: found {}, expected one with an \"id\"", name,
             json_excerpt(compressor));
    }
    array.codecs = {zarr_codec(id->get<std::string>(), 2)};
    if (array.codecs[0] == nullptr) {
        fail("{}: compressor: found \"{}\", expected blosc, zlib, gzip, zstd, lz4 or null", name,
             one_line(id->get<std::string>()));
    }
}

// Reads the bits of a float, as in "0x7fc00000"; nothing if the text is none of `bytes` bytes.
std::optional<std::uint64_t> bits_of(const std::string& text, std::size_t bytes) {
    std::uint64_t bits = 0;
    const char* const end = text.data() + text.size();
    if (!text.starts_with("0x") || text.size() != 2 + 2 * bytes) return {};
    const auto [stop, error] = std::from_chars(text.data() + 2, end, bits, 16);
    return error == std::errc{} && stop == end ? std::optional(bits) : std::nullopt;
}

// Reads what xarray says of an array of version 2 (docs.xarray.dev, "Zarr encoding specification"):
// the names of its axes, and that samples with the fill value are missing. 0 is no such value: it
// is what arrays get without one.
void read_xarray(ZarrArray& array, const Json& fill) {
    const Json* const names = member_of(array.attributes, "_ARRAY_DIMENSIONS");
    if (names == nullptr || !names->is_array() || names->size() != array.shape.size()) return;
    for (const Json& one : *names)
        array.axis_names.push_back(one.is_string() ? one.get<std::string>() : "");
    if (fill.is_number() && fill != 0) array.missing = {fill.get<double>()};
}

}  // namespace

const Json& zarr_member(const Json& object, const char* key, const std::string& name) {
    const Json* const found = member_of(object, key);
    if (found == nullptr) fail("{}: {}: found none, expected one", name, key);
    return *found;
}

std::vector<std::int64_t> zarr_sizes(const Json& object, const char* key, const std::string& name) {
    const Json& list = zarr_member(object, key, name);
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

std::string zarr_word(const Json& object, const char* key, const std::array<const char*, 2>& words,
                      const char* otherwise, const std::string& name) {
    const Json* const found = member_of(object, key);
    if (otherwise != nullptr && (found == nullptr || found->is_null())) return otherwise;
    const Json& value = zarr_member(object, key, name);
    if (value != words[0] && value != words[1]) {
        fail("{}: {}: found {}, expected \"{}\" or \"{}\"", name, key, json_excerpt(value),
             words[0], words[1]);
    }
    return value.get<std::string>();
}

void set_fill(ZarrArray& array, const Json& fill) {
    array.fill_text = json_excerpt(fill);
    const std::string word = fill.is_string() ? fill.get<std::string>() : "";
    const bool is_word = word == "NaN" || word == "Infinity" || word == "-Infinity";
    const auto bits = bits_of(word, array.stored_bytes());
    if (!fill.is_number() && !fill.is_boolean() && !is_word && (!bits || is_integer(array.type))) {
        fail("{}: fill_value: found {}, expected a number of type {}", array.header_name(),
             array.fill_text, name_of(array.type));
    }
    // A long double holds all integers of 64 bits.
    using Number = std::numeric_limits<long double>;
    long double number = word == "NaN" ? Number::quiet_NaN() : Number::infinity();
    if (word[0] == '-') number = -number;
    if (fill.is_boolean()) number = fill.get<bool>() ? 1 : 0;
    if (fill.is_number()) number = fill.get<double>();
    if (fill.is_number_integer()) number = static_cast<long double>(fill.get<std::int64_t>());
    if (fill.is_number_unsigned()) number = static_cast<long double>(fill.get<std::uint64_t>());
    with_type(array.type, [&](auto zero) {
        using Value = decltype(zero);
        using Limits = std::numeric_limits<Value>;
        auto value = static_cast<Value>(0);
        if constexpr (std::is_floating_point_v<Value>) {
            using Bits = std::conditional_t<sizeof(Value) == 4, std::uint32_t, std::uint64_t>;
            value = static_cast<Value>(number);
            if (bits) value = std::bit_cast<Value>(static_cast<Bits>(*bits));
            if (bits && array.is_half)
                value = static_cast<Value>(widened_half(static_cast<std::uint16_t>(*bits)));
        } else {
            const bool fits = number >= static_cast<long double>(Limits::min()) &&
                              number <= static_cast<long double>(Limits::max()) &&
                              number == std::floor(number);
            if (!fits) return;
            value = static_cast<Value>(number);
        }
        std::memcpy(array.fill.emplace().data(), &value, sizeof value);
    });
}

void expect_small_chunks(const ZarrArray& array) {
    auto bytes = static_cast<std::int64_t>(bytes_of(array.type));
    bool overflow = false;
    for (const std::int64_t edge : array.chunks)
        overflow |= __builtin_mul_overflow(bytes, edge, &bytes);
    if (overflow || bytes > std::numeric_limits<std::int32_t>::max())
        fail("{}: chunks: found more than 2 GiB in each, expected fewer", array.header_name());
}

std::int64_t ZarrArray::chunk_samples() const {
    std::int64_t samples = 1;
    for (const std::int64_t edge : chunks) samples *= edge;
    return samples;
}

Json zarr_attributes(const ZarrStore& store, const std::filesystem::path& folder) {
    return store.has(folder, ".zattrs") ? store.read_object(folder / ".zattrs") : Json::object();
}

ZarrArray read_zarr_array(const ZarrStore& store, const std::filesystem::path& folder) {
    return store.has(folder, "zarr.json") ? read_zarr_json(store, folder)
                                          : read_zarray(store, folder);
}

ZarrArray read_zarray(const ZarrStore& store, const std::filesystem::path& folder) {
    ZarrArray array;
    array.store = store;
    array.folder = folder;
    const std::string name = array.header_name();
    const Json document = store.read_object(folder / ".zarray");
    if (const Json& format = zarr_member(document, "zarr_format", name); format != 2)
        fail("{}: zarr_format: found {}, expected 2", name, json_excerpt(format));
    array.shape = zarr_sizes(document, "shape", name);
    array.files = array.chunks = zarr_sizes(document, "chunks", name);
    if (array.chunks.size() != array.shape.size()) {
        fail("{}: chunks: found {} sizes, expected {}, as in its shape", name, array.chunks.size(),
             array.shape.size());
    }
    read_dtype(document, array, name);
    expect_small_chunks(array);
    array.layout.resize(array.shape.size());
    std::iota(array.layout.begin(), array.layout.end(), std::size_t{0});
    if (zarr_word(document, "order", {"C", "F"}, nullptr, name) == "F")
        std::ranges::reverse(array.layout);
    const Json& fill = zarr_member(document, "fill_value", name);
    set_fill(array, fill.is_null() ? Json(0) : fill);
    read_compressor(document, array, name);
    const Json* const filters = member_of(document, "filters");
    if (filters != nullptr && !filters->is_null() && !filters->empty())
        fail("{}: filters: found {}, expected null", name, json_excerpt(*filters));
    array.separator = zarr_word(document, "dimension_separator", {".", "/"}, ".", name)[0];
    array.attributes = zarr_attributes(store, folder);
    read_xarray(array, fill);
    return array;
}

}  // namespace lamina
