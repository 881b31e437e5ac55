// SPDX-License-Identifier: Apache-2.0
#include "choice/words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/enum_words.h"
#include "base/json_text.h"
#include "optics/colormap.h"
#include "scene/camera.h"

namespace lamina {
namespace {

[[noreturn]] void reject(const char* word, const std::string& found, const std::string& expected) {
    throw WordError(fmt::format("{} {}: expected {}", word, shortened(found), expected));
}

// Returns the number that all of the text is, or nothing.
std::optional<double> number_in(std::string_view text) {
    double number = 0;
    const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return number;
}

bool is_coordinate(double number) {
    return std::abs(number) <= largest_scene_coordinate;
}

ValueRange range_of(const std::string& text) {
    constexpr const char* expected = "LO,HI: two numbers with LO < HI, between -1e300 and 1e300";
    const std::size_t comma = text.find(',');
    if (comma == text.npos) reject("range", text, expected);
    const auto lo = number_in(std::string_view(text).substr(0, comma));
    const auto hi = number_in(std::string_view(text).substr(comma + 1));
    if (!lo || !hi || !(*lo < *hi && *lo >= -1e300 && *hi <= 1e300))
        reject("range", text, expected);
    return {*lo, *hi};
}

// Throws WordError if the name is neither a map's nor a file's. A damaged file is an Error.
Colormap colormap_of_word(const std::string& name_or_path, ImageColorSpace space) {
    if (name_or_path.starts_with('{'))
        return colormap_of(parse_json(name_or_path), "colormap", space);
    try {
        return load_colormap(name_or_path, space);
    } catch (const Error& error) {
        if (std::filesystem::exists(name_or_path)) throw;
        throw WordError(fmt::format("colormap {}", error.what()));
    }
}

OpacityCurve opacity_of_word(const std::string& word) {
    try {
        return opacity_curve(word);
    } catch (const Error& error) {
        reject("opacity", word, error.what());
    }
}

// Returns the enum's value for a text, or nothing for an empty one.
template <typename Enum>
std::optional<Enum> word_in(const char* word, const std::string& text) {
    if (text.empty()) return std::nullopt;
    const auto value = value_of_word<Enum>(text);
    if (!value) reject(word, text, alternatives<Enum>());
    return value;
}

// The two ends of an interval along an axis; open ends are empty.
struct Ends {
    std::optional<double> from, to;
};

// Returns the ends in "FROM:TO". Nothing if a number is wrong or the ends are not in order.
std::optional<Ends> ends_in(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == text.npos) return std::nullopt;
    Ends ends;
    const auto read = [](std::string_view part, std::optional<double>& end) {
        if (part.empty()) return true;
        end = number_in(part);
        return end && is_coordinate(*end);
    };
    if (!read(text.substr(0, colon), ends.from) || !read(text.substr(colon + 1), ends.to))
        return std::nullopt;
    if (ends.from && ends.to && !(*ends.from <= *ends.to)) return std::nullopt;
    return ends;
}

void add_planes(const Ends& ends, int axis, std::vector<ClipPlane>& planes) {
    const auto add = [&](const std::optional<double>& end, double sign) {
        if (!end) return;
        ClipPlane plane{glm::dvec3(0), glm::dvec3(0)};
        plane.point[axis] = *end;
        plane.normal[axis] = sign;
        planes.push_back(plane);
    };
    add(ends.from, 1);
    add(ends.to, -1);
}

[[noreturn]] void reject_clip(const std::string& text) {
    reject("clip", text,
           "x:10: (from 10 on), x::10 (up to 10), x:10:20, x>10 or x<10, with x, y or z");
}

// Adds the planes of "x:10:", "x::10", "x>10" or "x<10".
void add_clip(const std::string& text, std::vector<ClipPlane>& planes) {
    if (text.size() < 3 || text[0] < 'x' || text[0] > 'z') reject_clip(text);
    const std::string_view rest = std::string_view(text).substr(2);
    Ends ends;
    if (text[1] == ':') {
        const auto found = ends_in(rest);
        if (!found || (!found->from && !found->to)) reject_clip(text);
        ends = *found;
    } else {
        const auto number = number_in(rest);
        if ((text[1] != '>' && text[1] != '<') || !number || !is_coordinate(*number))
            reject_clip(text);
        (text[1] == '>' ? ends.from : ends.to) = *number;
    }
    add_planes(ends, text[0] - 'x', planes);
}

// Sets the box of "x0:x1,y0:y1,z0:z1", or planes if some ends are open.
void set_crop(const std::string& text, Clip& clip) {
    std::array<Ends, 3> ends;
    std::string_view rest = text;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t comma = rest.find(',');
        const auto found = ends_in(rest.substr(0, comma));
        if (!found || (comma == rest.npos) != (axis == 2)) {
            reject("crop", text,
                   "x0:x1,y0:y1,z0:z1, lower ends first; an end that is left out is open");
        }
        ends[axis] = *found;
        rest = axis < 2 ? rest.substr(comma + 1) : rest;
    }
    if (std::ranges::all_of(ends, [](const Ends& of_axis) { return of_axis.from && of_axis.to; })) {
        clip.box = ClipBox{{*ends[0].from, *ends[1].from, *ends[2].from},
                           {*ends[0].to, *ends[1].to, *ends[2].to}};
        return;
    }
    for (int axis = 0; axis < 3; ++axis)
        add_planes(ends[static_cast<std::size_t>(axis)], axis, clip.planes);
}

// Replaces the words that a preset stands for, unless they are given themselves.
Words with_preset(Words words) {
    if (words.preset.empty()) return words;
    for (const Preset& preset : presets()) {
        if (words.preset != preset.name) continue;
        // A map's own opacities do not belong to the values of another map.
        if (words.opacity.empty() &&
            (words.colormap.empty() || std::string_view(preset.opacity) != "colormap"))
            words.opacity = preset.opacity;
        if (words.colormap.empty()) words.colormap = preset.colormap;
        if (words.light.empty()) words.light = preset.light;
        return words;
    }
    reject("preset", words.preset,
           fmt::format("one of {}", fmt::join(known_words("preset"), ", ")));
}

void set_transfer(const Words& words, ImageColorSpace space, Adjustments& adjustments) {
    if (!words.range.empty()) adjustments.transfer.range = range_of(words.range);
    if (!words.colormap.empty()) {
        Colormap colormap = colormap_of_word(words.colormap, space);
        if (is_colormap_name(words.colormap) && colormap.own_range && words.range.empty())
            adjustments.map_in_hu = words.colormap;
        // Positions in a colour map's file are rarely values of the data, so the map is stretched
        // over them; so is one in HU if a range says where.
        if (!is_colormap_name(words.colormap) || !words.range.empty()) colormap.own_range = false;
        adjustments.transfer.colormap = std::move(colormap);
    }
    if (words.opacity.empty()) return;
    // Only presets have this word.
    if (words.opacity == "colormap" && !words.preset.empty())
        adjustments.opacity = OpacityCurve{OpacityCurve::Form::of_colormap};
    else
        adjustments.opacity = opacity_of_word(words.opacity);
    adjustments.opacity_word = words.opacity == "colormap" ? words.preset : words.opacity;
}

// Returns what is in both boxes; the first may be missing. Throws Error if it is nothing.
ClipBox common_box(const std::optional<ClipBox>& own, ClipBox box) {
    if (!own) return box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::max(box.min[axis], own->min[axis]);
        box.max[axis] = std::min(box.max[axis], own->max[axis]);
        if (box.min[axis] > box.max[axis]) {
            fail(
                "crop: found nothing in common with the scene's clip.box on axis {}, expected a "
                "part of it",
                "xyz"[axis]);
        }
    }
    return box;
}

}  // namespace

const char* name_of(LightWord word) {
    static constexpr const char* words[] = {"headlight", "left", "right", "two"};
    return word_of(word, words);
}

std::vector<std::string> known_words(const std::string& member) {
    std::vector<std::string> words;
    const auto add = [&](const auto& of_enum) {
        for (const auto& [word, value] : of_enum) words.emplace_back(word);
    };
    if (member == "up") add(enum_words<UpAxis>());
    if (member == "view") add(enum_words<ViewSide>());
    if (member == "light") add(enum_words<LightWord>());
    if (member == "opacity")
        words = {"linear", "linear_r", "geom", "geom_r", "sigmoid", "sigmoid_5", "foreground"};
    if (member == "preset")
        for (const Preset& preset : presets()) words.emplace_back(preset.name);
    return words;
}

Adjustments adjustments_of(const Words& given, ImageColorSpace space) {
    const Words words = with_preset(given);
    Adjustments adjustments;
    set_transfer(words, space, adjustments);
    for (const auto& [name, number] :
         {std::pair{"azimuth", words.azimuth}, std::pair{"elevation", words.elevation}}) {
        if (!std::isfinite(number)) reject(name, fmt::format("{}", number), "a number of degrees");
    }
    if (!(words.zoom >= 1e-3 && words.zoom <= 1e3))
        reject("zoom", fmt::format("{}", words.zoom), "a number from .001 to 1000");
    if (!(words.density >= 0 && words.density <= 1e9))
        reject("density", fmt::format("{}", words.density), "a number from 0 to 1e9");
    adjustments.density = words.density;
    adjustments.turn = {words.azimuth, words.elevation};
    adjustments.zoom = words.zoom;
    adjustments.up = word_in<UpAxis>("up", words.up);
    adjustments.side = word_in<ViewSide>("view", words.view);
    adjustments.light = word_in<LightWord>("light", words.light);
    for (const std::string& text : words.clip) add_clip(text, adjustments.clip.planes);
    if (!words.crop.empty()) set_crop(words.crop, adjustments.clip);
    adjustments.own_crop = !words.crop.empty();
    return adjustments;
}

void adjust_scene(Scene& scene, const Adjustments& adjustments) {
    std::vector<ClipPlane>& planes = scene.clip.planes;
    for (const ClipPlane& plane : adjustments.clip.planes)
        if (std::ranges::find(planes, plane) == planes.end()) planes.push_back(plane);
    if (planes.size() > Clip::most_planes)
        fail("clip: found {} planes, expected at most {}", planes.size(), Clip::most_planes);
    if (adjustments.clip.box) scene.clip.box = common_box(scene.clip.box, *adjustments.clip.box);
    if (adjustments.light && given_lighting(scene.lighting) == nullptr) scene.lighting = Lighting{};
}

std::vector<Light> lights_of(LightWord word, const Camera& camera) {
    const View view(camera, 1, 1);
    const auto from = [&](double right, double up) {
        return right * view.right + up * view.up - view.forward;
    };
    // The key light stands halfway between the eye and a place to its side and above; the fill
    // light is lower, and has this share of the key's brightness.
    constexpr double fill = .35;
    switch (word) {
        case LightWord::headlight:
            return {Light{}};
        case LightWord::left:
            return {Light{from(-1, 1)}};
        case LightWord::right:
            return {Light{from(1, 1)}};
        case LightWord::two:
            return {Light{from(-1, 1)}, Light{from(1, .2), glm::dvec3(fill)}};
    }
    unreachable_enum();
}

}  // namespace lamina
