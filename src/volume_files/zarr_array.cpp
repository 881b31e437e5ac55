// SPDX-License-Identifier: Apache-2.0
// The Zarr v2 specification (zarr.readthedocs.io, "Zarr Storage Specification Version 2"), and the
// core specification, version 3 (zarr-specs.readthedocs.io), with its codecs.
#include "volume_files/zarr_array.h"

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

namespace lamina {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_zarr_axes = 16;
// Filters of an array; programs write one or two. Each takes a pass over every chunk.
constexpr std::size_t most_zarr_filters = 8;

// Returns a list of whole numbers above 0. Throws Error, which begins with `name`, the file's.
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

// Returns one of two words, or `otherwise` if there is none and this is not null. Throws Error.
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

// Reads the bits of a float, as in "0x7fc00000"; nothing if the text is none of `bytes` bytes.
std::optional<std::uint64_t> bits_of(const std::string& text, std::size_t bytes) {
    std::uint64_t bits = 0;
    const char* const end = text.data() + text.size();
    if (!text.starts_with("0x") || text.size() != 2 + 2 * bytes) return {};
    const auto [stop, error] = std::from_chars(text.data() + 2, end, bits, 16);
    return error == std::errc{} && stop == end ? std::optional(bits) : std::nullopt;
}

// Sets the fill value. The type must be set before. Throws Error.
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

// Throws Error if chunks are too large for one piece of memory.
void expect_small_chunks(const ZarrArray& array) {
    auto bytes = static_cast<std::int64_t>(bytes_of(array.type));
    bool overflow = false;
    for (const std::int64_t edge : array.chunks)
        overflow |= __builtin_mul_overflow(bytes, edge, &bytes);
    if (overflow || bytes > std::numeric_limits<std::int32_t>::max())
        fail("{}: chunks: found more than 2 GiB in each, expected fewer", array.header_name());
}

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
        fail("{}: compressor: found \"{}\", expected blosc, zlib, gzip, zstd, lz4, bz2 or null",
             name, one_line(id->get<std::string>()));
    }
}

// Reads filters of version 2. bitround and quantize have changed samples once, and leave no trace.
void read_filters(const Json& document, ZarrArray& array, const std::string& name) {
    const Json* const filters = member_of(document, "filters");
    if (filters == nullptr || filters->is_null()) return;
    if (filters->is_array() && filters->size() > most_zarr_filters) {
        fail("{}: filters: found {}, expected at most {}", name, filters->size(),
             most_zarr_filters);
    }
    const std::size_t bytes = array.stored_bytes();
    const Json& dtype = document["dtype"];
    const auto has = [&](const Json& filter, const char* key, const Json& expected) {
        const Json* const found = member_of(filter, key);
        return found != nullptr && *found == expected;
    };
    for (const Json& filter : filters->is_array() ? *filters : Json::array({*filters})) {
        const std::string id = text_member(filter, "id");
        const bool keeps_type = has(filter, "dtype", dtype) && has(filter, "astype", dtype);
        if (id == "bitround" || (id == "quantize" && keeps_type)) continue;
        if (id == "shuffle" && has(filter, "elementsize", bytes)) {
            array.filters.push_back({ZarrFilter::Kind::shuffle, bytes});
        } else if (id == "delta" && keeps_type && !array.is_half && dtype != "|b1") {
            array.filters.push_back(
                {ZarrFilter::Kind::delta, bytes, array.swap, !is_integer(array.type)});
        } else {
            fail(
                "{}: filters: found {}, expected shuffle, delta, quantize or bitround of the "
                "array's own type, or null",
                name, json_excerpt(filter));
        }
    }
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

// An extension point's name and configuration (core specification, "Extension points"); a word
// alone is a name without configuration.
struct ZarrExtension {
    std::string name;
    Json configuration = Json::object();
};

ZarrExtension extension_of(const Json& value, const char* key, const std::string& file) {
    const Json* const name = value.is_string() ? &value : member_of(value, "name");
    if (name == nullptr || !name->is_string())
        fail("{}: {}: found {}, expected a \"name\"", file, key, json_excerpt(value));
    ZarrExtension extension{name->get<std::string>()};
    const Json* const configuration = member_of(value, "configuration");
    if (configuration != nullptr) extension.configuration = *configuration;
    return extension;
}

bool may_be_ignored(const Json& value) {
    const Json* const must = member_of(value, "must_understand");
    return must != nullptr && *must == false;
}

// Reads zarr.json of an array.
class ZarrJsonReader {
  public:
    ZarrJsonReader(const ZarrStore& store, const std::filesystem::path& folder) {
        array_.store = store;
        array_.folder = folder;
        array_.header = "zarr.json";
        name_ = array_.header_name();
        document_ = store.read_object(folder / array_.header);
    }

    ZarrArray read() {
        expect("zarr_format", 3);
        expect("node_type", "array");
        expect_known_keys();
        array_.shape = zarr_sizes(document_, "shape", name_);
        read_type();
        read_grid();
        std::vector<std::size_t> axes(array_.shape.size());
        std::iota(axes.begin(), axes.end(), std::size_t{0});
        read_codecs(zarr_member(document_, "codecs", name_), axes, false);
        expect_small_chunks(array_);
        set_fill(array_, zarr_member(document_, "fill_value", name_));
        read_keys();
        const Json* const attributes = member_of(document_, "attributes");
        array_.attributes =
            attributes != nullptr && attributes->is_object() ? *attributes : Json::object();
        read_axis_names();
        return std::move(array_);
    }

  private:
    void expect(const char* key, const Json& value) const {
        if (const Json& found = zarr_member(document_, key, name_); found != value) {
            fail("{}: {}: found {}, expected {}", name_, key, json_excerpt(found),
                 json_excerpt(value));
        }
    }

    // Throws Error if there is an extension that changes what the other keys mean.
    void expect_known_keys() const {
        constexpr std::string_view known =
            " zarr_format node_type shape data_type chunk_grid chunk_key_encoding codecs "
            "fill_value "
            "attributes dimension_names storage_transformers consolidated_metadata ";
        for (const auto& [key, value] : document_.items()) {
            const bool is_known = known.find(" " + key + " ") != known.npos;
            if (!is_known && !may_be_ignored(value))
                fail("{}: found the extension \"{}\", expected none", name_, one_line(key));
        }
        const Json* const transformers = member_of(document_, "storage_transformers");
        if (transformers == nullptr) return;
        for (const Json& one : *transformers) {
            if (!may_be_ignored(one))
                fail("{}: storage_transformers: found {}, expected none", name_, json_excerpt(one));
        }
    }

    void read_type() {
        const Json& found = zarr_member(document_, "data_type", name_);
        const std::string word =
            found.is_string() ? found.get<std::string>() : text_member(found, "name");
        array_.is_half = word == "float16";
        auto type = value_type_of(word == "bool" ? "uint8" : word);
        if (type && !is_integer(*type)) type.reset();  // by this program's name
        if (word == "float32" || array_.is_half) type = ValueType::float32;
        if (word == "float64") type = ValueType::float64;
        if (!type) {
            fail(
                "{}: data_type: found {}, expected bool, int8 to int64, uint8 to uint64, float16, "
                "float32 or float64",
                name_, json_excerpt(found));
        }
        array_.type = *type;
    }

    void read_grid() {
        const Json& found = zarr_member(document_, "chunk_grid", name_);
        const ZarrExtension grid = extension_of(found, "chunk_grid", name_);
        if (grid.name != "regular") {
            fail("{}: chunk_grid: found \"{}\", expected \"regular\"", name_, one_line(grid.name));
        }
        array_.files = array_.chunks = sizes_of_axes(grid.configuration);
    }

    // Returns the sizes of a "chunk_shape".
    std::vector<std::int64_t> sizes_of_axes(const Json& configuration) const {
        auto sizes = zarr_sizes(configuration, "chunk_shape", name_);
        if (sizes.size() != array_.shape.size()) {
            fail("{}: chunk_shape: found {} sizes, expected {}, as in its shape", name_,
                 sizes.size(), array_.shape.size());
        }
        return sizes;
    }

    // Reads the codecs of files or, `in_shard`, of chunks in them. `axes`: those of the array, in
    // the order in which the first codec gets them.
    void read_codecs(const Json& list, std::vector<std::size_t> axes, bool in_shard) {
        bool are_bytes = false;
        for (const Json& codec : list.is_array() ? list : Json::array()) {
            const auto [name, configuration] = extension_of(codec, "codecs", name_);
            const ZarrCodec* const packing = zarr_codec(name, 3);
            if (name == "transpose" && !are_bytes) {
                axes = transposed(axes, configuration);
            } else if (name == "bytes" && !are_bytes) {
                array_.swap = is_swapped(configuration, array_.stored_bytes());
                array_.layout = axes;
                are_bytes = true;
            } else if (name == "sharding_indexed" && !are_bytes && !in_shard) {
                read_shards(configuration, axes);
                are_bytes = true;
            } else if (packing != nullptr && are_bytes && in_shard == array_.shards.has_value()) {
                add_codec(array_.codecs, packing);
            } else {
                fail(
                    "{}: codecs: found {}, expected transpose, then bytes or sharding_indexed, and "
                    "behind bytes gzip, zstd, blosc or crc32c",
                    name_, json_excerpt(codec));
            }
        }
        if (!are_bytes)
            fail("{}: codecs: found {}, expected bytes or sharding_indexed among them", name_,
                 json_excerpt(list));
    }

    void add_codec(std::vector<const ZarrCodec*>& codecs, const ZarrCodec* codec) const {
        for (const ZarrCodec* const before : codecs) {
            if (!before->is_checksum && !codec->is_checksum) {
                fail("{}: codecs: found {} behind {}, expected one compression", name_, codec->name,
                     before->name);
            }
        }
        constexpr std::size_t most_codecs = 8;
        if (codecs.size() == most_codecs)
            fail("{}: codecs: found more than {}, expected fewer", name_, most_codecs);
        codecs.push_back(codec);
    }

    std::vector<std::size_t> transposed(const std::vector<std::size_t>& axes,
                                        const Json& configuration) const {
        const Json& order = zarr_member(configuration, "order", name_);
        std::vector<std::size_t> result;
        for (const Json& axis : order.is_array() ? order : Json::array()) {
            const bool is_axis = axis.is_number_unsigned() && axis < axes.size();
            const std::size_t one = is_axis ? axes[axis.get<std::size_t>()] : axes.size();
            if (is_axis && std::ranges::count(result, one) == 0) result.push_back(one);
        }
        if (result.size() != axes.size() || order.size() != axes.size()) {
            fail("{}: transpose: found the order {}, expected each number from 0 to {} once", name_,
                 json_excerpt(order), axes.size() - 1);
        }
        return result;
    }

    bool is_swapped(const Json& configuration, std::size_t word_bytes) const {
        const std::string endian = zarr_word(configuration, "endian", {"little", "big"},
                                             word_bytes == 1 ? "little" : nullptr, name_);
        return word_bytes > 1 && (endian == "big") != (std::endian::native == std::endian::big);
    }

    void read_shards(const Json& configuration, const std::vector<std::size_t>& axes) {
        ZarrShards& shards = array_.shards.emplace();
        shards.axes = axes;
        const auto sizes = sizes_of_axes(configuration);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const std::size_t axis = axes[i];
            if (array_.files[axis] % sizes[i] != 0) {
                fail("{}: sharding_indexed: chunk_shape: found {}, expected a divisor of {}", name_,
                     sizes[i], array_.files[axis]);
            }
            array_.chunks[axis] = sizes[i];
        }
        shards.index_at_end =
            zarr_word(configuration, "index_location", {"start", "end"}, "end", name_) == "end";
        const Json& codecs = zarr_member(configuration, "index_codecs", name_);
        bool are_bytes = false;
        for (const Json& codec : codecs.is_array() ? codecs : Json::array()) {
            const auto [name, how] = extension_of(codec, "index_codecs", name_);
            if (name != (are_bytes ? "crc32c" : "bytes")) break;
            if (are_bytes)
                add_codec(shards.index_codecs, zarr_codec(name, 3));
            else
                shards.swap_index = is_swapped(how, sizeof(std::uint64_t));
            are_bytes = true;
        }
        if (!are_bytes || shards.index_codecs.size() + 1 != codecs.size()) {
            fail("{}: index_codecs: found {}, expected bytes and crc32c", name_,
                 json_excerpt(codecs));
        }
        read_codecs(zarr_member(configuration, "codecs", name_), axes, true);
    }

    void read_keys() {
        const Json& found = zarr_member(document_, "chunk_key_encoding", name_);
        const auto [name, configuration] = extension_of(found, "chunk_key_encoding", name_);
        if (name != "default" && name != "v2") {
            fail("{}: chunk_key_encoding: found \"{}\", expected \"default\" or \"v2\"", name_,
                 one_line(name));
        }
        array_.separator = zarr_word(configuration, "separator", {".", "/"},
                                     name == "default" ? "/" : ".", name_)[0];
        if (name == "default") array_.key_begin = std::string("c") + array_.separator;
    }

    void read_axis_names() {
        const Json* const names = member_of(document_, "dimension_names");
        if (names == nullptr || names->is_null()) return;
        if (!names->is_array() || names->size() != array_.shape.size()) {
            fail("{}: dimension_names: found {}, expected {} names", name_, json_excerpt(*names),
                 array_.shape.size());
        }
        for (const Json& one : *names)
            array_.axis_names.push_back(one.is_string() ? one.get<std::string>() : "");
    }

    ZarrArray array_;
    std::string name_;
    Json document_;
};

}  // namespace

const Json& zarr_member(const Json& object, const char* key, const std::string& name) {
    const Json* const found = member_of(object, key);
    if (found == nullptr) fail("{}: {}: found none, expected one", name, key);
    return *found;
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
    return store.has(folder, "zarr.json") ? ZarrJsonReader(store, folder).read()
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
    read_filters(document, array, name);
    array.separator = zarr_word(document, "dimension_separator", {".", "/"}, ".", name)[0];
    array.attributes = zarr_attributes(store, folder);
    read_xarray(array, fill);
    return array;
}

}  // namespace lamina
