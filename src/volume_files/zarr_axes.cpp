// SPDX-License-Identifier: Apache-2.0
// Attributes describe an array's axes and values: xarray's conventions (docs.xarray.dev, "Zarr
// encoding specification") for arrays that are no images of OME-Zarr.
#include <algorithm>
#include <bit>

#include "volume_files/zarr_image.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

// Returns the float64 that xarray writes as eight bytes in base64 (RFC 4648), lowest first, in
// version 3; nothing for other texts.
std::optional<double> float_of_base64(const std::string& text) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (text.size() != 12 || text[11] != '=') return {};
    std::uint64_t bits = 0;  // of the first ten letters, the highest first
    for (std::size_t i = 0; i < 11; ++i) {
        const std::size_t letter = letters.find(text[i]);
        if (letter == letters.npos) return {};
        // The eleventh holds the last four bits.
        bits = i < 10 ? bits << 6 | letter : bits << 4 | letter >> 2;
    }
    return std::bit_cast<double>(__builtin_bswap64(bits));
}

// Returns the numbers of an attribute: a number, or a list of some.
std::vector<double> zarr_numbers(const Json& attributes, const char* key) {
    constexpr std::size_t most_numbers = 16;
    const Json* const found = member_of(attributes, key);
    if (found == nullptr || found->size() > most_numbers) return {};
    std::vector<double> numbers;
    for (const Json& one : found->is_array() ? *found : Json::array({*found})) {
        if (one.is_number()) numbers.push_back(one.get<double>());
        if (!one.is_string()) continue;
        if (const auto number = float_of_base64(one.get<std::string>())) numbers.push_back(*number);
    }
    return numbers;
}

// Reads the coordinates of an axis from the array of its name beside the array, if there is one.
void read_zarr_coordinates(const ZarrArray& array, ArrayAxis& axis) {
    constexpr std::int64_t most_coordinates = 1 << 20;
    const std::filesystem::path folder = array.folder.parent_path() / axis.name;
    const bool is_name = !axis.name.empty() && axis.name.find('/') == axis.name.npos &&
                         axis.name[0] != '.' && folder != array.folder;
    if (!is_name || axis.size > most_coordinates || !array.store.has_header(folder)) return;
    try {
        const ZarrArray found = read_zarr_array(array.store, folder);
        if (found.shape != std::vector<std::int64_t>{axis.size}) return;
        const auto samples = zarr_samples(ZarrChunks(found, {{-1, -1, 0}, {0}}));
        axis.coordinates = zarr_values(found).meant(
            values_from_bytes<double>(found.type, static_cast<const char*>(samples.get()),
                                      static_cast<std::size_t>(axis.size), false));
        add_attributes(axis, [&](const char* key) { return text_member(found.attributes, key); });
    } catch (const Error& problem) {
        say("{}: its coordinates are not used: {}", array.folder.string(), problem.what());
    }
}

// Returns the names of an array's axes, by its header or else by its attributes; empty if there are
// none.
std::vector<std::string> axis_names_of(const ZarrArray& array) {
    if (!array.axis_names.empty()) return array.axis_names;
    for (const char* const key : axis_name_keys) {
        const Json* const found = member_of(array.attributes, key);
        const auto is_text = [](const Json& one) { return one.is_string(); };
        if (found != nullptr && found->is_array() && found->size() == array.shape.size() &&
            std::ranges::all_of(*found, is_text))
            return found->get<std::vector<std::string>>();
    }
    return {};
}

}  // namespace

DescribedArray describe_zarr(const ZarrArray& array, const ZarrImage& image) {
    constexpr std::int64_t most_listed = 100'000;
    DescribedArray described;
    described.name = array.folder.string();
    described.axes = image.axes;
    described.axes.resize(array.shape.size());
    described.steps = image.steps;
    described.firsts = image.firsts;
    const std::vector<std::string> names = axis_names_of(array);
    if (image.axes.empty()) described.coordinates = text_member(array.attributes, "coordinates");
    for (std::size_t i = 0; i < array.shape.size(); ++i) {
        ArrayAxis& axis = described.axes[i];
        axis.size = array.shape[i];
        if (!image.axes.empty() && axis.kinds.front() == "t" &&
            (!axis.unit.empty() || image.steps[i] != 1)) {
            for (std::int64_t k = 0; k < std::min<std::int64_t>(axis.size, most_listed); ++k)
                axis.coordinates.push_back(image.firsts[i] +
                                           static_cast<double>(k) * image.steps[i]);
        }
        if (!image.axes.empty() || names.empty()) continue;
        axis.name = names[i];
        read_zarr_coordinates(array, axis);
    }
    if (image.axes.empty()) {
        add_lengths(
            described,
            {[&](const std::string& key) { return zarr_numbers(array.attributes, key.c_str()); },
             [&](const std::string& key) { return text_member(array.attributes, key.c_str()); },
             true});
    }
    return described;
}

PackedValues zarr_values(const ZarrArray& array) {
    // Gives whole numbers the samples' type, and returns other values than texts and numbers, such
    // as true, as they are spelled.
    const auto attribute = [&](const char* key) {
        PackedAttribute told{zarr_numbers(array.attributes, key), array.type, ""};
        const Json* const found = member_of(array.attributes, key);
        if (told.numbers.empty() && std::string_view(key) == "_FillValue")
            told.numbers = array.missing;
        if (found == nullptr || found->is_null()) return told;
        const auto is_float = [](const Json& one) { return one.is_number_float(); };
        if (std::ranges::any_of(*found, is_float)) told.type = ValueType::float64;
        if (told.numbers.empty())
            told.text = found->is_string() ? found->get<std::string>() : json_excerpt(*found);
        return told;
    };
    return PackedValues(array.folder.string(), array.type, false, attribute);
}

}  // namespace lamina
