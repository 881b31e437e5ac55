// SPDX-License-Identifier: Apache-2.0
#include "volume_files/tiff_description.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/json_text.h"
#include "volume_files/array_axes.h"
#include "volume_files/numbered_files.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

using ImageJValues = std::map<std::string, std::string>;

std::string imagej_value(const ImageJValues& values, const char* key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string() : found->second;
}

// Takes the distances that ImageJ writes: resolutions, which may have units of their own, and
// "spacing" along z.
void take_distances(const TiffBeginning& first, const ImageJValues& values, TiffDescription& to) {
    const auto unit_of = [&](const char* key) {
        const std::string unit = unit_word(imagej_value(values, key));
        // ImageJ escapes the letter, and older versions write it in Latin-1.
        return imagej_value(values, key) == "\\u00B5m" || unit == "\xb5m" ? std::string("µm")
                                                                          : unit;
    };
    constexpr double screen_dots = 72;  // an inch, as ImageJ and others write for "unknown"
    std::string unit = unit_of("unit");
    const bool in_inches = first.resolution_unit == 2 && first.resolution[0] != screen_dots;
    if (unit.empty() && first.resolution[0] > 0)
        unit = in_inches ? "inch" : first.resolution_unit == 3 ? "cm" : "";
    const bool is_unknown = unit.empty() && first.resolution_unit == 2;
    const char* const keys[] = {"unit", "yunit", "zunit"};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string spacing = imagej_value(values, "spacing");
        const double distance = axis == 2 ? std::abs(std::strtod(spacing.c_str(), nullptr))
                                          : 1 / first.resolution[static_cast<std::size_t>(axis)];
        const std::string own = axis == 0 ? unit : unit_of(keys[axis]);
        if (is_distance(distance) && !(is_unknown && axis < 2))
            set_distance(to, first.file, axis, distance, own);
        else if (axis == 0)
            to.unit = unit;
    }
    const bool has_slices = std::ranges::any_of(
        to.axes, [](const TiffAxis& axis) { return axis.letter == 'Z' && axis.size > 1; });
    if (!unit.empty() && !values.contains("spacing") && has_slices) {
        say("{}: {} has no spacing of slices: they are taken to be 1 {} apart", first.file,
            to.writer, unit);
    }
}

// Takes the place of the first sample, which ImageJ counts in pixels, and the scale of values.
void take_calibration(const TiffBeginning& first, const ImageJValues& values, TiffDescription& to) {
    const auto number = [&](const char* key, double otherwise) {
        const std::string text = imagej_value(values, key);
        const double found = std::strtod(text.c_str(), nullptr);
        return text.empty() || !std::isfinite(found) ? otherwise : found;
    };
    const char* const keys[] = {"xorigin", "yorigin", "zorigin"};
    for (int axis = 0; axis < 3; ++axis)
        to.origin[axis] = 0 - number(keys[axis], 0) * to.spacing[axis];  // 0 has no sign
    if (!values.contains("cf")) return;
    constexpr double straight_line = 0, none = 20;  // ImageJ's Calibration.java
    if (number("cf", none) == straight_line && number("c1", 0) != 0) {
        to.scale = number("c1", 1);
        to.shift = number("c0", 0);
    } else if (number("cf", none) != none) {
        say("{}: ImageJ's calibration function {} is no straight line and not used: "
            "values are as they are stored",
            first.file, one_line(imagej_value(values, "cf")));
    }
}

// Names frames by their times: ImageJ's "finterval" lies between two, in seconds or "tunit".
void name_frames(const ImageJValues& values, TiffAxis& frames) {
    constexpr std::int64_t most = std::int64_t{1} << 20;  // before the pages are compared with it
    const double interval = std::strtod(imagej_value(values, "finterval").c_str(), nullptr);
    if (!is_distance(interval) || frames.size > most) return;
    const std::string own = imagej_value(values, "tunit");
    const std::string unit = own.empty() || own == "sec" ? "s" : unit_word(own);
    for (std::int64_t t = 0; t < frames.size; ++t)
        frames.names.push_back(fmt::format("{:g} {}", static_cast<double>(t) * interval, unit));
}

// Reads ImageJ's lines "key=value". Planes run through channels first, then slices, then frames.
TiffDescription imagej_description(const TiffBeginning& first) {
    ImageJValues values;
    std::istringstream stream(first.description);
    for (std::string line; std::getline(stream, line);) {
        const std::size_t equals = line.find('=');
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (equals != std::string::npos) values[line.substr(0, equals)] = line.substr(equals + 1);
    }
    const auto count = [&](const char* key) {
        const auto number = whole_number(imagej_value(values, key));
        return number && *number > 0 && *number < (std::int64_t{1} << 32) ? *number : 1;
    };
    TiffDescription found;
    found.writer = "ImageJ";
    found.axes = {{'C', count("channels")}, {'Z', count("slices")}, {'T', count("frames")}};
    if (std::ranges::all_of(found.axes, [](const TiffAxis& axis) { return axis.size == 1; }))
        found.axes[1].size = std::max(first.pages * first.depth, count("images"));
    if (first.samples > 1) {
        if (found.axes[0].size > 1) fail_as_mixed(first.file, found.axes[0].size, first.samples);
        found.axes[0].size = first.samples;
    }
    take_distances(first, values, found);
    take_calibration(first, values, found);
    name_frames(values, found.axes[2]);
    return found;
}

// Gives the axes that have no name a meaning: the fastest is z, of two more the faster one counts
// channels, and the other one times.
void name_axes(const TiffBeginning& first, std::vector<TiffAxis>& axes) {
    std::erase_if(axes, [](const TiffAxis& axis) { return axis.letter == '?' && axis.size == 1; });
    const auto is = [](char letter) {
        return [letter](const TiffAxis& axis) { return axis.letter == letter; };
    };
    const auto unnamed = std::ranges::find_if(axes, is('?'));
    if (unnamed != axes.end() && std::ranges::none_of(axes, is('Z'))) unnamed->letter = 'Z';
    const auto left = std::ranges::count_if(axes, is('?'));
    const auto others = std::ranges::count_if(axes, is('C')) + std::ranges::count_if(axes, is('T'));
    if (left == 2 && others == 0) {
        std::ranges::find_if(axes, is('?'))->letter = 'C';
        std::ranges::find_if(axes, is('?'))->letter = 'T';
        say_five_axes(first.file);
    } else if (left > 1) {
        fail("{}: shape: found {} axes beside x, y and z without a name, expected one", first.file,
             left);
    }
}

// Reads tifffile's JSON, {"shape": [..], "axes": ".."}: the axes of an array, slowest first, the
// last of which are those of a page. `axes` is missing if its user gave no names.
TiffDescription shaped_description(const TiffBeginning& first, const nlohmann::json& json) {
    std::vector<std::int64_t> shape;
    for (const nlohmann::json& size : json["shape"]) {
        constexpr std::int64_t most = std::int64_t{1} << 40;
        if (!size.is_number_integer() || size < 1 || size > most)
            fail("{}: shape: expected whole numbers above 0", first.file);
        shape.push_back(size.get<std::int64_t>());
    }
    std::string letters(shape.size(), '?');
    if (const auto axes = json.find("axes"); axes != json.end() && axes->is_string()) {
        letters = axes->get<std::string>();
        if (letters.size() != shape.size())
            fail("{}: axes: found '{}', expected a letter for each of {} axes", first.file,
                 one_line(letters), shape.size());
    }
    // Takes the axes of a page away, the fastest first.
    const auto take = [&](char letter, std::int64_t size) {
        if (shape.empty() || shape.back() != size ||
            (letter != 'S' && letters.back() != '?' && letters.back() != letter)) {
            fail(
                "{}: found pages of {} x {} pixels of {} samples, which do not fit tifffile's {} "
                "with the axes '{}'",
                first.file, first.size[0], first.size[1], first.samples, json["shape"].dump(),
                one_line(letters));
        }
        letters.pop_back();
        shape.pop_back();
    };
    TiffDescription found;
    found.writer = "tifffile";
    if (first.samples > 1 && first.is_contiguous) {
        const char named = letters.empty() ? '?' : letters.back();
        take('S', first.samples);
        found.axes.push_back({named == '?' ? 'C' : named, first.samples});
    }
    take('X', first.size[0]);
    take('Y', first.size[1]);
    for (; !shape.empty(); shape.pop_back(), letters.pop_back())
        found.axes.push_back({letters.back(), shape.back()});
    const auto planes = found.axes.begin();
    if (first.is_colour && !first.is_contiguous && planes != found.axes.end() &&
        planes->letter == '?')
        planes->letter = 'C';
    for (TiffAxis& axis : found.axes) {
        if (axis.letter == 'S') axis.letter = 'C';
        if (axis.letter != 'Z' && axis.letter != 'C' && axis.letter != 'T') axis.letter = '?';
    }
    name_axes(first, found.axes);
    if (std::ranges::find(found.axes, 'Z', &TiffAxis::letter) == found.axes.end())
        found.axes.push_back({'Z', 1});
    ImageJValues values;
    for (const char* const key : {"unit", "spacing"}) {
        const auto value = json.find(key);
        if (value != json.end())
            values[key] = value->is_string() ? value->get<std::string>() : value->dump();
    }
    if (!values.empty()) take_distances(first, values, found);
    return found;
}

// Returns tifffile's JSON; null if the description is none.
nlohmann::json tifffile_json(const std::string& text) {
    if (!text.starts_with('{')) return {};
    try {
        nlohmann::json json = parse_json(text);
        const auto shape = json.find("shape");
        if (shape != json.end() && shape->is_array()) return json;
    } catch (const Error&) {
    }
    return {};
}

// Warns of a description by another program if it may speak of distances or of the order of pages.
void warn_of_unknown(const TiffBeginning& first) {
    const std::string text = lower_case(one_line(first.description));
    for (const char* const word : {"spacing", "pixelsize", "pixel size", "voxel", "calibration",
                                   "channel", "slice", "frame", "<?xml"}) {
        if (text.find(word) == std::string::npos) continue;
        say("{}: its description is in no form that lamina reads ('{}'): distances and "
            "the meaning of pages are not taken from it",
            first.file, shortened(one_line(first.description)));
        return;
    }
}

}  // namespace

void fail_as_mixed(const std::string& file, std::int64_t channels, std::int64_t samples) {
    fail("{}: found pages for {} channels and {} samples a pixel, expected one of both", file,
         channels, samples);
}

bool is_distance(double number) {
    return std::isfinite(number) && number > 1e-100 && number < 1e100;
}

void set_distance(TiffDescription& to, const std::string& file, int axis, double distance,
                  const std::string& unit) {
    if (axis == 0) to.unit = unit;
    if (axis > 0 && !unit.empty() && unit != to.unit) {
        const double from = metres_of(unit), wanted = metres_of(to.unit);
        if (from > 0 && wanted > 0) {
            distance *= from / wanted;
        } else {
            say("{}: the unit of {} is '{}', which is not converted to that of x, "
                "'{}': distances are taken as they are",
                file, "xyz"[axis], one_line(unit), one_line(to.unit));
        }
    }
    to.spacing[axis] = distance;
    to.says_thickness |= axis == 2;
}

TiffDescription tiff_description(const TiffBeginning& first) {
    if (first.description.starts_with("ImageJ=")) return imagej_description(first);
    if (const nlohmann::json json = tifffile_json(first.description); !json.is_null())
        return shaped_description(first, json);
    warn_of_unknown(first);
    TiffDescription plain;
    plain.axes = {{'C', first.samples}, {'Z', first.depth * first.pages}};
    return plain;
}

}  // namespace lamina
