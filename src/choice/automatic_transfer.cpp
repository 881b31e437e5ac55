// SPDX-License-Identifier: Apache-2.0
#include "choice/automatic_transfer.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "choice/field.h"

namespace lamina {

namespace {

// Opacity of the median ray through labels: the first label of a ray hides most of the others, so
// that their colours do not mix.
constexpr double label_opacity = .999;
constexpr std::size_t most_labels = 24;  // up to as many different whole numbers are labels

// Colours in linear light: of data with a single value, and of a range without values.
constexpr glm::dvec3 only_color{.86, .45, .10}, low_color{.035, .10, .30},
    high_color{.92, .80, .55};

TransferFunction normalized(std::vector<TransferKnot> points) {
    double largest = 0;
    for (const TransferKnot& point : points) largest = std::max(largest, point.optics.extinction);
    for (TransferKnot& point : points) point.optics.extinction /= largest;
    return TransferFunction::linear(points);
}

AutomaticTransfer one_value(double value) {
    return {TransferFunction::linear({{value, {only_color, 1}}}),
            fmt::format("all values are {:.9g}, which shows everywhere", value)};
}

AutomaticTransfer with_surfaces(const ChosenSurfaces& chosen) {
    AutomaticTransfer result{TransferFunction::linear(chosen.points), chosen.reason};
    result.per_world_unit = true;
    return result;
}

AutomaticTransfer within(const ValueDistribution& values, const ValueRange& range,
                         bool whole_numbers, const TransferSubject& subject) {
    const ChosenSurfaces chosen = choose_surfaces_within(values, range, whole_numbers, subject);
    if (!chosen.points.empty()) return with_surfaces(chosen);
    return {normalized({{range.lo, {low_color, 0}}, {range.hi, {high_color, 1}}}),
            fmt::format("values from {} to {} show, as wished", range.lo, range.hi)};
}

// Return the function made transparent below (shown_above) or above (shown_below) a value.
TransferFunction shown_above(const TransferFunction& function, double value) {
    if (function.transparent(std::numeric_limits<double>::lowest(), value)) return function;
    const OpticalProperties optics = function.at(value);
    std::vector<TransferKnot> points{{value, {optics.color, 0}}, {value, optics}};
    std::ranges::copy_if(function.knots(), std::back_inserter(points),
                         [&](const TransferKnot& knot) { return knot.value > value; });
    return TransferFunction::linear(points);
}

TransferFunction shown_below(const TransferFunction& function, double value) {
    if (function.transparent(value, std::numeric_limits<double>::max())) return function;
    const OpticalProperties optics = function.at(value);
    std::vector<TransferKnot> points;
    std::ranges::copy_if(function.knots(), std::back_inserter(points),
                         [&](const TransferKnot& knot) { return knot.value < value; });
    points.push_back({value, optics});
    points.push_back({value, {optics.color, 0}});
    return TransferFunction::linear(points);
}

// Returns the sentence on padding; empty if there is none.
std::string padding_text(const Padding& padding) {
    std::string text;
    for (const double value : padding.values)
        text += fmt::format("{}{:.9g}", text.empty() ? "" : " and ", value);
    if (text.empty()) return text;
    const bool several = padding.values.size() > 1;
    return fmt::format(
        "{}, {:.3g} % of the field, {} padding, which the chosen transfer function does not show",
        text, 100 * padding.share, several ? "are" : "is");
}

// Colours of the first labels in linear light; neighbours differ in hue.
constexpr std::array<glm::dvec3, 8> label_colors{{{.75, .20, .05},
                                                  {.06, .30, .65},
                                                  {.80, .55, .08},
                                                  {.10, .45, .15},
                                                  {.45, .12, .50},
                                                  {.08, .50, .50},
                                                  {.75, .30, .40},
                                                  {.70, .65, .55}}};

// Returns the colour of the label of this number. Beyond label_colors, hues of OKLab (Ottosson
// 2020) lie a golden angle apart, so that new ones fall between those before, at three lightnesses.
glm::dvec3 label_color(std::size_t number) {
    if (number < label_colors.size()) return label_colors[number];
    constexpr std::array<double, 3> lightnesses{.64, .80, .55};
    constexpr double chroma = .16, golden_angle = 2.399963229728653, largest = .9;
    const double hue = golden_angle * static_cast<double>(number);
    const double lightness = lightnesses[number % lightnesses.size()];
    const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const double l = std::pow(lightness + .3963377774 * a + .2158037573 * b, 3);
    const double m = std::pow(lightness - .1055613458 * a - .0638541728 * b, 3);
    const double s = std::pow(lightness - .0894841775 * a - 1.2914855480 * b, 3);
    return glm::clamp(glm::dvec3(4.0767416621 * l - 3.3077115913 * m + .2309699292 * s,
                                 -1.2684380046 * l + 2.6097574011 * m - .3413193965 * s,
                                 -.0041960863 * l - .7034186147 * m + 1.7076147010 * s),
                      0.0, largest);
}

// Returns the extinction for a share of all shown labels: rare ones are up to ten times denser.
double extinction_of(double share) {
    return std::pow(std::max(share, .01), -.5);
}

// The labels that a volume has, with what its file says of them.
class LabelTable {
  public:
    // `said` may be null. `around`: the value around the data, if there is one.
    LabelTable(const ValueDistribution& values, const VolumeLabels* said,
               const std::optional<double>& around)
        : values_(values), said_(said), around_(around), of_value_(values.distinct(), nullptr) {
        for (std::size_t i = 0; said != nullptr && i < of_value_.size(); ++i) {
            const auto found = std::ranges::lower_bound(said->list, value(i), {}, &Label::code);
            if (found != said->list.end() && found->code == value(i)) of_value_[i] = &*found;
        }
    }

    std::size_t size() const { return of_value_.size(); }
    double value(std::size_t i) const { return values_.value(i); }
    double share(std::size_t i) const { return values_.share(value(i), value(i)); }
    // Returns what the file says; null if it says nothing.
    const Label* label(std::size_t i) const { return of_value_[i]; }
    // Returns the file's number for a label, as text and, of 64 bits, as a number.
    std::string number_text(std::size_t i) const {
        return label(i) != nullptr ? label(i)->number : fmt::format("{:g}", value(i));
    }
    long double number(std::size_t i) const {
        return label(i) != nullptr ? std::strtold(label(i)->number.c_str(), nullptr) : value(i);
    }

    // Returns the place of the background. Of what the file calls labels, that is the most frequent
    // value if it is negative, as programs mark voxels without a label, else the label 0, else the
    // one around the data, else the most frequent value of several. Of other values it is the one
    // around the data, else the most frequent one.
    std::optional<std::size_t> background() const {
        std::size_t common = 0;
        for (std::size_t i = 1; i < size(); ++i)
            if (share(i) > share(common)) common = i;
        const std::optional<std::size_t> outside = surrounding();
        if (said_ == nullptr) return outside.value_or(common);
        if (number(common) < 0) return common;
        for (std::size_t i = 0; i < size(); ++i)
            if (number(i) == 0) return i;
        return size() > 1 ? std::optional(outside.value_or(common)) : std::nullopt;
    }
    // Returns the place of the value around the data; nothing if there is none, or if the file
    // names it.
    std::optional<std::size_t> surrounding() const {
        for (std::size_t i = 0; around_ && i < size(); ++i)
            if (value(i) == *around_)
                return label(i) == nullptr || label(i)->name.empty() ? std::optional(i)
                                                                     : std::nullopt;
        return std::nullopt;
    }

  private:
    const ValueDistribution& values_;
    const VolumeLabels* said_;
    const std::optional<double> around_;
    std::vector<const Label*> of_value_;
};

// Returns the sentence on what labels show.
std::string label_text(const LabelTable& labels, bool known, std::optional<std::size_t> background,
                       std::optional<std::size_t> margin, const std::optional<ValueRange>& range) {
    std::string text = fmt::format("{} {}", labels.size(),
                                   !known               ? "whole numbers look like labels"
                                   : labels.size() == 1 ? "label"
                                                        : "labels");
    if (background) {
        text += fmt::format(": {}, {:.3g} % of the field, is transparent",
                            labels.number_text(*background), 100 * labels.share(*background));
    }
    if (margin)
        text += fmt::format(", and so is {}, which lies around the others",
                            labels.number_text(*margin));
    if (labels.size() == 1)
        return text + (background ? ", so that nothing shows" : ", which shows everywhere");
    if (range)
        return text + fmt::format(", labels from {} to {} show, as wished", range->lo, range->hi);
    return text + ", each of the others has a colour";
}

// Returns the sentence on a margin, which is hidden although nobody said so, and on how it shows.
std::string margin_text(const LabelTable& labels, std::size_t margin) {
    return fmt::format(
        "label {} has no name and covers all outer faces, so it is taken for a margin and not "
        "shown: --range {},{} shows it, too",
        labels.number_text(margin), labels.number_text(0), labels.number_text(labels.size() - 1));
}

// Returns the place of the label that lies around the others, a margin, and is not the background;
// nothing if no other one is left.
std::optional<std::size_t> margin_of(const LabelTable& labels,
                                     const std::optional<std::size_t>& background) {
    const std::optional<std::size_t> around = labels.surrounding();
    return background && around != background && labels.size() > 2 ? around : std::nullopt;
}

// Returns a transfer function for labels: background and margin are transparent (a range asks for
// labels, so the one around the data is neither because it lies there); each of the others has the
// file's colour and opacity (`said`, or null) or a colour that reaches halfway to its neighbours.
// `range`: numbers of the file that show; all if empty.
AutomaticTransfer label_transfer(const ValueDistribution& values, const VolumeLabels* said,
                                 const std::optional<ValueRange>& range,
                                 const std::optional<double>& around) {
    const LabelTable labels(values, said, range ? std::nullopt : around);
    const std::optional<std::size_t> background = labels.background();
    const std::optional<std::size_t> margin = margin_of(labels, background);
    double shown = 1;
    for (const auto& hidden : {background, margin})
        if (hidden) shown -= labels.share(*hidden);
    std::vector<TransferKnot> points;
    double largest = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        OpticalProperties optics;
        const bool wished =
            !range || (labels.number(i) >= range->lo && labels.number(i) <= range->hi);
        if (wished && i != background && i != margin) {
            const std::size_t before = background && *background < i ? 1 : 0;
            optics = {label_color(i - before), extinction_of(labels.share(i) / shown)};
            if (const Label* const label = labels.label(i)) {
                optics.color = label->color.value_or(optics.color);
                optics.extinction *= label->opacity;
            }
        }
        largest = std::max(largest, optics.extinction);
        points.push_back({labels.value(i), optics});
    }
    for (TransferKnot& point : points)
        if (largest > 0) point.optics.extinction /= largest;
    return {TransferFunction::nearest(points),
            label_text(labels, said != nullptr, background, margin, range),
            margin ? margin_text(labels, *margin) : "", false, label_opacity};
}

std::optional<double> value_around(const TransferSubject& subject) {
    return subject.field == nullptr ? std::nullopt : subject.field->value_around();
}

AutomaticTransfer in_own_colors(const Padding& padding, bool whole_numbers,
                                const TransferSubject& subject) {
    const ValueDistribution& values = padding.rest;
    if (values.distinct() < 2) return one_value(values.empty() ? 0 : values.lowest());
    if (whole_numbers && values.distinct() <= most_labels && values.distinct() > 2 &&
        (subject.field == nullptr || subject.field->lies_in_pieces()))
        return label_transfer(values, nullptr, {}, value_around(subject));
    const ChosenSurfaces chosen = choose_surfaces(padding, whole_numbers, subject);
    return chosen.points.empty() ? one_value(values.lowest()) : with_surfaces(chosen);
}

}  // namespace

AutomaticTransfer choose_transfer_function(const ValueDistribution& values, bool whole_numbers,
                                           const TransferAdjustments& adjustments,
                                           double least_padding_share, const VolumeLabels* labels,
                                           const TransferSubject& subject) {
    if (labels != nullptr && values.distinct() > 0) {
        AutomaticTransfer chosen =
            label_transfer(values, labels, adjustments.range, value_around(subject));
        TransferFunction& palette = chosen.transfer_function;
        if (adjustments.colormap) palette = recolored(palette, *adjustments.colormap);
        return chosen;
    }
    const Padding padding = find_padding(values, whole_numbers, least_padding_share);
    AutomaticTransfer chosen = adjustments.range
                                   ? within(values, *adjustments.range, whole_numbers, subject)
                                   : in_own_colors(padding, whole_numbers, subject);
    TransferFunction& function = chosen.transfer_function;
    if (adjustments.colormap) function = recolored(function, *adjustments.colormap);
    if (adjustments.range) {
        // within() shows nothing below the range, so only padding above it must be made
        // transparent. Padding inside the range shows, because the user asked for it.
        if (!padding.above || *padding.above <= adjustments.range->hi) return chosen;
        function = shown_below(function, std::max(padding.edge_above(), adjustments.range->hi));
    } else {
        if (padding.below) function = shown_above(function, padding.edge_below());
        if (padding.above) function = shown_below(function, padding.edge_above());
    }
    chosen.padding = padding_text(padding);
    return chosen;
}

TransferFunction stretched(const TransferFunction& transfer_function, const ValueRange& range) {
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    if (knots.front().value == knots.back().value)
        fail(
            "transfer function: has a single value, {}, expected two that a range could lie "
            "between",
            knots.front().value);
    // Rounding keeps the order of values, and both ends become exactly those of the range.
    const double lo = knots.front().value, width = knots.back().value - lo;
    for (TransferKnot& knot : knots) {
        const double place = (knot.value - lo) / width;
        knot.value =
            place == 1 ? range.hi : std::min(range.lo + (range.hi - range.lo) * place, range.hi);
    }
    for (std::size_t i = 2; i < knots.size(); ++i) {
        if (knots[i].value == knots[i - 2].value) {
            fail("range from {} to {}: is too narrow for the {} points of the transfer function",
                 range.lo, range.hi, knots.size());
        }
    }
    return TransferFunction::linear(knots);
}

TransferFunction recolored(const TransferFunction& transfer_function, Colormap colormap) {
    const auto knots = transfer_function.knots();
    const double from = colormap.colors.front().value, to = colormap.colors.back().value;
    const double lo = knots.front().value, hi = knots.back().value;
    if (lo == hi) {
        const auto colors = TransferFunction::linear(combine(colormap, {{from, 0}}));
        const glm::dvec3 middle = colors.at(from + (to - from) / 2).color;
        return TransferFunction::linear({{lo, {middle, knots.front().optics.extinction}}});
    }
    std::vector<ExtinctionPoint> extinctions;
    for (const TransferKnot& knot : knots)
        extinctions.push_back({knot.value, knot.optics.extinction, knot.smooth});
    if (from < to && !colormap.own_range) stretch(colormap, lo, hi);
    return TransferFunction::linear(combine(colormap, extinctions));
}

}  // namespace lamina
