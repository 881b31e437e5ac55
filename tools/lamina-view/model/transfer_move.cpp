// SPDX-License-Identifier: Apache-2.0
#include "model/transfer_move.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "model/opacity_slopes.h"

namespace lamina::view {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Values in order, at most two of them equal, some of which move together.
class MovedValues {
  public:
    template <typename Point>
    MovedValues(const std::vector<Point>& points, std::vector<char> moves)
        : moves_(std::move(moves)) {
        for (const Point& point : points) values_.push_back(point.value);
    }

    // Returns how far they can go, in the direction of `wanted`.
    double limited(double wanted) const {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            if (moves_[i] == 0) continue;
            if (wanted > 0) wanted = std::min(wanted, wall_above(i) - values_[i]);
            if (wanted < 0) wanted = std::max(wanted, wall_below(i) - values_[i]);
        }
        return wanted;
    }

    // Sums round: what goes up to a wall is put there, and walls hold for the sums once more.
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
    // The next point that stays. No third point may come to the value of two others.
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
    // An extinction beyond the axis is drawn at its end.
    const double from = axis.place(extinction);
    if (from > 1 && places > 0) return extinction;
    const double place = std::clamp(std::min(from, 1.) + places, axis.place(0), 1.);
    return std::max(0., axis.number(place));
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

// Opacity that was linear over a length is so over the length in which the ray is as dense again.
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

}  // namespace lamina::view
