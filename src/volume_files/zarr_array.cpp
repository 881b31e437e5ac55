// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2").
#include "volume_files/zarr_array.h"

#include <bit>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "volume_files/json_excerpt.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

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

// NumPy's typestr: byte order, kind, bytes.
void read_type(const Json& document, ZarrArray& array, const std::string& name) {
    const Json& dtype = zarray_member(document, "dtype", name);
    const std::string word = dtype.is_string() ? dtype.get<std::string>() : "";
    struct Kind {
        const char* code;
        ValueType type;
    };
    constexpr Kind kinds[] = {
        {"b1", ValueType::uint8},   {"i1", ValueType::int8},   {"u1", ValueType::uint8},
        {"i2", ValueType::int16},   {"u2", ValueType::uint16}, {"i4", ValueType::int32},
        {"u4", ValueType::uint32},  {"i8", ValueType::int64},  {"u8", ValueType::uint64},
        {"f4", ValueType::float32}, {"f8", ValueType::float64}};
    const bool ordered = word.size() == 3 && std::string("<>|=").find(word[0]) != std::string::npos;
    for (const Kind& kind : kinds) {
        if (!ordered || word.substr(1) != kind.code) continue;
        array.type = kind.type;
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
