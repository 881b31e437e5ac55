// SPDX-License-Identifier: Apache-2.0
// ngff.openmicroscopy.org/0.4, "multiscales" metadata.
#include "volume_files/ome_zarr.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/json_excerpt.h"
#include "volume_files/stored_axes.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_image_axes = 5;

class OmeReader {
  public:
    OmeReader(const std::filesystem::path& folder, const Json& attributes)
        : folder_(folder),
          name_((folder / ".zattrs").string()),
          image_(attributes["multiscales"][0]) {}

    ZarrImage read(const std::optional<std::int64_t>& wanted) {
        const Json& datasets = list_in(image_, "datasets");
        const auto level = static_cast<std::size_t>(taken_of(
            folder_.string(), "level", wanted, static_cast<std::int64_t>(datasets.size())));
        const Json& dataset = datasets[level];
        const auto path = dataset.is_object() ? dataset.find("path") : dataset.end();
        if (!dataset.is_object() || path == dataset.end() || !path->is_string())
            fail("{}: datasets: found {}, expected a \"path\"", name_, json_excerpt(dataset));
        ZarrImage image{folder_ / path->get<std::string>(), read_axes(), {}, {}};
        image.scale.assign(image.axes.size(), 1);
        image.translation.assign(image.axes.size(), 0);
        transform(dataset, image);
        transform(image_, image);
        return image;
    }

  private:
    const Json& list_in(const Json& object, const char* key) const {
        const auto found = object.is_object() ? object.find(key) : object.end();
        if (!object.is_object() || found == object.end() || !found->is_array() || found->empty())
            fail("{}: multiscales: found no list \"{}\", expected one", name_, key);
        return *found;
    }

    // Version 0.3 has names alone, earlier ones have none: always t, c, z, y, x.
    std::vector<std::string> read_axes() const {
        if (!image_.contains("axes")) return {"t", "c", "z", "y", "x"};
        std::vector<std::string> axes;
        std::string unit;
        for (const Json& axis : list_in(image_, "axes")) {
            const auto named = axis.is_object() ? axis.find("name") : axis.end();
            const Json& name = axis.is_object() && named != axis.end() ? *named : axis;
            const std::string word = name.is_string() ? name.get<std::string>() : "";
            if (word.size() != 1 || std::string("tczyx").find(word) == std::string::npos) {
                fail("{}: axes: found {}, expected \"t\", \"c\", \"z\", \"y\" or \"x\"", name_,
                     json_excerpt(name));
            }
            axes.push_back(word);
            if (word != "t" && word != "c") expect_unit(axis, unit);
        }
        if (axes.size() > most_image_axes)
            fail("{}: axes: found {}, expected at most {}", name_, axes.size(), most_image_axes);
        return axes;
    }

    void expect_unit(const Json& axis, std::string& unit) const {
        const auto found = axis.is_object() ? axis.find("unit") : axis.end();
        if (!axis.is_object() || found == axis.end() || !found->is_string()) return;
        const auto here = found->get<std::string>();
        if (!unit.empty() && here != unit) {
            fail("{}: axes: found the units \"{}\" and \"{}\", expected one for all", name_,
                 one_line(unit), one_line(here));
        }
        unit = here;
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

    // In the order of the list.
    void transform(const Json& of, ZarrImage& image) const {
        if (!of.contains("coordinateTransformations")) return;
        const std::size_t count = image.axes.size();
        for (const Json& step : list_in(of, "coordinateTransformations")) {
            const Json type = step.is_object() ? step.value("type", Json()) : Json();
            if (type == "scale") {
                const auto scale = numbers_in(step, "scale", count);
                for (std::size_t i = 0; i < count; ++i) {
                    image.scale[i] *= scale[i];
                    image.translation[i] *= scale[i];
                }
            } else if (type == "translation") {
                const auto shift = numbers_in(step, "translation", count);
                for (std::size_t i = 0; i < count; ++i) image.translation[i] += shift[i];
            } else if (type != "identity") {
                fail(
                    "{}: coordinateTransformations: found {}, expected the type \"scale\" or "
                    "\"translation\"",
                    name_, json_excerpt(step));
            }
        }
    }

    std::filesystem::path folder_;
    std::string name_;
    const Json& image_;
};

}  // namespace

Json zarr_attributes(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / ".zattrs";
    if (!std::filesystem::exists(file)) return Json::object();
    expect_allowed(file);
    Json attributes = load_json(file);
    if (!attributes.is_object())
        fail("{}: found {}, expected an object", file.string(), json_excerpt(attributes));
    return attributes;
}

bool is_ome_zarr(const Json& attributes) {
    const auto found = attributes.find("multiscales");
    return found != attributes.end() && found->is_array() && !found->empty() &&
           found->front().is_object();
}

ZarrImage ome_zarr_level(const std::filesystem::path& folder, const Json& attributes,
                         const std::optional<std::int64_t>& level) {
    return OmeReader(folder, attributes).read(level);
}

}  // namespace lamina
