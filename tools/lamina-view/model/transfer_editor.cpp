// SPDX-License-Identifier: Apache-2.0
#include "model/transfer_editor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lamina/error.h"
#include "model/opacity_slopes.h"
#include "model/scene_keys.h"

namespace lamina::view {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Values of a curve's points, in order, with at most two at one value. Some of them (the marked
// ones) move together, until one meets a wall: the next point that does not move.
class MovedValues {
  public:
    template <typename Point>
    MovedValues(const std::vector<Point>& points, std::vector<char> moves)
        : moves_(std::move(moves)) {
        for (const Point& point : points) values_.push_back(point.value);
    }

    // Returns `wanted`, or the shift of this sign at which the first value meets its wall.
    double limited(double wanted) const {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (moves_[i] == 0) continue;
            if (wanted > 0) wanted = std::min(wanted, wall_above(i) - values_[i]);
            if (wanted < 0) wanted = std::max(wanted, wall_below(i) - values_[i]);
        }
        return wanted;
    }

    // Returns the moved values. Sums round, so a value that reaches a wall is set to it, and the
    // order is restored at last.
    std::vector<double> shifted(double by) const {
        std::vector<double> result = values_;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (moves_[i] == 0) continue;
            const double below = wall_below(i), above = wall_above(i);
            result[i] = by == above - values_[i]   ? above
                        : by == below - values_[i] ? below
                                                   : std::clamp(values_[i] + by, below, above);
        }
        for (std::size_t i = 1; i < result.size(); ++i)
            if (moves_[i] != 0) result[i] = std::max(result[i], result[i - 1]);
        for (std::size_t i = result.size(); i-- > 1;)
            if (moves_[i - 1] != 0) result[i - 1] = std::min(result[i - 1], result[i]);
        return result;
    }

  private:
    bool equal(std::size_t a, std::size_t b) const {
        return b < values_.size() && values_[a] == values_[b];
    }
    // Returns the wall above: the next value if it stays, else infinity. If moving onto it would
    // make three equal values, the wall is just below it.
    double wall_above(std::size_t i) const {
        if (i + 1 >= values_.size() || moves_[i + 1] != 0) return infinity;
        const bool crowded =
            equal(i + 1, i + 2) || (i > 0 && moves_[i - 1] != 0 && equal(i, i - 1));
        return crowded ? std::max(values_[i], std::nextafter(values_[i + 1], -infinity))
                       : values_[i + 1];
    }
    double wall_below(std::size_t i) const {
        if (i == 0 || moves_[i - 1] != 0) return -infinity;
        const bool crowded = (i > 1 && equal(i - 2, i - 1)) ||
                             (i + 1 < values_.size() && moves_[i + 1] != 0 && equal(i, i + 1));
        return crowded ? std::min(values_[i], std::nextafter(values_[i - 1], infinity))
                       : values_[i - 1];
    }

    std::vector<double> values_;
    std::vector<char> moves_;
};

std::vector<char> marked(const std::set<TransferHandle>& points, TransferHandle::Curve curve,
                         std::size_t count) {
    std::vector<char> marks(count);
    for (const TransferHandle& point : points)
        if (point.curve == curve && point.index < count) marks[point.index] = 1;
    return marks;
}

double moved_extinction(double extinction, double places, const SymlogAxis& axis) {
    if (places == 0) return extinction;
    // An extinction above the axis is drawn at its end.
    const double from = axis.place(extinction);
    if (from > 1 && places > 0) return extinction;
    const double place = std::clamp(std::min(from, 1.) + places, axis.place(0), 1.);
    return std::max(0., axis.number(place));
}

// Returns the index for a new point at `value`, behind points there; empty if there are two.
template <typename Point>
std::optional<std::size_t> room_at(const std::vector<Point>& points, double value) {
    const auto [first, end] = std::ranges::equal_range(points, value, {}, &Point::value);
    if (end - first >= 2) return {};
    return static_cast<std::size_t>(end - points.begin());
}

template <typename Point>
bool put_between(std::vector<Point>& points, std::size_t index, double value) {
    if (index >= points.size() || !std::isfinite(value)) return false;
    if (index > 0) value = std::max(value, points[index - 1].value);
    if (index + 1 < points.size()) value = std::min(value, points[index + 1].value);
    points[index].value = value;
    return true;
}

template <typename Point>
void remove(std::vector<Point>& points, const std::set<TransferHandle>& selection,
            TransferHandle::Curve curve) {
    std::vector<Point> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!selection.contains({curve, i})) kept.push_back(points[i]);
    if (kept.empty()) kept.push_back(points.front());
    points = std::move(kept);
}

void stretch_map(Colormap& map, double lo, double hi) {
    const double from = map.colors.front().value, to = map.colors.back().value;
    const auto stretched = [&](double value) {
        return lo + (hi - lo) * ((value - from) / (to - from));
    };
    for (ColorPoint& point : map.colors) point.value = stretched(point.value);
    for (OpacityPoint& point : map.opacities) point.value = stretched(point.value);
}

}  // namespace

void follow_slope(std::vector<DensityPoint>& points, std::size_t index) {
    DensityPoint& point = points[index];
    point.inside.clear();
    if (point.opacity_length > 0 && index + 1 < points.size())
        point.inside = inside_slope(point, points[index + 1]);
}

TransferCurves moved(const TransferCurves& curves, const std::set<TransferHandle>& points,
                     const TransferShift& shift, const SymlogAxis& axis) {
    TransferCurves result = curves;
    const auto density = marked(points, TransferHandle::Curve::density, curves.density.size());
    const auto color = marked(points, TransferHandle::Curve::color, curves.colors.size());
    const MovedValues densities(curves.density, density), colors(curves.colors, color);
    const double by = colors.limited(densities.limited(shift.values));
    if (by != 0) {
        const std::vector<double> at = densities.shifted(by), colored_at = colors.shifted(by);
        for (std::size_t i = 0; i < at.size(); ++i) result.density[i].value = at[i];
        for (std::size_t i = 0; i < colored_at.size(); ++i) result.colors[i].value = colored_at[i];
    }
    for (std::size_t i = 0; i < density.size(); ++i) {
        if (density[i] != 0)
            result.density[i].extinction =
                moved_extinction(curves.density[i].extinction, shift.places, axis);
    }
    for (std::size_t i = 0; i < density.size(); ++i) {
        const auto changed = [&](std::size_t at) {
            return at < density.size() &&
                   (result.density[at].value != curves.density[at].value ||
                    result.density[at].extinction != curves.density[at].extinction);
        };
        if (changed(i) || changed(i + 1)) follow_slope(result.density, i);
    }
    return result;
}

TransferCurves windowed(const TransferCurves& curves, double factor, double pivot, double shift) {
    TransferCurves result = curves;
    if (factor == 1 && shift == 0) return result;
    const auto move = [&](double& value) { value = pivot + (value - pivot) * factor + shift; };
    for (DensityPoint& point : result.density) {
        move(point.value);
        for (ExtinctionKnot& knot : point.inside) move(knot.value);
    }
    for (ColorPoint& point : result.colors) move(point.value);
    return result;
}

// Divides lengths by `factor`: optical depths over them, and thus slopes of opacity, stay.
TransferCurves attenuated(const TransferCurves& curves, double factor) {
    constexpr double most = std::numeric_limits<double>::max();
    TransferCurves result = curves;
    for (DensityPoint& point : result.density) {
        point.extinction = std::min(point.extinction * factor, most);
        point.opacity_length /= factor;
        for (ExtinctionKnot& knot : point.inside)
            knot.extinction = std::min(knot.extinction * factor, most);
    }
    return result;
}

TransferEditor::TransferEditor() : function_(curves_.function()) {}

bool TransferEditor::put(const TransferCurves& curves) {
    try {
        function_ = curves.function();
        if (of_codes_) function_ = function_.with_codes(labels_);
    } catch (const Error&) {
        return false;
    }
    curves_ = curves;
    return true;
}

template <typename Change>
bool TransferEditor::change(const Change& apply) {
    TransferCurves changed = curves_;
    return apply(changed) && put(changed);
}

void TransferEditor::follow_around(TransferCurves& curves, std::size_t index) const {
    follow_slope(curves.density, index);
    if (index > 0) follow_slope(curves.density, index - 1);
}

void TransferEditor::set_unit_length(double length) {
    if (length > 0 && std::isfinite(length)) unit_length_ = length;
}

void TransferEditor::take(const TransferFunction& function) {
    if (function == function_) return;
    of_codes_ = function.of_codes();
    labels_ = function.labels();
    restore(curves_of(function, unit_length_));
}

void TransferEditor::restore(const TransferCurves& curves) {
    start_.reset();
    if (!put(curves)) return;
    std::erase_if(selection_, [&](const TransferHandle& point) {
        return point.index >=
               (point.curve == Curve::density ? curves_.density.size() : curves_.colors.size());
    });
}

void TransferEditor::select_only(const TransferHandle& point) {
    selection_ = {point};
}

void TransferEditor::toggle(const TransferHandle& point) {
    if (selection_.erase(point) == 0) selection_.insert(point);
}

void TransferEditor::select_all(Curve curve) {
    const std::size_t count =
        curve == Curve::density ? curves_.density.size() : curves_.colors.size();
    for (std::size_t i = 0; i < count; ++i) selection_.insert({curve, i});
}

void TransferEditor::select_within(double value_lo, double value_hi, double extinction_lo,
                                   double extinction_hi) {
    for (std::size_t i = 0; i < curves_.density.size(); ++i) {
        const DensityPoint& point = curves_.density[i];
        if (point.value >= value_lo && point.value <= value_hi &&
            point.extinction >= extinction_lo && point.extinction <= extinction_hi)
            selection_.insert({Curve::density, i});
    }
}

std::set<TransferHandle> TransferEditor::moving_points() const {
    std::set<TransferHandle> points = selection_;
    if (!colors_move_along) return points;
    for (const TransferHandle& point : selection_) {
        if (point.curve != Curve::density) continue;
        for (std::size_t i = 0; i < curves_.colors.size(); ++i)
            if (curves_.colors[i].value == curves_.density[point.index].value)
                points.insert({Curve::color, i});
    }
    return points;
}

void TransferEditor::begin_move() {
    start_ = curves_;
    moving_ = moving_points();
}

bool TransferEditor::move(const TransferShift& shift, const SymlogAxis& axis) {
    return start_ && put(moved(*start_, moving_, shift, axis));
}

bool TransferEditor::window(double factor, double pivot, double shift) {
    return start_ && factor > 0 && put(windowed(*start_, factor, pivot, shift));
}

bool TransferEditor::attenuate(double factor) {
    return start_ && factor > 0 && std::isfinite(factor) && put(attenuated(*start_, factor));
}

void TransferEditor::cancel_move() {
    if (start_) put(*start_);
    start_.reset();
}

bool TransferEditor::add_density(double value, double extinction) {
    std::size_t index = 0;
    const bool added = change([&](TransferCurves& curves) {
        const auto room = room_at(curves.density, value);
        if (!room) return false;
        index = *room;
        const double length = index > 0 ? curves.density[index - 1].opacity_length : 0;
        curves.density.insert(curves.density.begin() + static_cast<std::ptrdiff_t>(index),
                              {value, extinction, false, length, {}});
        follow_around(curves, index);
        return true;
    });
    if (added) select_only({Curve::density, index});
    return added;
}

bool TransferEditor::add_color(double value) {
    std::size_t index = 0;
    const bool added = change([&](TransferCurves& curves) {
        const auto room = room_at(curves.colors, value);
        if (!room) return false;
        index = *room;
        curves.colors.insert(curves.colors.begin() + static_cast<std::ptrdiff_t>(index),
                             {value, color_at(curves.colors, value).above});
        return true;
    });
    if (added) select_only({Curve::color, index});
    return added;
}

bool TransferEditor::make_step(const TransferHandle& point) {
    if (point.curve == Curve::color)
        return point.index < curves_.colors.size() && add_color(curves_.colors[point.index].value);
    if (point.index >= curves_.density.size()) return false;
    const DensityPoint at = curves_.density[point.index];
    return add_density(at.value, at.extinction);
}

bool TransferEditor::remove_selected() {
    const bool removed = change([&](TransferCurves& curves) {
        std::vector<double> gone;
        for (const TransferHandle& point : selection_)
            if (point.curve == Curve::density) gone.push_back(curves.density[point.index].value);
        remove(curves.density, selection_, Curve::density);
        remove(curves.colors, selection_, Curve::color);
        for (std::size_t i = 0; i < curves.density.size(); ++i) {
            const bool last = i + 1 == curves.density.size();
            const double to =
                last ? std::numeric_limits<double>::infinity() : curves.density[i + 1].value;
            const bool widened = std::ranges::any_of(gone, [&](double value) {
                return value >= curves.density[i].value && value <= to;
            });
            if (widened) follow_slope(curves.density, i);
        }
        return !selection_.empty();
    });
    if (removed) selection_.clear();
    return removed;
}

bool TransferEditor::set_value(const TransferHandle& point, double value) {
    return change([&](TransferCurves& curves) {
        if (point.curve == Curve::color) return put_between(curves.colors, point.index, value);
        if (!put_between(curves.density, point.index, value)) return false;
        follow_around(curves, point.index);
        return true;
    });
}

bool TransferEditor::set_extinction(std::size_t index, double extinction) {
    return change([&](TransferCurves& curves) {
        if (index >= curves.density.size()) return false;
        curves.density[index].extinction = extinction;
        follow_around(curves, index);
        return true;
    });
}

bool TransferEditor::set_opacity(std::size_t index, double opacity) {
    return opacity >= 0 && opacity <= 1 &&
           set_extinction(index, extinction_of(opacity, unit_length_));
}

bool TransferEditor::set_smooth(std::size_t index, bool smooth) {
    return change([&](TransferCurves& curves) {
        if (index >= curves.density.size()) return false;
        curves.density[index].smooth = smooth;
        return true;
    });
}

bool TransferEditor::set_color(std::size_t index, const glm::dvec3& color) {
    return change([&](TransferCurves& curves) {
        if (index >= curves.colors.size()) return false;
        curves.colors[index].color = color;
        return true;
    });
}

bool TransferEditor::paint(double value, const glm::dvec3& color) {
    return change([&](TransferCurves& curves) {
        bool found = false;
        for (ColorPoint& point : curves.colors) {
            if (point.value != value) continue;
            point.color = color;
            found = true;
        }
        if (found) return true;
        const auto room = room_at(curves.colors, value);
        curves.colors.insert(curves.colors.begin() + static_cast<std::ptrdiff_t>(*room),
                             {value, color});
        return true;
    });
}

bool TransferEditor::set_opacity_linear(bool opacity) {
    const bool everywhere = std::ranges::none_of(
        selection_, [](const TransferHandle& point) { return point.curve == Curve::density; });
    return change([&](TransferCurves& curves) {
        for (std::size_t i = 0; i < curves.density.size(); ++i) {
            if (!everywhere && !selection_.contains({Curve::density, i})) continue;
            curves.density[i].opacity_length = opacity ? unit_length_ : 0;
            follow_slope(curves.density, i);
        }
        return true;
    });
}

bool TransferEditor::set_palette(bool palette) {
    return change([&](TransferCurves& curves) {
        curves.palette = palette;
        return true;
    });
}

bool TransferEditor::set_density(const std::vector<DensityPoint>& points) {
    const bool set = change([&](TransferCurves& curves) {
        curves.density = points;
        curves.palette = false;
        return !points.empty();
    });
    if (set) selection_.clear();
    return set;
}

bool TransferEditor::recolor(Colormap map, double lo, double hi, bool opacities) {
    if (!map.own_range) {
        if (!(lo < hi) || !(map.colors.front().value < map.colors.back().value)) return false;
        stretch_map(map, lo, hi);
    }
    const bool recolored = change([&](TransferCurves& curves) {
        curves.colors = map.colors;
        curves.palette = false;
        if (!opacities || map.opacities.empty()) return true;
        std::vector<OpacityKnot> points;
        for (const OpacityPoint& point : map.opacities)
            points.push_back({point.value, glm::dvec3(1), point.opacity});
        curves.density =
            curves_of(TransferFunction::linear_opacity(points, unit_length_), unit_length_).density;
        return true;
    });
    if (recolored) selection_.clear();
    return recolored;
}

bool TransferEditor::convert_colors(ImageColorSpace from, ImageColorSpace to) {
    return change([&](TransferCurves& curves) {
        for (ColorPoint& point : curves.colors)
            point.color = converted_color(point.color, from, to);
        return true;
    });
}

}  // namespace lamina::view
