// SPDX-License-Identifier: Apache-2.0
#include "scene/given_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/client.h"
#include "base/enum_words.h"
#include "optics/colormap.h"
#include "volume/labels.h"

namespace lamina {
namespace {

// Widens a range of one value, which then gets the map's middle; an empty range becomes 0..1.
ValueRange widened(const ValueRange& range) {
    if (range.empty()) return {0, 1};
    if (range.lo < range.hi) return range;
    const double half = std::max(std::abs(range.lo), 1.0) / 2;
    return {range.lo - half, range.hi + half};
}

ValueRange range_of_map(const GivenTransfer& given, const ValueRange& data) {
    if (given.colormap_range.is_given()) return *given.colormap_range;
    const ValueRange range = widened(data);
    if (range.lo >= -largest_map_value && range.hi <= largest_map_value) return range;
    throw GivenTransferError(
        "colormap_range", fmt::format("is missing, expected [lo, hi] between -1e300 and 1e300: the "
                                      "data go from {} to {}",
                                      range.lo, range.hi));
}

std::vector<TransferKnot> knots_of(const GivenTransfer& given,
                                   const std::vector<GivenPoint>& points) {
    return given.interpolation == PointInterpolation::linear
               ? linear_in_opacity(points, given.unit_length)
               : linear_in_extinction(points, given.unit_length);
}

// Combines the map's colours with the points' extinctions or, without points, its opacities.
TransferFunction colored_by_map(const GivenTransfer& given, const ValueRange& data) {
    Colormap map = *given.map;
    if (given.colormap_range.is_given() || given.open()) {
        const ValueRange range = range_of_map(given, data);
        stretch(map, range.lo, range.hi);
    }
    const bool own = given.points.empty();
    try {
        std::vector<ExtinctionPoint> extinctions;
        for (const TransferKnot& knot : knots_of(given, own ? given_points(map) : given.points))
            extinctions.push_back({knot.value, knot.optics.extinction, knot.smooth});
        return TransferFunction::linear(combine(map, extinctions));
    } catch (const Error& error) {
        throw GivenTransferError(own ? "colormap" : "points", error.what());
    }
}

TransferFunction colored_by_points(const GivenTransfer& given) {
    try {
        const std::vector<TransferKnot> plain =
            linear_in_extinction(given.points, given.unit_length);
        if (given.interpolation == PointInterpolation::nearest)
            return TransferFunction::nearest(plain);
        TransferFunction::linear(plain);  // checks the points as they were given
        return TransferFunction::linear(knots_of(given, given.points));
    } catch (const Error& error) {
        throw GivenTransferError("points", error.what());
    }
}

}  // namespace

const char* name_of(PointInterpolation interpolation) {
    return word_of(interpolation, {"linear", "extinction", "nearest"});
}

std::filesystem::path GivenTransfer::colormap_file() const {
    return is_colormap_name(colormap) ? std::filesystem::path() : std::filesystem::path(colormap);
}

TransferFunction transfer_function_of(const GivenTransfer& given, const ValueRange& data) {
    const TransferFunction made =
        given.map ? colored_by_map(given, data) : colored_by_points(given);
    return given.codes ? made.with_codes(given.codes_of) : made;
}

TransferFunction over_codes(const TransferFunction& function, const Volume& volume) {
    const std::string identity = identity_of_codes(volume);
    if (function.of_codes()) {
        if (function.labels().empty() || function.labels() == identity) return function;
        throw GivenTransferError(
            "codes_of",
            "the function has codes of other labels than the volume has, which was changed or is "
            "another one: expected points of the labels' numbers, without \"codes\", or no "
            "function");
    }
    if (identity.empty()) return function;
    const std::vector<Label>& labels = volume.labels()->list;
    std::vector<TransferKnot> points;
    std::vector<double> numbers;
    for (const Label& label : labels) {
        numbers.push_back(std::strtod(label.number.c_str(), nullptr));
        points.push_back({label.code, function.at(numbers.back())});
    }
    if (const auto same = std::ranges::adjacent_find(numbers); same != numbers.end()) {
        const auto place = static_cast<std::size_t>(same - numbers.begin());
        say("transfer_function: values are doubles, which do not tell labels {} and {} "
            "apart: with \"codes\" values are places of labels in the list of lamina "
            "info, from 0",
            labels[place].number, labels[place + 1].number);
    }
    return TransferFunction::nearest(points).with_codes(identity);
}

bool has_open_colormap(const Scene& scene) {
    return scene.transfer_function.is_automatic() && scene.given_transfer &&
           scene.given_transfer->open();
}

bool chooses_transfer_function(const Scene& scene) {
    return scene.transfer_function.is_automatic() && !has_open_colormap(scene);
}

void close_colormap(Scene& scene, const ValueRange& data) {
    const GivenTransfer& given = *scene.given_transfer;
    try {
        scene.transfer_function = transfer_function_of(given, data);
    } catch (const GivenTransferError& error) {
        fail("{}.{}: {}", given.place, error.key, error.what());
    }
}

std::filesystem::path colormap_file_of(const Scene& scene) {
    return scene.given_transfer ? scene.given_transfer->colormap_file() : std::filesystem::path();
}

// Reports nothing if another function was put in place of the given one.
std::optional<std::string> opaque_ramp(const Scene& scene) {
    if (!scene.given_transfer || scene.given_transfer->map) return std::nullopt;
    std::optional<std::string> found = opaque_ramp(*scene.given_transfer);
    if (found && transfer_function_of(*scene.given_transfer) != scene.transfer_function) return {};
    return found;
}

std::optional<std::string> opaque_ramp(const GivenTransfer& given) {
    if (given.map || given.interpolation == PointInterpolation::nearest) return std::nullopt;
    const bool linear = given.interpolation == PointInterpolation::linear;
    const auto by_opacity = [](const GivenPoint& point) {
        return point.given_as == GivenPoint::Density::opacity;
    };
    const auto opaque = [&](const GivenPoint& point) {
        return by_opacity(point) && point.density == 1;
    };
    for (std::size_t i = 0; i + 1 < given.points.size(); ++i) {
        const GivenPoint &a = given.points[i], &b = given.points[i + 1];
        if (opaque(a) == opaque(b) || a.value == b.value) continue;
        if (linear && by_opacity(a) && by_opacity(b)) continue;
        return fmt::format(
            "{}: extinction is linear from value {} to {} and runs to opacity 1, taken as an "
            "optical depth of {:g} per unit_length",
            given.place, a.value, b.value, linear ? steepest_optical_depth : opaque_optical_depth);
    }
    return std::nullopt;
}

}  // namespace lamina
