// SPDX-License-Identifier: Apache-2.0
#include "choice/surfaces.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <optional>
#include <span>

#include "base/error.h"
#include "choice/field.h"
#include "choice/materials.h"
#include "choice/variation.h"
#include "image/coded_image.h"

namespace lamina {

namespace {

using Colors = std::span<const glm::dvec3>;

// Colours in linear light. No component is 1, so that no picture is saturated by them. `upwards`
// goes from values next to the common ones to the rarest, `downwards` and `beyond` do if values
// below and above show.
constexpr std::array<glm::dvec3, 6> upwards{{{.0203, .0513, .212},
                                             {.0284, .238, .381},
                                             {.275, .521, .347},
                                             {.815, .552, .144},
                                             {.745, .195, .0497},
                                             {.922, .799, .597}}};
constexpr std::array<glm::dvec3, 4> downwards{
    {{.0203, .0513, .212}, {.0284, .238, .381}, {.212, .552, .527}, {.716, .863, .791}}};
constexpr std::array<glm::dvec3, 4> beyond{
    {{.195, .0437, .0273}, {.565, .109, .0437}, {.815, .456, .144}, {.922, .799, .597}}};
// From the lowest to the highest values of data without a background.
constexpr std::array<glm::dvec3, 6> cool_to_warm{{{.040, .120, .450},
                                                  {.120, .380, .680},
                                                  {.450, .650, .720},
                                                  {.750, .620, .450},
                                                  {.700, .220, .080},
                                                  {.400, .020, .030}}};
constexpr glm::dvec3 outline_color{.254, .275, .319};  // of common values that show faintly

// Colours of one, two, three and four materials by value: what is densest is ivory, like bone; what
// surrounds it is warm, like skin.
constexpr glm::dvec3 sand{.694, .456, .275}, skin{.584, .266, .147}, ivory{.863, .791, .624};
constexpr glm::dvec3 ochre{.571, .328, .122}, rust{.392, .0802, .0452}, teal{.114, .332, .292};
constexpr std::array<std::array<glm::dvec3, most_materials>, most_materials> material_colors{
    {{sand}, {skin, ivory}, {ochre, rust, ivory}, {ochre, teal, rust, ivory}}};
// Opacities of their surfaces: outer ones let inner ones show.
constexpr std::array<std::array<double, most_materials>, most_materials> material_opacities{
    {{.95}, {.4, .97}, {.25, .5, .97}, {.2, .35, .5, .97}}};

// Surfaces of a smooth field enclose these shares of all that is uncommon: each a third of the one
// around it. Their opacities grow inwards.
constexpr std::array<double, 4> enclosed{.45, .16, .05, .012};
constexpr std::array<double, 4> level_opacities{.22, .32, .5, .93};
constexpr double solid_level = .7;  // least place of the first of them in a thing of one material
constexpr double widest = .3;  // half width of a peak, relative to the distance to the next level
constexpr double least_distance = 4;    // bins between two levels
constexpr double least_width = .75;     // bins, of half a peak
constexpr double noise_coherence = .5;  // share of coherent places below which values are noise
constexpr int histogram_bins = 256;
// Share of uncommon values below which a side shows nothing: it is noise, or the foot of a peak.
constexpr double least_side = .05;
// Opacity of the median ray by the outline of a mesh.
constexpr double outline_opacity = .5;
// Opacity of a mesh that is shown as a body, over this share of the data's diagonal: walls of
// sheets are thin.
constexpr double body_opacity = .95, body_length = 1e-3;
// Opacity of one slice of samples across it, and its colours: levels of an sRGB display from black
// to below white, joined by lines in linear light that are off by less than half a code of 8 bits.
constexpr double slice_opacity = .999, lightest = .95;
constexpr int slice_greys = 32;
constexpr int body_ranks = 24;  // values of a body's colours, each with as much of the field
// Share of data without a background that shows at each end of the values, and opacity and places
// among the colours of the surface in front of it.
constexpr double shown_end = .1, end_opacity = .95, low_place = .2, high_place = .75;
constexpr double least_end = 2;  // bins, of an end of the values
// A material and a background are two halves of one thing if both take less than this share of the
// field, and the material takes more than the rest.
constexpr double most_of_half = .6;
constexpr double even_slopes = .95;  // least evenness of the gradients of a distance
constexpr double sheet_path = .15;   // longest median path through sheets, in diagonals of the data

glm::dvec3 color_at(Colors colors, double place) {
    const double scaled = place * static_cast<double>(colors.size() - 1);
    const auto first = std::min(static_cast<std::size_t>(scaled), colors.size() - 2);
    return glm::mix(colors[first], colors[first + 1], scaled - static_cast<double>(first));
}

// A value around which extinction has a peak, so that its isosurface shows.
struct Level {
    double value = 0;
    double half_width = 0;  // > 0, of the peak, in values
    double opacity = 0;     // less than 1, of a ray that crosses the surface once, head-on
    glm::dvec3 color{0};    // from here to the next level
};

// World lengths that extinctions follow from.
struct LevelLengths {
    double thickness = 1;  // over which the inside of a thing gets half the depth of its surface
    double range = 1;  // over which values may change by their whole range, if slopes are unknown
};

// Least mean slope, in ranges of values over LevelLengths::range: extinctions stay finite.
constexpr double least_slope = 1;

double slope_at(double value, const Variation& variation, const LevelLengths& lengths) {
    const double least = least_slope * (variation.hi() - variation.lo()) / lengths.range;
    return std::max(variation.slope(variation.bin_of(value)), least);
}

// Returns the points that show levels: ascending, on the way from transparent values to `end`. The
// last level is dense up to `end`. Extinctions are per world unit: a ray that crosses a peak meets
// it for as long as the mean slope at that value says.
//
// A peak is a triangle: its integral over values is the extinction at its top times half_width. A
// ray crosses the values of the peak on a length of their width over the slope.
std::vector<TransferKnot> points_of_levels(const std::vector<Level>& levels, double end,
                                           const glm::dvec3& end_color, const Variation& variation,
                                           const LevelLengths& lengths) {
    std::vector<TransferKnot> points;
    const auto add = [&](double value, const glm::dvec3& color, double extinction) {
        if (points.empty() || value > points.back().value)
            points.push_back({value, {color, extinction}});
    };
    double inside = 0;  // extinction between two peaks
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Level& level = levels[i];
        const double depth = -std::log1p(-level.opacity);
        const double top = depth * slope_at(level.value, variation, lengths) / level.half_width;
        add(level.value - level.half_width, i > 0 ? levels[i - 1].color : level.color, inside);
        add(level.value, level.color, top);
        inside = std::min(depth / (2 * lengths.thickness), top);
        if (i + 1 < levels.size()) {
            add(level.value + level.half_width, level.color, inside);
        } else {
            add(end, end_color, top);
        }
    }
    return points;
}

// The values with how the field varies around them.
struct Surroundings {
    ValueHistogram histogram;
    Variation variation;
    LevelLengths lengths;
    double bin;  // width

    static Surroundings of(const ValueDistribution& values, bool whole_numbers,
                           const TransferSubject& subject) {
        const ValueRange range = usual_range(values);
        const ValueHistogram histogram =
            binned(values.between(range.lo, range.hi), range, whole_numbers, histogram_bins);
        const double lo = histogram.lo, hi = histogram.hi;
        const Variation bins(lo, hi, histogram.shares.size());
        const double diagonal = subject.field != nullptr ? diagonal_of(*subject.field) : 1;
        return {histogram,
                subject.field != nullptr
                    ? subject.field->variation({values.lowest(), values.highest()}, bins)
                    : bins,
                {diagonal / 4, diagonal},
                (hi - lo) / static_cast<double>(histogram.shares.size())};
    }

    // Returns the value from `start` on, going up (sign 1) or down (-1) to `end`, from which on
    // places are coherent: `start` itself if there is no noise, or nothing else.
    double end_of_noise(double start, double end, int sign) const {
        if (variation.empty()) return start;
        const auto last = static_cast<std::ptrdiff_t>(variation.bin_of(end));
        auto at = static_cast<std::ptrdiff_t>(variation.bin_of(start)) + sign;
        const std::ptrdiff_t first = at;
        for (; sign * (last - at) > 0; at += sign) {
            if (variation.coherence(static_cast<std::size_t>(at)) < noise_coherence) continue;
            return at == first ? start : variation.value(static_cast<std::size_t>(at));
        }
        return start;
    }
};

// The uncommon values on one side of the common ones: above (sign 1) or below (-1). `end` is the
// last one, which may be far off.
struct Side {
    ValueDistribution values;
    double start = 0, end = 0;
    int sign = 1;

    static Side above(const ValueDistribution& all, double start) {
        return {all.between(std::nextafter(start, INFINITY), all.highest()), start, all.highest(),
                1};
    }
    static Side below(const ValueDistribution& all, double start) {
        return {all.between(all.lowest(), std::nextafter(start, -INFINITY)), start, all.lowest(),
                -1};
    }
    bool empty() const { return values.empty() || start == end; }
    // Returns the value beyond which this share of the side lies.
    double enclosing(double share) const {
        return sign > 0 ? values.quantile(1 - share) : values.quantile(share);
    }
};

// Values of surfaces of a side, outwards.
struct LevelValues {
    std::vector<double> values;
    bool solid = false;  // most values are near the end, as in a thing of one material
};

// `from_start`: the first surface is that of the values next to the start.
LevelValues level_values(const Side& side, double bin, double usual_end, bool from_start) {
    const double distance = std::abs(usual_end - side.start);
    const double step = std::min(bin, distance / 20);
    std::vector<double> distances;
    LevelValues found;
    if (from_start) distances.push_back(distance / 20);
    for (const double share : std::span(enclosed).subspan(from_start ? 1 : 0)) {
        const double there = side.sign * (side.enclosing(share) - side.start);
        double level = std::clamp(there, 2 * step, distance - 2.5 * step);
        if (distances.empty() && there >= distance - step / 2) {
            level = distance / 2;  // all values are at the end: the surface lies in between
            found.solid = true;
        } else if (distances.empty() && level > solid_level * distance) {
            distances.push_back(level / 5);
            found.solid = true;
        }
        if (distances.empty() || level > distances.back() + least_distance * step)
            distances.push_back(level);
    }
    // The surface below a solid thing may be one too many.
    if (distances.size() > level_opacities.size()) distances.erase(distances.begin() + 1);
    for (const double one : distances) found.values.push_back(side.start + side.sign * one);
    return found;
}

void negate(std::vector<TransferKnot>& points) {
    for (TransferKnot& point : points) point.value = -point.value;
    std::ranges::reverse(points);
}

std::vector<TransferKnot> points_of_side(Side side, Colors colors, const Surroundings& around,
                                         bool from_start = false) {
    const double usual_end = side.sign > 0 ? std::min(side.end, around.histogram.most)
                                           : std::max(side.end, around.histogram.least);
    if (side.sign * (usual_end - side.start) <= 0) return {};
    const double start =
        from_start ? side.start : around.end_of_noise(side.start, usual_end, side.sign);
    if (start != side.start) {
        const Side beyond_noise =
            side.sign > 0 ? Side::above(side.values, start) : Side::below(side.values, start);
        if (!beyond_noise.empty()) side = beyond_noise;
    }
    const auto [values, solid] = level_values(side, around.bin, usual_end, from_start);
    const std::array<glm::dvec3, 2> one_color{sand, sand};
    if (solid) colors = one_color;
    const double step = std::min(around.bin, std::abs(usual_end - side.start) / 20);
    std::vector<Level> levels;
    const std::size_t count = values.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double before = std::abs(values[i] - (i > 0 ? values[i - 1] : side.start));
        const double after = std::abs((i + 1 < count ? values[i + 1] : usual_end) - values[i]);
        const double half = std::max(widest * std::min(before, after), least_width * step);
        levels.push_back(
            {values[i], half, level_opacities[i + level_opacities.size() - count],
             color_at(colors, (static_cast<double>(i) + .5) / static_cast<double>(count))});
    }
    if (side.sign > 0)
        return points_of_levels(levels, usual_end, colors.back(), around.variation, around.lengths);
    for (Level& level : levels) level.value = -level.value;
    auto points = points_of_levels(levels, -usual_end, colors.back(), around.variation.negated(),
                                   around.lengths);
    negate(points);
    return points;
}

// Returns the extinction with which a path of this length has an opacity.
double veil_extinction(double opacity, double path) {
    return path > 0 ? -std::log1p(-opacity) / path : 0;
}

// Shows common values as a faint outline, and all others at least as much.
void add_outline(std::vector<TransferKnot>& points, const CommonValues& common,
                 const TransferSubject& subject) {
    const double extinction = veil_extinction(outline_opacity, subject.median_path());
    for (TransferKnot& point : points)
        point.optics.extinction = std::max(point.optics.extinction, extinction);
    std::erase_if(points, [&](const TransferKnot& point) {
        return point.value >= common.lo && point.value <= common.hi;
    });
    const auto behind =
        std::ranges::find_if(points, [&](const TransferKnot& p) { return p.value > common.hi; });
    std::vector<TransferKnot> flat{{common.lo, {outline_color, extinction}}};
    if (common.hi > common.lo) flat.push_back({common.hi, {outline_color, extinction}});
    points.insert(behind, flat.begin(), flat.end());
}

std::string number_of(double value, const ValueDistribution& values) {
    return number_text(value, fineness_of(values.lowest(), values.highest()));
}

// Tells whether most of the field is background above the middle of the range, as in an inverted
// picture: then materials are sought among the negated values.
bool is_inverted(const CommonValues& common, const ValueDistribution& values) {
    const double middle = values.lowest() / 2 + values.highest() / 2;
    return common.background && common.lo > middle && values.share(common.lo, common.hi) > .5;
}

Surroundings negated(const Surroundings& around) {
    Surroundings result{around.histogram, around.variation.negated(), around.lengths, around.bin};
    std::ranges::reverse(result.histogram.shares);
    result.histogram.least = -around.histogram.most;
    result.histogram.most = -around.histogram.least;
    return result;
}

// Shows materials: humps of the histogram. If they are `inverted`, their values and those of
// `around` are negated.
ChosenSurfaces of_materials(const Materials& found, const Surroundings& around, bool inverted,
                            const ValueDistribution& values) {
    const auto& materials = found.materials;
    const std::size_t count = materials.size();
    const double sign = inverted ? -1 : 1;
    std::vector<Level> levels;
    std::string shown;
    for (std::size_t i = 0; i < count; ++i) {
        const double before = i > 0 ? materials[i - 1].center : found.background;
        const double half = widest * std::min(materials[i].boundary - before,
                                              materials[i].center - materials[i].boundary);
        levels.push_back({materials[i].boundary, std::max(half, least_width * around.bin),
                          material_opacities[count - 1][i], material_colors[count - 1][i]});
        shown += fmt::format("{}{}",
                             i == 0          ? ""
                             : i + 1 < count ? ", "
                                             : " and ",
                             number_of(sign * materials[i].boundary, values));
    }
    const double end = inverted ? -values.lowest() : values.highest();
    auto points =
        points_of_levels(levels, end, levels.back().color, around.variation, around.lengths);
    if (inverted) negate(points);
    const double first = sign * materials.front().boundary;
    const double hidden = inverted ? 1 - values.share_up_to(first) : values.share_below(first);
    return {points,
            fmt::format("{} by humps of the histogram, with {} at {}; values {}, {:.3g} % of the "
                        "field, are transparent",
                        count == 1 ? "one material" : fmt::format("{} materials", count),
                        count == 1 ? "its surface" : "their surfaces", shown,
                        inverted ? "above" : "below", 100 * hidden)};
}

// Shows values beyond the common ones, on one or both sides. A side that would form a shell around
// the measured data, next to padding, shows nothing if the other side shows.
ChosenSurfaces of_smooth_field(const Padding& padding, const CommonValues& common,
                               const Surroundings& around, const TransferSubject& subject) {
    const ValueDistribution& values = padding.rest;
    Side down = Side::below(values, common.lo), up = Side::above(values, common.hi);
    const double below = values.share_below(common.lo), above = 1 - values.share_up_to(common.hi);
    bool downs = !down.empty() && below >= least_side * (below + above);
    bool ups = !up.empty() && above >= least_side * (below + above);
    if (common.background && downs && ups) {
        downs = !padding.shell_below(common.lo);
        ups = !downs || !padding.shell_above(common.hi);
    }
    std::vector<TransferKnot> points;
    if (downs) points = points_of_side(down, ups ? Colors(downwards) : upwards, around);
    if (ups) {
        const auto more = points_of_side(up, downs ? Colors(beyond) : upwards, around);
        points.insert(points.end(), more.begin(), more.end());
    }
    std::string hidden = "are transparent";
    if (subject.field != nullptr && subject.field->ends_at_surface()) {
        add_outline(points, common, subject);
        hidden = "are faint";
    }
    std::string shown;
    if (downs) shown = "down to " + number_of(down.end, values);
    if (ups) shown += (shown.empty() ? "up to " : " and up to ") + number_of(up.end, values);
    return {points, fmt::format("values from {} to {}, {:.3g} % of the field, {}; beyond, {}, "
                                "surfaces show, the farther out the denser",
                                number_of(common.lo, values), number_of(common.hi, values),
                                100 * (1 - padding.share) * values.share(common.lo, common.hi),
                                hidden, shown)};
}

// Tells whether the uncommon values take more of a mesh's surface than of its volume, as at the
// walls of a flow: then they are seen from outside.
bool lies_on_surface(const CommonValues& common, const ValueDistribution& values,
                     const Field& field) {
    return field.surface_outside({common.lo, common.hi}) > 1 - values.share(common.lo, common.hi);
}

// Shows a mesh as an opaque body. Its surface is coloured by the mean of a value's rank, which
// tells common values apart, and of its place in the range, which lets the highest and lowest stand
// out.
ChosenSurfaces of_body(const ValueDistribution& values, const TransferSubject& subject) {
    const double extinction =
        veil_extinction(body_opacity, body_length * diagonal_of(*subject.field));
    std::vector<TransferKnot> points;
    const auto add = [&](double value, double rank) {
        if (!points.empty() && value <= points.back().value) return;
        const double place = (value - values.lowest()) / (values.highest() - values.lowest());
        points.push_back({value, {color_at(cool_to_warm, .5 * (rank + place)), extinction}});
    };
    add(values.lowest(), 0);
    for (int i = 1; i < body_ranks; ++i)
        add(values.quantile(double{1} * i / body_ranks), double{1} * i / body_ranks);
    add(values.highest(), 1);
    return {
        points,
        fmt::format("the mesh is a body, whose surface shows all values from {} to {}, coloured "
                    "by their rank and by their place in this range",
                    number_of(values.lowest(), values), number_of(values.highest(), values))};
}

// Returns the points that show the values beyond `start`, up to the usual ones and beyond, as one
// solid. If the side is the lower one, its values and those of `around` are negated.
std::vector<TransferKnot> points_of_end(double start, double end, double before,
                                        const Surroundings& around,
                                        const std::array<double, 2>& places) {
    const double usual_end = std::min(end, around.histogram.most);
    const double half =
        std::max(widest * std::min(start - before, usual_end - start), least_width * around.bin);
    return points_of_levels({{start, half, end_opacity, color_at(cool_to_warm, places[0])}}, end,
                            color_at(cool_to_warm, places[1]), around.variation, around.lengths);
}

// Shows a field without a background: its lowest and highest values, between which it is open.
ChosenSurfaces of_ends(const ValueDistribution& values, const Surroundings& around) {
    const double least = around.histogram.least, most = around.histogram.most;
    const double margin = std::min(least_end * around.bin, (most - least) / 4);
    const auto start_at = [&](double share) {
        return std::clamp(values.quantile(share), least + margin, most - margin);
    };
    const double low = start_at(shown_end), high = start_at(1 - shown_end);
    const double middle = std::clamp(values.quantile(.5), low, high);
    auto points = points_of_end(-low, -values.lowest(), -middle, negated(around), {low_place, 0});
    negate(points);
    const auto above = points_of_end(high, values.highest(), middle, around, {high_place, 1});
    // Ends that meet leave nothing open, and the higher one shows.
    if (above.front().value <= points.back().value) points.clear();
    points.insert(points.end(), above.begin(), above.end());
    return {points, fmt::format("no value is a background: the lowest values, up to {}, and the "
                                "highest, from {} on, show; all between, {:.3g} % of the field, "
                                "are transparent",
                                number_of(low, values), number_of(high, values),
                                100 * values.share(low, high))};
}

// Tells whether the background and one of the materials fill most of the field, alike.
bool are_halves(const std::vector<Material>& materials) {
    double all = 0, largest = 0;
    for (const Material& one : materials) {
        all += one.share;
        largest = std::max(largest, one.share);
    }
    return 1 - all < most_of_half && largest < most_of_half && largest > 1 - most_of_half;
}

// Tells whether the values are distances from a surface at 0, on one side of it negative.
bool is_distance(const ValueDistribution& values, const Variation& variation) {
    return values.lowest() < 0 && values.highest() > 0 && variation.evenness() > even_slopes;
}

// Shows the smaller side of the surface at 0.
ChosenSurfaces of_distance(const ValueDistribution& values, const Surroundings& around) {
    const bool below = values.share_below(0) <= .5;
    const double end = below ? -values.lowest() : values.highest();
    auto points = points_of_levels(
        {{0, std::max(end / 20, least_width * around.bin), end_opacity, sand}}, end, sand,
        below ? around.variation.negated() : around.variation, around.lengths);
    if (below) negate(points);
    return {points, fmt::format("values are distances from a surface at 0, which shows with what "
                                "lies {} it, {:.3g} % of the field",
                                below ? "below" : "above",
                                100 * (below ? values.share_below(0) : 1 - values.share_up_to(0)))};
}

std::optional<SliceAxes> slice_of(const TransferSubject& subject) {
    return subject.field == nullptr ? std::nullopt : subject.field->slice();
}

// Shows one slice as a picture: opaque and grey, from the lowest to the highest usual value.
// `range`: of these values.
ChosenSurfaces of_slice(const ValueRange& range, const ValueDistribution& values,
                        const SliceAxes& slice) {
    const double extinction = veil_extinction(slice_opacity, slice.thickness);
    std::vector<TransferKnot> points;
    for (int i = 0; i <= slice_greys; ++i) {
        const double place = double{1} * i / slice_greys;
        const double value = std::lerp(range.lo, range.hi, place);
        if (!points.empty() && value <= points.back().value) continue;
        points.push_back({value, {glm::dvec3(linear_from_srgb(lightest * place)), extinction}});
    }
    return {points, fmt::format("one slice shows as a picture, in greys from {} to {}",
                                number_of(range.lo, values), number_of(range.hi, values))};
}

}  // namespace

bool is_sheet(const TransferSubject& subject) {
    if (subject.field == nullptr || !subject.field->ends_at_surface()) return false;
    return subject.median_path() < sheet_path * diagonal_of(*subject.field);
}

ChosenSurfaces choose_surfaces(const Padding& padding, bool whole_numbers,
                               const TransferSubject& subject) {
    const ValueDistribution& values = padding.rest;
    if (const auto slice = slice_of(subject)) return of_slice(usual_range(values), values, *slice);
    const CommonValues common = find_common_values(values, whole_numbers);
    const Surroundings around = Surroundings::of(values, whole_numbers, subject);
    const bool is_volume = subject.field != nullptr && !subject.field->ends_at_surface();
    bool halves = false;
    if (is_volume) {
        if (is_distance(values, around.variation)) return of_distance(values, around);
        const bool inverted = is_inverted(common, values);
        const Surroundings sought = inverted ? negated(around) : around;
        const Materials found =
            find_materials(sought.histogram, sought.variation, subject.field->spacing());
        halves = values.distinct() > 2 && are_halves(found.materials);
        if (!found.materials.empty() && !halves)
            return of_materials(found, sought, inverted, values);
    }
    if (halves || (is_volume && !common.background)) return of_ends(values, around);
    if (subject.field != nullptr && !is_volume &&
        (!common.background || lies_on_surface(common, values, *subject.field)))
        return of_body(values, subject);
    return of_smooth_field(padding, common, around, subject);
}

ChosenSurfaces choose_surfaces_within(const ValueDistribution& values, const ValueRange& range,
                                      bool whole_numbers, const TransferSubject& subject) {
    const ValueDistribution inside = values.between(range.lo, range.hi);
    if (inside.distinct() < 2) return {};
    if (const auto slice = slice_of(subject)) {
        ChosenSurfaces picture = of_slice(range, inside, *slice);
        picture.points.insert(picture.points.begin(), {range.lo, {}});  // nothing shows below it
        return picture;
    }
    const Surroundings around = Surroundings::of(inside, whole_numbers, subject);
    Side side = Side::above(inside, range.lo);
    if (side.empty()) return {};
    std::vector<TransferKnot> points = points_of_side(side, upwards, around, true);
    if (points.empty()) return {};
    if (points.front().value > range.lo) {
        points.insert(points.begin(), {range.lo, {points.front().optics.color, 0}});
    }
    if (points.back().value < range.hi) points.push_back({range.hi, points.back().optics});
    return {points, fmt::format("values from {} to {} show, as wished", range.lo, range.hi)};
}

}  // namespace lamina
