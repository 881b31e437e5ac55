// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_keys.h"

#include <cmath>
#include <memory>

#include <fmt/ranges.h>
#include <glm/vector_relational.hpp>
#include "optics/colormap.h"
#include "scene_files/scene_reader.h"

namespace lamina {

namespace {

bool is_point_color(const glm::dvec3& color) {
    return !glm::any(glm::lessThan(color, glm::dvec3(0))) &&
           !glm::any(glm::greaterThan(color, glm::dvec3(1e30)));
}

// Adds the keys of a point's density: its extinction or its opacity.
void add_density(KeyTable<GivenPoint>& keys) {
    const auto by_opacity = [](const GivenPoint& point) {
        return point.given_as == GivenPoint::Density::opacity;
    };
    keys.check([](JsonReader& reader, GivenPoint& point) {
        const bool extinction = reader.has("extinction"), opacity = reader.has("opacity");
        if (extinction == opacity) {
            reader.fail_at("extinction", opacity ? "stands beside opacity, expected one of the two"
                                                 : "is missing, expected extinction or opacity");
        }
        if (opacity) point.given_as = GivenPoint::Density::opacity;
    });
    const auto left_out_unless = [&](bool opacity) {
        Key<GivenPoint>& last = keys.last();
        last.schema.erase("default");
        last.write = [by_opacity, opacity, write = last.write](const GivenPoint& p, KeyJson& json) {
            if (by_opacity(p) == opacity) write(p, json);
        };
    };
    keys.key("extinction", &GivenPoint::density, number_form({.from = 0}, "a number >= 0"),
             "Per world unit.");
    left_out_unless(false);
    keys.key("smooth", &GivenPoint::smooth, flag_form(),
             "With extinction: the straight pieces on both sides stand for a smooth curve, which "
             "may be followed instead, within 1.3e-3 of their extinction.");
    Key<GivenPoint>& smooth = keys.last();
    smooth.read = [by_opacity, read = smooth.read](JsonReader& reader, GivenPoint& point) {
        if (!by_opacity(point)) read(reader, point);
    };
    smooth.write = [](const GivenPoint& point, KeyJson& json) {
        if (point.smooth) json["smooth"] = true;
    };
    keys.key("opacity", &GivenPoint::density,
             number_form({.from = 0, .up_to = 1}, "a number from 0 to 1"),
             "Over unit_length; in place of extinction.");
    left_out_unless(true);
}

KeyTable<GivenPoint> made_point_keys(bool colored) {
    KeyTable<GivenPoint> keys;
    keys.key("value", &GivenPoint::value, number_form()).required();
    if (colored) {
        keys.key("color", &GivenPoint::color,
                 checked(color_form(), is_point_color, "components from 0 to 1e30"),
                 "Not associated.")
            .otherwise({1, 1, 1});
    }
    add_density(keys);
    return keys;
}

// Returns the keys of a point; beside a colour map, points have no colour of their own.
const KeyTable<GivenPoint>& point_keys(bool colored) {
    static const KeyTable<GivenPoint> with = made_point_keys(true),
                                      without = made_point_keys(false);
    return colored ? with : without;
}

std::vector<GivenPoint> read_points(JsonReader& reader, bool colored) {
    std::vector<GivenPoint> points;
    std::vector<JsonReader> elements = reader.objects("points");
    if (elements.size() > most_given_points) {
        reader.fail_at("points", fmt::format("found {} points, expected at most {}",
                                             elements.size(), most_given_points));
    }
    for (JsonReader& element : elements) {
        GivenPoint point;
        if (colored) point.color = glm::dvec3(1);
        const double value = element.number("value");
        if (!points.empty() && value < points.back().value) {
            element.reject(
                "value",
                fmt::format("at least {}, the value before it (points go in order of value)",
                            points.back().value));
        }
        point_keys(colored).read(element, point);
        points.push_back(point);
    }
    return points;
}

ValueRange read_range(JsonReader& reader) {
    const nlohmann::json& range = reader.value("colormap_range");
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number() ||
        !(range[0].get<double>() < range[1].get<double>()) ||
        range[0].get<double>() < -largest_map_value || range[1].get<double>() > largest_map_value) {
        reader.reject("colormap_range",
                      "two numbers [lo, hi] with lo < hi, between -1e300 and 1e300");
    }
    return {range[0].get<double>(), range[1].get<double>()};
}

// Returns the key "colormap": the name of a shipped map or, for other texts, the path of a file.
std::string colormap_source(JsonReader& reader) {
    const std::string text = reader.text("colormap");
    return is_colormap_name(text) ? text : reader.path_of("colormap").string();
}

Colormap load(JsonReader& reader, const std::string& source) {
    try {
        return load_colormap(source, reader.context.color_space);
    } catch (const Error& error) {
        std::error_code unknown;
        if (is_colormap_name(source) || std::filesystem::exists(source, unknown)) throw;
        reader.fail_at("colormap", error.what());
    }
}

void read_map(JsonReader& reader, GivenTransfer& given) {
    if (!reader.has("colormap")) return;
    if (given.interpolation == PointInterpolation::nearest)
        reader.fail_at("interpolation", "nearest does not go with a colormap, expected linear");
    given.colormap = colormap_source(reader);
    given.map = load(reader, given.colormap);
}

void read_map_range(JsonReader& reader, GivenTransfer& given) {
    if (!given.map) return;
    const bool has_range = reader.has("colormap_range");
    if (!has_range && given.map->own_range) return;
    if (given.map->colors.front().value == given.map->colors.back().value)
        reader.fail_at("colormap_range", "cannot stretch a colour map that has a single value");
    if (has_range) given.colormap_range = read_range(reader);
}

void read_points_of(JsonReader& reader, GivenTransfer& given) {
    const bool own = given.map && !reader.has("points");
    if (!own) given.points = read_points(reader, !given.map);
    if (given.map && (own ? given.map->opacities.empty() : given.points.empty())) {
        reader.reject("points", own ? "points with extinction or opacity: the colour map has no "
                                      "opacities of its own (Points)"
                                    : "at least one point");
    }
}

Key<GivenTransfer> colormap_key() {
    const KeyJson schema{
        {"description",
         "Path of a ParaView colour map (JSON preset), or the name of a shipped one: " +
             fmt::format("{}", fmt::join(colormap_names(), ", ")) +
             ". Points then give no colour."},
        {"type", "string"}};
    const auto write = [](const GivenTransfer& given, KeyJson& json) {
        if (!given.map) return;
        const std::filesystem::path file = given.colormap_file();
        json["colormap"] = file.empty() ? given.colormap : std::filesystem::absolute(file).string();
    };
    return {"colormap", schema, false, read_map, write};
}

Key<GivenTransfer> range_key() {
    const KeyJson schema{
        {"description",
         "Scalars that the map is stretched to; a shipped one else to the data's range, if it is "
         "not in HU."},
        {"type", "array"},
        {"items", {{"type", "number"}}},
        {"minItems", 2},
        {"maxItems", 2}};
    const auto write = [](const GivenTransfer& given, KeyJson& json) {
        if (given.colormap_range.is_given())
            json["colormap_range"] = {given.colormap_range->lo, given.colormap_range->hi};
    };
    return {"colormap_range", schema, false, read_map_range, write};
}

Key<GivenTransfer> points_key() {
    const KeyJson schema{{"description", "In order of value; two points at one value make a step."},
                         {"type", "array"},
                         {"minItems", 1},
                         {"maxItems", most_given_points},
                         {"items", point_keys(true).schema()}};
    const auto write = [](const GivenTransfer& given, KeyJson& json) {
        for (const GivenPoint& point : given.points)
            json["points"].push_back(point_keys(!given.map).json(point));
    };
    return {"points", schema, false, read_points_of, write};
}

double read_scalar(JsonReader& reader, const std::string& key) {
    const double scalar = reader.number(key);
    if (!(std::abs(scalar) <= 1e300)) reader.reject(key, "a number between -1e300 and 1e300");
    return scalar;
}

// A transfer function as given, and the function that results: none if its colour map is open.
struct ReadTransfer {
    GivenTransfer given;
    std::optional<TransferFunction> function;
};

// Reads and closes the object. Throws KeyError, also if points and map make no function.
ReadTransfer read_transfer_function(JsonReader reader) {
    ReadTransfer read;
    read.given.place = reader.place();
    table_of<transfer_keys>().read(reader, read.given);
    if (read.given.open()) return read;
    try {
        read.function = transfer_function_of(read.given);
    } catch (const GivenTransferError& error) {
        reader.fail_at(error.key, error.what());
    }
    return read;
}

}  // namespace

void transfer_keys(KeyTable<GivenTransfer>& keys) {
    keys.key("unit_length", &GivenTransfer::unit_length, number_form({.above = 0}, "a number > 0"),
             "World length that opacity refers to.");
    keys.key("interpolation", &GivenTransfer::interpolation, words_form<PointInterpolation>(),
             "linear: opacity between two points given by opacity, else extinction; "
             "extinction: extinction everywhere; nearest: the nearest point.");
    keys.key("codes", &GivenTransfer::codes, flag_form(),
             "Values are the codes of labels that do not fit 16 bits (docs/scene.md, \"Labels\"), "
             "in place of the file's numbers.");
    keys.last().write = [](const GivenTransfer& given, KeyJson& json) {
        if (given.codes) json["codes"] = true;
    };
    keys.key("codes_of", &GivenTransfer::codes_of, text_form(),
             "Which labels the codes are of, as lamina writes it: a volume of others is refused.");
    keys.add(colormap_key()).add(range_key()).add(points_key());
}

void add_transfer_function(KeyTable<Scene>& scene) {
    const Alternative<Scene> chosen{[](const nlohmann::json& value) { return value == "auto"; },
                                    [](JsonReader&, const std::string&, Scene&) {},
                                    chooses_transfer_function,
                                    [](const Scene&) { return KeyJson("auto"); },
                                    {{"const", "auto"}}};
    // The function of an open colour map can only be made when the range of the data is known.
    const auto read = [](JsonReader& reader, const std::string& key, Scene& into) {
        ReadTransfer found = read_transfer_function(reader.object(key));
        into.given_transfer = std::make_shared<const GivenTransfer>(std::move(found.given));
        if (found.function) into.transfer_function = std::move(*found.function);
    };
    const auto write = [](const Scene& written) {
        return has_open_colormap(written) ? table_of<transfer_keys>().json(*written.given_transfer)
                                          : transfer_function_json(*written.transfer_function);
    };
    const Alternative<Scene> given{[](const nlohmann::json& value) { return value.is_object(); },
                                   read, [](const Scene&) { return true; }, write,
                                   table_of<transfer_keys>().schema()};
    scene.check([](JsonReader&, Scene& into) { into.transfer_function = automatic; });
    scene
        .variant("transfer_function", {chosen, given}, "an object {...}, or \"auto\"",
                 "auto: chosen from the data (docs/first-picture.md).")
        .otherwise("auto");
}

IntegrationCase read_integration_case(JsonReader reader) {
    ReadTransfer read = read_transfer_function(reader.object("transfer_function"));
    if (!read.function) {
        reader.fail_at("transfer_function.colormap_range",
                       "is missing, expected [lo, hi]: there are no data here");
    }
    const double front = read_scalar(reader, "sf");
    const double back = read_scalar(reader, "sb");
    const double length = reader.number("length");
    if (!(length >= 0)) reader.reject("length", "a number >= 0");
    reader.close();
    return {std::move(*read.function), std::move(read.given), front, back, length};
}

}  // namespace lamina
