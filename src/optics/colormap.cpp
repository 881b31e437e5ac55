// SPDX-License-Identifier: Apache-2.0
#include "optics/colormap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/json_text.h"
#include "lamina/color.h"

namespace lamina {
namespace {

// Largest error of a colour component, in the wanted space: a sixteenth of 1/255.
constexpr double preset_tolerance = 2.5e-4;
// Limits the intervals between two points of a preset to 2^7.
constexpr int most_halvings = 7;

nlohmann::json load(const std::filesystem::path& file) {
    expect_allowed(file);
    nlohmann::json root = load_json(file);
    if (root.is_array() && !root.empty()) root = nlohmann::json(root.front());
    if (!root.is_object()) {
        fail("{}: found {}, expected a ParaView preset: an object or an array with one",
             file.string(), root.type_name());
    }
    return root;
}

std::string shown(const nlohmann::json& value) {
    return shortened(json_text(value));
}

ColorSpace color_space(const nlohmann::json& preset, const std::string& name) {
    const std::pair<const char*, ColorSpace> known[] = {{"RGB", ColorSpace::rgb},
                                                        {"HSV", ColorSpace::hsv},
                                                        {"Lab", ColorSpace::lab},
                                                        {"Diverging", ColorSpace::diverging},
                                                        {"Step", ColorSpace::step}};
    const auto found = preset.find("ColorSpace");
    if (found == preset.end()) return ColorSpace::rgb;
    for (const auto& [word, space] : known) {
        if (*found != word) continue;
        const auto wrap = preset.find("HSVWrap");
        const bool wrapped = wrap != preset.end() && (*wrap == true || *wrap == 1);
        return space == ColorSpace::hsv && wrapped ? ColorSpace::hsv_wrapped : space;
    }
    fail(R"({}: ColorSpace is {}, expected "RGB", "HSV", "Lab", "Diverging" or "Step")", name,
         shown(*found));
}

// Reads rows of four numbers. Their first numbers must ascend; at most two rows share one.
std::vector<std::array<double, 4>> read_rows(const nlohmann::json& preset, const char* key,
                                             const std::string& name) {
    const nlohmann::json& flat = preset.at(key);
    if (!flat.is_array() || flat.empty() || flat.size() % 4 != 0) {
        fail("{}: {} has {} numbers, expected four for every point", name, key, flat.size());
    }
    if (flat.size() / 4 > most_scene_points) {
        fail("{}: {} has {} points, expected at most {}", name, key, flat.size() / 4,
             most_scene_points);
    }
    std::vector<std::array<double, 4>> rows(flat.size() / 4);
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const double number = flat[i].is_number() ? flat[i].get<double>() : NAN;
        if (!(std::abs(number) <= 1e300)) {
            fail("{}: {}[{}] is {}, expected a number", name, key, i, shown(flat[i]));
        }
        if (i % 4 > 0 && (number < 0 || number > 1)) {
            fail("{}: {}[{}] is {}, expected a number from 0 to 1", name, key, i, number);
        }
        rows[i / 4][i % 4] = number;
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        if (rows[i][0] < rows[i - 1][0]) {
            fail("{}: {}[{}] is {}, expected at least {}, the scalar before it", name, key, 4 * i,
                 rows[i][0], rows[i - 1][0]);
        }
        if (i > 1 && rows[i][0] == rows[i - 2][0]) {
            fail("{}: {}[{}] is {} for the third time, expected at most two points at a scalar",
                 name, key, 4 * i, rows[i][0]);
        }
    }
    return rows;
}

// Samples a preset between two of its points: halves the interval until lines in the wanted space
// are within preset_tolerance of the colours at three places.
class SegmentSampler {
  public:
    SegmentSampler(ColorSpace space, ImageColorSpace wanted, const std::array<double, 4>& a,
                   const std::array<double, 4>& b)
        : space_(space), wanted_(wanted), a_(a), b_(b) {}

    void append(double lo, double hi, int halvings, std::vector<ColorPoint>& points) const {
        if (halvings > 0 && !straight(lo, hi)) {
            append(lo, (lo + hi) / 2, halvings - 1, points);
            append((lo + hi) / 2, hi, halvings - 1, points);
        } else {
            points.push_back({hi < 1 ? a_[0] + hi * (b_[0] - a_[0]) : b_[0], color(hi)});
        }
    }

  private:
    glm::dvec3 color(double share) const {
        const glm::dvec3 from(a_[1], a_[2], a_[3]), to(b_[1], b_[2], b_[3]);
        // The ends are returned unchanged, without a round trip through other colour spaces.
        if (share == 1) return color_of_display(to, wanted_);
        if (share == 0) return color_of_display(from, wanted_);
        return color_of_display(interpolate_srgb(space_, from, to, share), wanted_);
    }

    bool straight(double lo, double hi) const {
        const glm::dvec3 from = color(lo), to = color(hi);
        for (const double share : {0.25, 0.5, 0.75}) {
            const glm::dvec3 gap =
                glm::abs(color(glm::mix(lo, hi, share)) - glm::mix(from, to, share));
            if (std::max({gap.r, gap.g, gap.b}) > preset_tolerance) return false;
        }
        return true;
    }

    ColorSpace space_;
    ImageColorSpace wanted_;
    const std::array<double, 4>& a_;
    const std::array<double, 4>& b_;
};

std::vector<ColorPoint> sample_colors(ColorSpace space, ImageColorSpace wanted,
                                      const std::vector<std::array<double, 4>>& rows) {
    const auto color_of = [&](const std::array<double, 4>& row) {
        return color_of_display(glm::dvec3(row[1], row[2], row[3]), wanted);
    };
    std::vector<ColorPoint> points = {{rows[0][0], color_of(rows[0])}};
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const auto &a = rows[i - 1], &b = rows[i];
        if (a[0] == b[0]) {
            points.push_back({b[0], color_of(b)});
        } else if (space == ColorSpace::step) {
            // An interval has its upper point's colour; below the first point the first one holds.
            points.push_back({a[0], color_of(b)});
            points.push_back({b[0], color_of(b)});
        } else {
            SegmentSampler(space, wanted, a, b).append(0, 1, most_halvings, points);
        }
    }
    return points;
}

std::vector<OpacityPoint> read_opacities(const nlohmann::json& preset, const std::string& name) {
    std::vector<OpacityPoint> points;
    const auto rows = read_rows(preset, "Points", name);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [value, opacity, midpoint, sharpness] = rows[i];
        if (midpoint != 0.5 || sharpness != 0) {
            fail(
                "{}: point {} of Points has midpoint {} and sharpness {}, only 0.5 and 0 are "
                "supported",
                name, i, midpoint, sharpness);
        }
        points.push_back({value, opacity});
    }
    return points;
}

// Returns the quantity just below and just above `value`, interpolated by mix(a, b, share).
template <typename Point, typename Mix>
auto limits(const std::vector<Point>& points, double value, const Mix& mix) {
    const auto not_below = std::ranges::lower_bound(points, value, {}, &Point::value);
    const auto above = std::ranges::upper_bound(points, value, {}, &Point::value);
    const auto at = [&](const Point& point) { return mix(point, point, 0.0); };
    if (not_below != above) return std::pair(at(*not_below), at(*(above - 1)));
    if (above == points.begin()) return std::pair(at(*above), at(*above));
    if (above == points.end()) return std::pair(at(points.back()), at(points.back()));
    const Point& a = *(above - 1);
    const auto between = mix(a, *above, (value - a.value) / (above->value - a.value));
    return std::pair(between, between);
}

bool is_smooth(const std::vector<ExtinctionPoint>& extinctions, double value) {
    const auto there = std::ranges::lower_bound(extinctions, value, {}, &ExtinctionPoint::value);
    return there != extinctions.end() && there->value == value && there->smooth;
}

constexpr std::string_view suffix = ".json";

const EmbeddedFile* find(const std::string& name) {
    const auto files = embedded_colormaps();
    const auto found = std::ranges::find_if(
        files, [&](const EmbeddedFile& file) { return file.name == name + std::string(suffix); });
    return found == files.end() ? nullptr : &*found;
}

}  // namespace

Colormap read_paraview_colormap(const std::filesystem::path& file, ImageColorSpace space) {
    return colormap_of(load(file), file.string(), space);
}

Colormap colormap_of(const nlohmann::json& preset, const std::string& name, ImageColorSpace space) {
    const auto log_scale = preset.find("UseLogScale");
    if (log_scale != preset.end() && *log_scale != 0 && *log_scale != false) {
        fail("{}: UseLogScale is {}, only linear colour maps are supported", name,
             shown(*log_scale));
    }
    if (!preset.contains("RGBPoints")) {
        fail("{}: RGBPoints is missing, expected [x, red, green, blue, ...]", name);
    }
    Colormap colormap;
    colormap.colors =
        sample_colors(color_space(preset, name), space, read_rows(preset, "RGBPoints", name));
    if (preset.contains("Points")) colormap.opacities = read_opacities(preset, name);
    return colormap;
}

void stretch(Colormap& colormap, double lo, double hi) {
    const double from = colormap.colors.front().value, to = colormap.colors.back().value;
    assert(from < to && lo < hi);
    const auto stretched = [&](double value) {
        return lo + (hi - lo) * ((value - from) / (to - from));
    };
    for (ColorPoint& point : colormap.colors) point.value = stretched(point.value);
    for (OpacityPoint& point : colormap.opacities) point.value = stretched(point.value);
}

std::vector<TransferKnot> combine(const Colormap& colormap,
                                  const std::vector<ExtinctionPoint>& extinctions) {
    if (extinctions.empty()) fail("no points with extinctions, expected at least one");
    std::vector<double> values;
    for (const ColorPoint& point : colormap.colors) values.push_back(point.value);
    for (const ExtinctionPoint& point : extinctions) values.push_back(point.value);
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());

    const auto mix_colors = [](const ColorPoint& a, const ColorPoint& b, double share) {
        return glm::mix(a.color, b.color, share);
    };
    const auto mix_extinctions = [](const ExtinctionPoint& a, const ExtinctionPoint& b,
                                    double share) {
        return a.extinction * (1 - share) + b.extinction * share;
    };
    std::vector<TransferKnot> knots;
    for (const double value : values) {
        const auto [color_below, color_above] = limits(colormap.colors, value, mix_colors);
        const auto [below, above] = limits(extinctions, value, mix_extinctions);
        knots.push_back({value, {color_below, below}, is_smooth(extinctions, value)});
        if (color_below != color_above || below != above) {
            knots.push_back({value, {color_above, above}});
        }
    }
    return knots;
}

std::vector<TransferKnot> combine(const Colormap& colormap, double unit_length) {
    if (colormap.opacities.empty()) {
        fail(
            "the colour map has no opacities (Points), expected points with extinction or opacity");
    }
    std::vector<ExtinctionPoint> extinctions;
    for (const TransferKnot& knot : linear_in_opacity(given_points(colormap), unit_length))
        extinctions.push_back({knot.value, knot.optics.extinction, knot.smooth});
    return combine(colormap, extinctions);
}

std::vector<GivenPoint> given_points(const Colormap& colormap) {
    std::vector<GivenPoint> given;
    for (const OpacityPoint& point : colormap.opacities)
        given.push_back({point.value, {}, GivenPoint::Density::opacity, point.opacity});
    return given;
}

std::vector<std::string> colormap_names() {
    std::vector<std::string> names;
    for (const EmbeddedFile& file : embedded_colormaps())
        names.emplace_back(file.name.substr(0, file.name.size() - suffix.size()));
    return names;
}

bool is_colormap_name(const std::string& name) {
    return find(name) != nullptr;
}

Colormap load_colormap(const std::string& name_or_path, ImageColorSpace space) {
    if (const EmbeddedFile* const file = find(name_or_path)) {
        const nlohmann::json preset = parse_json(std::string(file->text));
        Colormap colormap = colormap_of(preset, name_or_path, space);
        colormap.own_range = preset.contains("Units");
        return colormap;
    }
    expect_allowed(name_or_path);
    std::error_code unknown;
    if (!std::filesystem::exists(name_or_path, unknown)) {
        const auto names = colormap_names();
        const std::string word = std::filesystem::path(name_or_path).filename().string();
        fail("{}: no such file, and no colour map has that name{}", shortened(name_or_path),
             suggestion({names.begin(), names.end()}, word));
    }
    return read_paraview_colormap(name_or_path, space);
}

}  // namespace lamina
