// SPDX-License-Identifier: Apache-2.0
// OME-Zarr: ngff.openmicroscopy.org/0.4 and 0.5, "multiscales" metadata.
#include <algorithm>
#include <map>

#include "image/coded_image.h"
#include "volume_files/zarr_image.h"

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

}  // namespace lamina
