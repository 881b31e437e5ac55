// SPDX-License-Identifier: Apache-2.0
// TetProjector's computations on vectors of tets; the projector's comments give the reasons. Points
// are relative to the eye, along right, up and forward.
#if defined(LAMINA_PROJECTION_TET_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_SETUP_INL_H_
#undef LAMINA_PROJECTION_TET_SETUP_INL_H_
#else
#define LAMINA_PROJECTION_TET_SETUP_INL_H_
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "facts/far_scalars.h"
#include "projection/face_planes-inl.h"
#include "projection/point_vectors-inl.h"
#include "projection/stored_gradients.h"
#include "projection/tet_record.h"
#include "projection/tet_setup_lanes.h"

LAMINA_SIMD_BEGIN

class TetVectors {
  public:
    TetVectors(const SetupView& view, TetSetup::Lanes& lanes, std::size_t first)
        : view_(view), lanes_(lanes), first_(first) {}

    void set_up(bool parts, bool lit) {
        see();
        place_center();
        DoubleMask good = find_faces();
        good = good & find_gradient();
        if (parts) {
            set_part();
        } else {
            good = good & set_whole();
        }
        if (lit) set_gradients();
        put_whole(lanes_.limits[2], fronts_);
        put(lanes_.good, zero_unless(good, Double(1)));
        put(lanes_.visible, zero_unless(visible_, Double(1)));
    }

  private:
    using Row = TetSetup::Lanes::Row;
    using FloatRow = TetSetup::Lanes::FloatRow;
    Double get(const Row& row) const { return load<Double>(row.data() + first_); }
    void put(Row& row, Double v) const { store(v, row.data() + first_); }
    void put(FloatRow& row, Double v) const { store_as_floats(v, row.data() + first_); }
    // Stores whole numbers as 32-bit integers, in the bits of floats.
    void put_whole(FloatRow& row, Double v) const { store_as_int_bits(v, row.data() + first_); }

    void see() {
        const View& view = view_.view;
        for (std::size_t i = 0; i < 4; ++i) {
            const Point p{get(lanes_.x[i]) - view.eye.x, get(lanes_.y[i]) - view.eye.y,
                          get(lanes_.z[i]) - view.eye.z};
            const auto along = [&](const glm::dvec3& axis) LAMINA_LAMBDA {
                return dot(p, Point{axis.x, axis.y, axis.z});
            };
            seen_[i] = {along(view.right), along(view.up), along(view.forward)};
            values_[i] = get(lanes_.value[i]);
        }
    }

    Double inverted(Double value) const { return view_.perspective ? -1 / value : value; }

    void place_center() {
        const double width = view_.view.width, height = view_.view.height;
        Double lo_x = INFINITY, lo_y = lo_x, hi_x = -INFINITY, hi_y = hi_x, sum = 0;
        nearest_ = lo_x;
        farthest_ = 0;
        for (const Point& p : seen_) {
            const Double scale = view_.perspective ? view_.view.pixel * p.z : view_.view.pixel;
            const Double column = 0.5 * width + p.x / scale, row = 0.5 * height + p.y / scale;
            lo_x = min(lo_x, column);
            hi_x = max(hi_x, column);
            lo_y = min(lo_y, row);
            hi_y = max(hi_y, row);
            sum += p.z * 0.25;
            nearest_ = min(nearest_, p.z);
            farthest_ = max(farthest_, p.z);
        }
        set_bounds(lo_x, hi_x, lo_y, hi_y);
        lo_x = clamp(lo_x, 0, width);
        hi_x = clamp(hi_x, 0, width);
        lo_y = clamp(lo_y, 0, height);
        hi_y = clamp(hi_y, 0, height);
        columns_ = hi_x - lo_x;
        rows_ = hi_y - lo_y;
        const Double column = rounded_to_float(floor(0.5 * (lo_x + hi_x)) + 0.5);
        const Double row = rounded_to_float(floor(0.5 * (lo_y + hi_y)) + 0.5);
        put(lanes_.center[0], column);
        put(lanes_.center[1], row);
        column_ = column - 0.5 * width;
        row_ = row - 0.5 * height;
        center_depth_ = rounded_to_float(inverted(sum));
        put(lanes_.center[2], center_depth_);
        center_z_ = inverted(center_depth_);
        put(lanes_.center[3], center_z_);
    }

    // Sets the bounds of the pixel centres that may be covered (pixel_bounds()).
    void set_bounds(Double lo_x, Double hi_x, Double lo_y, Double hi_y) {
        const double least = 0.5 + view_.margin, most = view_.margin - 0.5;
        const Double first_column = max(ceil(lo_x - least), 0),
                     first_row = max(ceil(lo_y - least), 0);
        const Double last_column = min(floor(hi_x + most), view_.view.width - 1);
        const Double last_row = min(floor(hi_y + most), view_.view.height - 1);
        visible_ = (first_column <= last_column) & (first_row <= last_row);
        put_whole(lanes_.pixels[0], first_column);
        put_whole(lanes_.pixels[1], last_column);
        const int top = view_.view.height - 1;
        put_whole(lanes_.pixels[2], top - last_row);
        put_whole(lanes_.pixels[3], top - first_row);
    }

    // The plane's depth at the center, from its change per pixel.
    Double at_center(Double at_middle, Double per_column, Double per_row) const {
        return at_middle + column_ * per_column + row_ * per_row - center_depth_;
    }

    // Returns true where the signs are certain and float32 is good enough.
    DoubleMask find_faces() {
        Double reach = 0, rounding = 0;
        FacePlanes planes;
        Double size = 0, steepest = size;
        for (const Point& p : seen_) {
            reach = max(reach, largest_of(p));
            size = max(size, largest_of(p - seen_[0]));
        }
        const Double least_divisor =
            doubtful_sign * (reach * reach * (view_.perspective ? reach : 1));
        // Points at distance `reach` are rounded, and so are their edges. The normals of slivers
        // are small differences of products of edges.
        const Double least_across = doubtful_sign * (reach * (size * size));
        DoubleMask good = nearest_ > view_.near_depth;
        for (std::size_t face = 0; face < 4; ++face) {
            const Point &a = seen_[face == 0 ? 1 : 0], &b = seen_[face <= 1 ? 2 : 1],
                        &c = seen_[face == 3 ? 2 : 3];
            const Point normal = cross(b - a, c - a);
            const Double distance = dot(normal, a), across = dot(normal, seen_[face] - a);
            const Double divisor = view_.perspective ? distance : normal.z;
            good = good & ((abs(divisor) > least_divisor) & (abs(across) > least_across));
            const DoubleMask front = divisor * across > 0;
            const Double per_pixel = -view_.view.pixel / divisor;
            const Double per_column = normal.x * per_pixel, per_row = normal.y * per_pixel;
            const Double depth = at_center((view_.perspective ? -normal.z : distance) / divisor,
                                           per_column, per_row);
            planes.add(front, depth, per_column, per_row);
            steepest = max(steepest, abs(per_column) + abs(per_row));
            rounding =
                max(rounding, abs(depth) + columns_ * abs(per_column) + rows_ * abs(per_row));
        }
        for (std::size_t place = 0; place < 4; ++place) {
            put(lanes_.depth[place], planes.depth[place]);
            put(lanes_.per_column[place], planes.per_column[place]);
            put(lanes_.per_row[place], planes.per_row[place]);
        }
        fronts_ = planes.fronts;
        const Double thickness = farthest_ - nearest_;
        const Double range = view_.perspective ? thickness / (farthest_ * farthest_) : thickness;
        put(lanes_.farthest, inverted(farthest_) - center_depth_ + float_tolerance * range);
        const Double float_rounding = rounding * float_epsilon, tolerance = float_tolerance * range;
        good = good & (float_rounding <= tolerance);
        // Whether rounding alone may make runs: where its error in depth is not small, or where the
        // horizon (depth 0) is near.
        DoubleMask bounded = 100 * float_rounding > tolerance;
        if (view_.perspective) bounded = bounded | (16 * steepest > abs(center_depth_));
        put(lanes_.bounded, zero_unless(bounded, Double(1)));
        return good & ((fronts_ > 0) & (fronts_ < 4));
    }

    // Finds the scalar's gradient; returns true where it is a number.
    DoubleMask find_gradient() {
        const Point e1 = seen_[1] - seen_[0], e2 = seen_[2] - seen_[0], e3 = seen_[3] - seen_[0];
        const Point n1 = cross(e2, e3), n2 = cross(e3, e1), n3 = cross(e1, e2);
        const Double v1 = values_[1] - values_[0], v2 = values_[2] - values_[0],
                     v3 = values_[3] - values_[0];
        const auto sum = [&](Double a, Double b, Double c)
                             LAMINA_LAMBDA { return v1 * a + v2 * b + v3 * c; };
        gradient_ = scaled({sum(n1.x, n2.x, n3.x), sum(n1.y, n2.y, n3.y), sum(n1.z, n2.z, n3.z)},
                           1 / dot(e1, n1));
        least_ = min(min(values_[0], values_[1]), min(values_[2], values_[3]));
        largest_ = max(max(values_[0], values_[1]), max(values_[2], values_[3]));
        return largest_of(gradient_) <= 1e30 * (largest_ - least_);
    }

    Double scalar_at(const Point& point) const {
        return values_[0] + dot(gradient_, point - seen_[0]);
    }
    Double finite(Double v) const { return clamp(v, -beyond_all, beyond_all); }

    // Sets the scalar as (scalar - origin) / width.
    void set_scalars(Double origin, Double width) {
        const Double scale = zero_unless(width > 0, 1 / width);
        const Double pixel = view_.view.pixel, x = column_ * pixel, y = row_ * pixel, z = center_z_;
        const Point direction = view_.perspective ? Point{x, y, 1} : Point{0, 0, 1};
        const Point center = view_.perspective ? scaled(direction, z) : Point{x, y, z};
        const Point gradient = scaled(gradient_, scale);
        put(lanes_.scalar[0], finite((scalar_at(center) - origin) * scale));
        put(lanes_.scalar[1], finite(dot(gradient, direction)));
        put(lanes_.scalar[2], finite(gradient.x * pixel));
        put(lanes_.scalar[3], finite(gradient.y * pixel));
    }

    // The components of the gradient, as set_scalars() sets the scalar.
    void set_gradients() {
        const Point e1 = seen_[1] - seen_[0], e2 = seen_[2] - seen_[0], e3 = seen_[3] - seen_[0];
        const Point n1 = cross(e2, e3), n2 = cross(e3, e1), n3 = cross(e1, e2);
        const Double inverse = 1 / dot(e1, n1);
        const Double pixel = view_.view.pixel, x = column_ * pixel, y = row_ * pixel, z = center_z_;
        const Point direction = view_.perspective ? Point{x, y, 1} : Point{0, 0, 1};
        const Point center = view_.perspective ? scaled(direction, z) : Point{x, y, z};
        const Point from_corner = center - seen_[0];
        Double largest = 0;
        for (const auto& corners : lanes_.gradient) {
            for (const Row& corner : corners) largest = max(largest, abs(get(corner)));
        }
        // As StoredGradients::scale_of_tet().
        constexpr double most = StoredGradients::most_of_tet;
        const Double scale = select(largest > most, most / largest, 1);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& corners = lanes_.gradient[axis];
            const auto value = [&](std::size_t i) LAMINA_LAMBDA { return get(corners[i]) * scale; };
            const Double first = value(0);
            const Double v1 = value(1) - first, v2 = value(2) - first, v3 = value(3) - first;
            const auto sum = [&](Double a, Double b, Double c)
                                 LAMINA_LAMBDA { return inverse * (v1 * a + v2 * b + v3 * c); };
            const Point slope{sum(n1.x, n2.x, n3.x), sum(n1.y, n2.y, n3.y), sum(n1.z, n2.z, n3.z)};
            auto& lit = lanes_.lit[axis];
            put(lit[0], finite(first + dot(slope, from_corner)));
            put(lit[1], finite(dot(slope, direction)));
            put(lit[2], finite(slope.x * pixel));
            put(lit[3], finite(slope.y * pixel));
        }
    }

    // Returns true where float32 is good enough for the scalars (facts/far_scalars.h).
    DoubleMask set_whole() {
        const double origin = view_.range.lo, width = view_.range.hi - view_.range.lo;
        set_scalars(origin, width);
        const Double least = (least_ - origin) / width, largest = (largest_ - origin) / width;
        put(lanes_.limits[0], least);
        put(lanes_.limits[1], largest);
        const Double most = max(-least, largest - 1);
        const DoubleMask meets = (least < 1) & (largest > 0);
        return most <= select(meets, Double(far_for_floats), farthest_normalised);
    }

    void set_part() {
        const Double from = get(lanes_.piece_from), to = get(lanes_.piece_to);
        const Double low = clamp(least_, from, to), high = clamp(largest_, from, to);
        set_scalars(low, high - low);
        const Cut lower = cut_at(low, from > least_, true);
        const Cut upper = cut_at(high, to < largest_, false);
        put(lanes_.cuts[0], lower.depth);
        put(lanes_.cuts[1], lower.per_column);
        put(lanes_.cuts[2], lower.per_row);
        put(lanes_.cuts[3], upper.depth);
        put(lanes_.limits[0], upper.per_column);
        put(lanes_.limits[1], upper.per_row);
        const auto bit = [&](DoubleMask front, std::uint32_t value)
                             LAMINA_LAMBDA { return zero_unless(front, Double(value)); };
        fronts_ += bit(lower.front, FragmentRecord::lower_cut_is_front) +
                   bit(upper.front, FragmentRecord::upper_cut_is_front);
        const Double width = to - from;
        constexpr std::size_t extinction = 3;
        Double most = 0;
        for (std::size_t channel = 0; channel < 4; ++channel) {
            const Double at_from = get(lanes_.at_from[channel]), at_to = get(lanes_.at_to[channel]);
            const auto at = [&](Double scalar) LAMINA_LAMBDA {
                const Double sum =
                    at_from * ((to - scalar) / width) + at_to * ((scalar - from) / width);
                return finite(select(at_from == at_to, at_from, sum));
            };
            const Double at_low = at(low), at_high = at(high);
            put(lanes_.low[channel], at_low);
            put(lanes_.high[channel], at_high);
            if (channel == extinction) most = max(at_low, at_high);
        }
        Double longest = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = i + 1; j < 4; ++j) {
                const Point edge = seen_[j] - seen_[i];
                longest = max(longest, dot(edge, edge));
            }
        }
        put(lanes_.largest_depth, sqrt(longest) * most);
    }

    // A plane of constant scalar, as in FragmentRecord.
    struct Cut {
        Double depth, per_column, per_row;
        DoubleMask front;
    };
    Cut cut_at(Double level, DoubleMask is_cut, bool lower) const {
        const Double above_eye = level - scalar_at({0, 0, 0});
        const Double divisor = view_.perspective ? above_eye : gradient_.z;
        const DoubleMask positive = divisor >= 0;
        const Double kept = select(positive, max(divisor, 1e-200), min(divisor, -1e-200));
        const Double per_pixel = -view_.view.pixel / kept;
        Double per_column = gradient_.x * per_pixel, per_row = gradient_.y * per_pixel;
        Double depth =
            at_center((view_.perspective ? -gradient_.z : above_eye) / kept, per_column, per_row);
        const Double size = max(largest_of({depth, per_column, per_row}), 1);
        const Double factor = min(1, beyond_all / size);
        const DoubleMask front = lower ? positive : !positive;
        const auto where_cut = [&](Double value, Double else_value)
                                   LAMINA_LAMBDA { return select(is_cut, value, else_value); };
        return {where_cut(depth * factor, -beyond_all), where_cut(per_column * factor, 0),
                where_cut(per_row * factor, 0), front | !is_cut};
    }

    const SetupView& view_;
    TetSetup::Lanes& lanes_;
    std::size_t first_;
    Point seen_[4];
    Double values_[4];
    Double fronts_, nearest_, farthest_, columns_, rows_, column_, row_, center_depth_, center_z_,
        least_, largest_;
    Point gradient_;
    DoubleMask visible_;
};

LAMINA_SIMD_END

#endif
