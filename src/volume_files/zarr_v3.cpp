// SPDX-License-Identifier: Apache-2.0
// The Zarr core specification, version 3 (zarr-specs.readthedocs.io), and its codecs.
#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "volume_files/zarr_array.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

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

ZarrArray read_zarr_json(const ZarrStore& store, const std::filesystem::path& folder) {
    return ZarrJsonReader(store, folder).read();
}

}  // namespace lamina
