// SPDX-License-Identifier: Apache-2.0
// How an array lies in the world, and what its values mean. OME-Zarr: "multiscales" metadata
// (ngff.openmicroscopy.org/0.4 and 0.5). Other arrays: xarray's conventions (docs.xarray.dev, "Zarr
// encoding specification").
#include "volume_files/zarr_image.h"

#include <algorithm>
#include <bit>
#include <map>

#include "image/coded_image.h"

namespace lamina {
namespace {

using Json = nlohmann::json;
using Path = std::filesystem::path;

// Reads the first image of a list "multiscales".
class OmeZarrReader {
  public:
    explicit OmeZarrReader(const ZarrNode& node)
        : folder_(node.folder),
          name_(node.folder.string()),
          ome_(ome_attributes(node)),
          image_(ome_["multiscales"][0]) {}

    ZarrImage read(const std::optional<std::int64_t>& wanted) {
        if (const std::size_t count = ome_["multiscales"].size(); count > 1)
            say("{}: multiscales: image 0 of {} is taken", name_, count);
        const Json& datasets = list_in(image_, "datasets");
        const std::int64_t level =
            taken_of(name_, "level", wanted, static_cast<std::int64_t>(datasets.size()));
        ZarrImage image;
        image.axes = read_axes();
        image.has_own_axes = image_.contains("axes");
        image.steps.assign(image.axes.size(), 1);
        image.firsts.assign(image.axes.size(), 0);
        for (const Json& dataset : datasets) image.levels.push_back(folder_of(dataset));
        image.folder = image.levels[static_cast<std::size_t>(level)];
        transform(datasets[static_cast<std::size_t>(level)], image);
        transform(image_, image);
        const Json* const omero = member_of(ome_, "omero");
        const Json* const channels = omero == nullptr ? nullptr : member_of(*omero, "channels");
        if (channels != nullptr && channels->is_array())
            for (const Json& one : *channels) image.channels.push_back(text_member(one, "label"));
        const Json* const about_labels = member_of(ome_, "image-label");
        image.is_labels = about_labels != nullptr || folder_.parent_path().filename() == "labels";
        if (about_labels != nullptr) image.labels = labels_in(*about_labels);
        return image;
    }

  private:
    // Reads the colours of labels, sRGB of 8 bits with opacity, and their names. The format names
    // no key for these.
    static std::vector<Label> labels_in(const Json& about) {
        std::map<std::string, Label> labels;  // by number
        for_each_label(about, "colors", labels, [](const Json& entry, Label& label) {
            const Json* const rgba = member_of(entry, "rgba");
            if (rgba == nullptr || !rgba->is_array() || rgba->size() < 3) return;
            double shares[4] = {0, 0, 0, 1};
            for (std::size_t i = 0; i < std::min<std::size_t>(rgba->size(), 4); ++i) {
                const Json& stored = (*rgba)[i];
                if (!stored.is_number() || stored < 0 || stored > 255) return;
                shares[i] = stored.get<double>() / 255;
            }
            label.color = {linear_from_srgb(shares[0]), linear_from_srgb(shares[1]),
                           linear_from_srgb(shares[2])};
            label.opacity = shares[3];
        });
        for_each_label(about, "properties", labels, [](const Json& entry, Label& label) {
            for (const char* const key : {"name", "label", "class", "label-name", "acronym"})
                if (label.name.empty()) label.name = one_line(text_member(entry, key));
        });
        std::vector<Label> list;
        for (const auto& [number, label] : labels) list.push_back(label);
        return list;
    }

    // Calls visit(entry, label) for the entries of a list in "image-label", which have the number
    // of a label each.
    template <typename Visit>
    static void for_each_label(const Json& about, const char* key,
                               std::map<std::string, Label>& labels, const Visit& visit) {
        const Json* const list = member_of(about, key);
        if (list == nullptr || !list->is_array()) return;
        for (const Json& entry : *list) {
            const Json* const number = member_of(entry, "label-value");
            if (number == nullptr || !number->is_number_integer()) continue;
            Label& label = labels[number->dump()];
            label.number = number->dump();
            visit(entry, label);
        }
    }

    Path folder_of(const Json& dataset) const {
        const Json* const path = member_of(dataset, "path");
        if (path == nullptr || !path->is_string())
            fail("{}: datasets: found {}, expected a \"path\"", name_, json_excerpt(dataset));
        return folder_ / path->get<std::string>();
    }

    const Json& list_in(const Json& object, const char* key) const {
        const Json* const found = member_of(object, key);
        if (found == nullptr || !found->is_array() || found->empty())
            fail("{}: multiscales: found no list \"{}\", expected one", name_, key);
        return *found;
    }

    // Returns the axes. Version 0.3 of the format has only names; earlier ones have none, and the
    // axes are always t, c, z, y, x.
    std::vector<ArrayAxis> read_axes() const {
        constexpr std::size_t most_image_axes = 16;
        if (image_.contains("coordinateSystems")) {
            fail(
                "{}: multiscales: found \"coordinateSystems\", expected \"axes\", as up to "
                "version 0.5 of OME-Zarr",
                name_);
        }
        static const Json all{"t", "c", "z", "y", "x"};
        const Json& list = image_.contains("axes") ? list_in(image_, "axes") : all;
        if (list.size() > most_image_axes)
            fail("{}: axes: found {}, expected at most {}", name_, list.size(), most_image_axes);
        std::vector<ArrayAxis> axes;
        std::string roles, with_unit, without_unit;
        for (const Json& axis : list) {
            ArrayAxis& read = axes.emplace_back();
            const Json* const named = member_of(axis, "name");
            const Json& name = named != nullptr ? *named : axis;
            read.name = name.is_string() ? name.get<std::string>() : "";
            read.unit = text_member(axis, "unit");
            const char role = role_of(read.name, text_member(axis, "type"));
            if (role == 0) {
                fail("{}: axes: found {}, expected \"t\", \"c\", \"z\", \"y\" or \"x\"", name_,
                     json_excerpt(axis));
            }
            if (roles.find(role) != roles.npos)
                fail("{}: axes: found two \"{}\", expected one", name_, role);
            roles += role;
            read.kinds = {std::string(1, role)};
            if (role >= 'x') (read.unit.empty() ? without_unit : with_unit) = role;
        }
        if (!with_unit.empty() && !without_unit.empty()) {
            say("{}: axes: {} has no unit: it is taken to be that of {}", name_, without_unit,
                with_unit);
        }
        return axes;
    }

    // Returns the role of an axis, "t", "c", "z", "y" or "x"; 0 for others.
    static char role_of(const std::string& name, const std::string& type) {
        if (type == "time") return 't';
        if (type == "channel") return 'c';
        const std::string_view names = type == "space" ? "zyx" : type.empty() ? "tczyx" : "";
        return name.size() == 1 && names.find(name) != names.npos ? name[0] : '\0';
    }

    std::vector<double> numbers_in(const Json& step, const char* key, std::size_t count) const {
        std::vector<double> numbers;
        const Json& list = step.contains(key) ? step[key] : step;
        bool good = list.is_array() && list.size() == count;
        for (std::size_t i = 0; good && i < count; ++i) {
            good = list[i].is_number();
            if (good) numbers.push_back(list[i].get<double>());
        }
        if (!good) {
            fail("{}: coordinateTransformations: found {}, expected a \"{}\" of {} numbers", name_,
                 json_excerpt(step), key, count);
        }
        return numbers;
    }

    // Applies the transformations of a dataset or an image, in the order of its list.
    void transform(const Json& of, ZarrImage& image) const {
        if (!of.contains("coordinateTransformations")) return;
        const std::size_t count = image.axes.size();
        for (const Json& step : list_in(of, "coordinateTransformations")) {
            const std::string type = text_member(step, "type");
            if (type == "scale") {
                const auto scale = numbers_in(step, "scale", count);
                for (std::size_t i = 0; i < count; ++i) {
                    image.steps[i] *= scale[i];
                    image.firsts[i] *= scale[i];
                }
            } else if (type == "translation") {
                const auto shift = numbers_in(step, "translation", count);
                for (std::size_t i = 0; i < count; ++i) image.firsts[i] += shift[i];
            } else if (type != "identity") {
                fail(
                    "{}: coordinateTransformations: found {}, expected the type \"scale\" or "
                    "\"translation\"",
                    name_, json_excerpt(step));
            }
        }
    }

    Path folder_;
    std::string name_;
    const Json& ome_;
    const Json& image_;
};

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

const Json& ome_attributes(const ZarrNode& node) {
    const Json* const ome = member_of(node.attributes, "ome");
    return ome != nullptr && ome->is_object() ? *ome : node.attributes;
}

bool is_ome_image(const ZarrNode& node) {
    const Json* const found = member_of(ome_attributes(node), "multiscales");
    return found != nullptr && found->is_array() && !found->empty() && found->front().is_object();
}

ZarrImage read_ome_image(const ZarrNode& node, const std::optional<std::int64_t>& level) {
    return OmeZarrReader(node).read(level);
}

std::optional<std::int64_t> level_of(const ZarrNode& node, const Path& folder) {
    if (!is_ome_image(node)) return {};
    const Json* const datasets = member_of(ome_attributes(node)["multiscales"][0], "datasets");
    for (std::size_t i = 0; datasets != nullptr && datasets->is_array() && i < datasets->size();
         ++i)
        if (node.folder / text_member((*datasets)[i], "path") == folder)
            return static_cast<std::int64_t>(i);
    return {};
}

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
