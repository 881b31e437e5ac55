// SPDX-License-Identifier: Apache-2.0
// TetProjector's computations on vectors of tets; the projector's comments give the reasons. Points
// are relative to the eye, along right, up and forward.
#if defined(LAMINA_PROJECTION_TET_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_SETUP_INL_H_
#undef LAMINA_PROJECTION_TET_SETUP_INL_H_
#else
#define LAMINA_PROJECTION_TET_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "projection/tet_setup_lanes.h"
#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, TetSetup::most_parts>;
using VD = hn::Vec<DD>;
using MD = hn::Mask<DD>;

struct Point {
    VD x, y, z;
};

HWY_INLINE Point operator-(const Point& a, const Point& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE VD dot(const Point& a, const Point& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Point cross(const Point& a, const Point& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
HWY_INLINE Point scaled(const Point& a, VD factor) {
    return {hn::Mul(a.x, factor), hn::Mul(a.y, factor), hn::Mul(a.z, factor)};
}
HWY_INLINE VD largest_of(const Point& a) {
    return hn::Max(hn::Abs(a.x), hn::Max(hn::Abs(a.y), hn::Abs(a.z)));
}
HWY_INLINE VD to_float_and_back(VD v) {
    const DD d;
    return hn::PromoteTo(d, hn::DemoteTo(hn::Rebind<float, DD>(), v));
}

class TetVectors {
  public:
    TetVectors(const SetupView& view, TetSetup::Lanes& lanes, std::size_t first)
        : view_(view), lanes_(lanes), first_(first) {}

    void set_up(bool parts, bool lit) {
        see();
        place_center();
        MD good = find_faces();
        good = hn::And(good, find_gradient());
        if (parts) {
            set_part();
        } else {
            set_whole();
        }
        if (lit) set_gradients();
        store(lanes_.good, hn::IfThenElseZero(good, one()));
        store(lanes_.visible, hn::IfThenElseZero(visible_, one()));
    }

  private:
    using Row = TetSetup::Lanes::Row;
    VD load(const Row& row) const { return hn::Load(d_, row.data() + first_); }
    void store(Row& row, VD v) const { hn::Store(v, d_, row.data() + first_); }
    VD set(double value) const { return hn::Set(d_, value); }
    VD one() const { return set(1); }

    void see() {
        const View& view = view_.view;
        for (std::size_t i = 0; i < 4; ++i) {
            const Point p{hn::Sub(load(lanes_.x[i]), set(view.eye.x)),
                          hn::Sub(load(lanes_.y[i]), set(view.eye.y)),
                          hn::Sub(load(lanes_.z[i]), set(view.eye.z))};
            const auto along = [&](const glm::dvec3& axis) HWY_ATTR {
                return dot(p, Point{set(axis.x), set(axis.y), set(axis.z)});
            };
            seen_[i] = {along(view.right), along(view.up), along(view.forward)};
            values_[i] = load(lanes_.value[i]);
        }
    }

    VD inverted(VD value) const { return view_.perspective ? hn::Div(set(-1), value) : value; }

    void place_center() {
        const VD width = set(view_.view.width), height = set(view_.view.height),
                 zero = hn::Zero(d_), half = set(0.5);
        VD lo_x = set(INFINITY), lo_y = lo_x, hi_x = set(-INFINITY), hi_y = hi_x, sum = zero;
        nearest_ = lo_x;
        farthest_ = zero;
        for (const Point& p : seen_) {
            const VD scale =
                view_.perspective ? hn::Mul(set(view_.view.pixel), p.z) : set(view_.view.pixel);
            const VD column = hn::Add(hn::Mul(half, width), hn::Div(p.x, scale)),
                     row = hn::Add(hn::Mul(half, height), hn::Div(p.y, scale));
            lo_x = hn::Min(lo_x, column);
            hi_x = hn::Max(hi_x, column);
            lo_y = hn::Min(lo_y, row);
            hi_y = hn::Max(hi_y, row);
            sum = hn::Add(sum, hn::Mul(p.z, set(0.25)));
            nearest_ = hn::Min(nearest_, p.z);
            farthest_ = hn::Max(farthest_, p.z);
        }
        set_bounds(lo_x, hi_x, lo_y, hi_y);
        const auto inside = [&](VD v, VD size) HWY_ATTR { return hn::Min(hn::Max(v, zero), size); };
        lo_x = inside(lo_x, width);
        hi_x = inside(hi_x, width);
        lo_y = inside(lo_y, height);
        hi_y = inside(hi_y, height);
        columns_ = hn::Sub(hi_x, lo_x);
        rows_ = hn::Sub(hi_y, lo_y);
        const VD column =
            to_float_and_back(hn::Add(hn::Floor(hn::Mul(half, hn::Add(lo_x, hi_x))), half));
        const VD row =
            to_float_and_back(hn::Add(hn::Floor(hn::Mul(half, hn::Add(lo_y, hi_y))), half));
        store(lanes_.center_column, column);
        store(lanes_.center_row, row);
        column_ = hn::Sub(column, hn::Mul(half, width));
        row_ = hn::Sub(row, hn::Mul(half, height));
        center_depth_ = to_float_and_back(inverted(sum));
        store(lanes_.center_depth, center_depth_);
        center_z_ = inverted(center_depth_);
        store(lanes_.center_z, center_z_);
    }

    // Sets the bounds of the pixel centres that may be covered (pixel_bounds()).
    void set_bounds(VD lo_x, VD hi_x, VD lo_y, VD hi_y) {
        const VD least = set(0.5 + view_.margin), most = set(view_.margin - 0.5),
                 zero = hn::Zero(d_);
        const VD first_column = hn::Max(hn::Ceil(hn::Sub(lo_x, least)), zero),
                 first_row = hn::Max(hn::Ceil(hn::Sub(lo_y, least)), zero);
        const VD last_column = hn::Min(hn::Floor(hn::Add(hi_x, most)), set(view_.view.width - 1));
        const VD last_row = hn::Min(hn::Floor(hn::Add(hi_y, most)), set(view_.view.height - 1));
        visible_ = hn::And(hn::Le(first_column, last_column), hn::Le(first_row, last_row));
        store(lanes_.first_column, first_column);
        store(lanes_.last_column, last_column);
        store(lanes_.first_row, first_row);
        store(lanes_.last_row, last_row);
    }

    // The plane's depth at the center, from its change per pixel.
    VD at_center(VD at_middle, VD per_column, VD per_row) const {
        return hn::Sub(
            hn::Add(hn::Add(at_middle, hn::Mul(column_, per_column)), hn::Mul(row_, per_row)),
            center_depth_);
    }

    // Returns true where the signs are certain and float32 is good enough.
    MD find_faces() {
        VD reach = hn::Zero(d_), rounding = hn::Zero(d_), fronts = hn::Zero(d_);
        VD size = hn::Zero(d_), steepest = size;
        for (const Point& p : seen_) {
            reach = hn::Max(reach, largest_of(p));
            size = hn::Max(size, largest_of(p - seen_[0]));
        }
        const VD doubt = set(doubtful_sign);
        const VD least_divisor =
            hn::Mul(doubt, hn::Mul(hn::Mul(reach, reach), view_.perspective ? reach : one()));
        // Points at distance `reach` are rounded, and so are their edges. The normals of slivers
        // are small differences of products of edges.
        const VD least_across = hn::Mul(doubt, hn::Mul(reach, hn::Mul(size, size)));
        MD good = hn::Gt(nearest_, set(view_.near_depth));
        for (std::size_t face = 0; face < 4; ++face) {
            const Point &a = seen_[face == 0 ? 1 : 0], &b = seen_[face <= 1 ? 2 : 1],
                        &c = seen_[face == 3 ? 2 : 3];
            const Point normal = cross(b - a, c - a);
            const VD distance = dot(normal, a), across = dot(normal, seen_[face] - a);
            const VD divisor = view_.perspective ? distance : normal.z;
            good = hn::And(good, hn::And(hn::Gt(hn::Abs(divisor), least_divisor),
                                         hn::Gt(hn::Abs(across), least_across)));
            const VD front =
                hn::IfThenElseZero(hn::Gt(hn::Mul(divisor, across), hn::Zero(d_)), one());
            const VD per_pixel = hn::Div(set(-view_.view.pixel), divisor);
            const VD per_column = hn::Mul(normal.x, per_pixel),
                     per_row = hn::Mul(normal.y, per_pixel);
            const VD depth =
                at_center(hn::Div(view_.perspective ? hn::Neg(normal.z) : distance, divisor),
                          per_column, per_row);
            store(lanes_.front[face], front);
            store(lanes_.depth[face], depth);
            store(lanes_.per_column[face], per_column);
            store(lanes_.per_row[face], per_row);
            fronts = hn::Add(fronts, front);
            steepest = hn::Max(steepest, hn::Add(hn::Abs(per_column), hn::Abs(per_row)));
            rounding = hn::Max(
                rounding, hn::Add(hn::Add(hn::Abs(depth), hn::Mul(columns_, hn::Abs(per_column))),
                                  hn::Mul(rows_, hn::Abs(per_row))));
        }
        const VD thickness = hn::Sub(farthest_, nearest_);
        const VD range =
            view_.perspective ? hn::Div(thickness, hn::Mul(farthest_, farthest_)) : thickness;
        store(lanes_.farthest, hn::Add(hn::Sub(inverted(farthest_), center_depth_),
                                       hn::Mul(set(float_tolerance), range)));
        const VD float_rounding = hn::Mul(rounding, set(float_epsilon)),
                 tolerance = hn::Mul(set(float_tolerance), range);
        good = hn::And(good, hn::Le(float_rounding, tolerance));
        // Whether rounding alone may make runs: where its error in depth is not small, or where the
        // horizon (depth 0) is near.
        MD bounded = hn::Gt(hn::Mul(set(100), float_rounding), tolerance);
        if (view_.perspective)
            bounded = hn::Or(bounded, hn::Gt(hn::Mul(set(16), steepest), hn::Abs(center_depth_)));
        store(lanes_.bounded, hn::IfThenElseZero(bounded, one()));
        return hn::And(good, hn::And(hn::Gt(fronts, hn::Zero(d_)), hn::Lt(fronts, set(4))));
    }

    // Finds the scalar's gradient; returns true where it is a number.
    MD find_gradient() {
        const Point e1 = seen_[1] - seen_[0], e2 = seen_[2] - seen_[0], e3 = seen_[3] - seen_[0];
        const Point n1 = cross(e2, e3), n2 = cross(e3, e1), n3 = cross(e1, e2);
        const VD v1 = hn::Sub(values_[1], values_[0]), v2 = hn::Sub(values_[2], values_[0]),
                 v3 = hn::Sub(values_[3], values_[0]);
        const auto sum = [&](VD a, VD b, VD c) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(v1, a), hn::Mul(v2, b)), hn::Mul(v3, c));
        };
        gradient_ = scaled({sum(n1.x, n2.x, n3.x), sum(n1.y, n2.y, n3.y), sum(n1.z, n2.z, n3.z)},
                           hn::Div(one(), dot(e1, n1)));
        least_ = hn::Min(hn::Min(values_[0], values_[1]), hn::Min(values_[2], values_[3]));
        largest_ = hn::Max(hn::Max(values_[0], values_[1]), hn::Max(values_[2], values_[3]));
        return hn::Le(largest_of(gradient_), hn::Mul(set(1e30), hn::Sub(largest_, least_)));
    }

    VD scalar_at(const Point& point) const {
        return hn::Add(values_[0], dot(gradient_, point - seen_[0]));
    }
    VD finite(VD v) const { return hn::Min(hn::Max(v, set(-beyond_all)), set(beyond_all)); }

    // Sets the scalar as (scalar - origin) / width.
    void set_scalars(VD origin, VD width) {
        const VD scale = hn::IfThenElseZero(hn::Gt(width, hn::Zero(d_)), hn::Div(one(), width));
        const VD pixel = set(view_.view.pixel), x = hn::Mul(column_, pixel),
                 y = hn::Mul(row_, pixel), z = center_z_;
        const Point direction =
            view_.perspective ? Point{x, y, one()} : Point{hn::Zero(d_), hn::Zero(d_), one()};
        const Point center = view_.perspective ? scaled(direction, z) : Point{x, y, z};
        const Point gradient = scaled(gradient_, scale);
        store(lanes_.scalar, finite(hn::Mul(hn::Sub(scalar_at(center), origin), scale)));
        store(lanes_.scalar_per_z, finite(dot(gradient, direction)));
        store(lanes_.scalar_per_column, finite(hn::Mul(gradient.x, pixel)));
        store(lanes_.scalar_per_row, finite(hn::Mul(gradient.y, pixel)));
    }

    // The components of the gradient, as set_scalars() sets the scalar.
    void set_gradients() {
        const Point e1 = seen_[1] - seen_[0], e2 = seen_[2] - seen_[0], e3 = seen_[3] - seen_[0];
        const Point n1 = cross(e2, e3), n2 = cross(e3, e1), n3 = cross(e1, e2);
        const VD inverse = hn::Div(one(), dot(e1, n1));
        const VD pixel = set(view_.view.pixel), x = hn::Mul(column_, pixel),
                 y = hn::Mul(row_, pixel), z = center_z_;
        const Point direction =
            view_.perspective ? Point{x, y, one()} : Point{hn::Zero(d_), hn::Zero(d_), one()};
        const Point center = view_.perspective ? scaled(direction, z) : Point{x, y, z};
        const Point from_corner = center - seen_[0];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& corners = lanes_.gradient[axis];
            const VD first = load(corners[0]);
            const VD v1 = hn::Sub(load(corners[1]), first), v2 = hn::Sub(load(corners[2]), first),
                     v3 = hn::Sub(load(corners[3]), first);
            const auto sum = [&](VD a, VD b, VD c) HWY_ATTR {
                return hn::Mul(inverse,
                               hn::Add(hn::Add(hn::Mul(v1, a), hn::Mul(v2, b)), hn::Mul(v3, c)));
            };
            const Point slope{sum(n1.x, n2.x, n3.x), sum(n1.y, n2.y, n3.y), sum(n1.z, n2.z, n3.z)};
            auto& lit = lanes_.lit[axis];
            store(lit.at_center, finite(hn::Add(first, dot(slope, from_corner))));
            store(lit.per_z, finite(dot(slope, direction)));
            store(lit.per_column, finite(hn::Mul(slope.x, pixel)));
            store(lit.per_row, finite(hn::Mul(slope.y, pixel)));
        }
    }

    void set_whole() {
        const VD origin = set(view_.range.lo), width = set(view_.range.hi - view_.range.lo);
        set_scalars(origin, width);
        store(lanes_.limits[0], hn::Div(hn::Sub(least_, origin), width));
        store(lanes_.limits[1], hn::Div(hn::Sub(largest_, origin), width));
    }

    void set_part() {
        const VD from = load(lanes_.piece_from), to = load(lanes_.piece_to);
        const VD low = hn::Min(hn::Max(least_, from), to),
                 high = hn::Min(hn::Max(largest_, from), to);
        set_scalars(low, hn::Sub(high, low));
        set_cut(low, hn::Gt(from, least_), true, lanes_.lower_cut);
        set_cut(high, hn::Lt(to, largest_), false, lanes_.upper_cut);
        const VD width = hn::Sub(to, from);
        constexpr std::size_t extinction = 3;
        VD most = hn::Zero(d_);
        for (std::size_t channel = 0; channel < 4; ++channel) {
            const VD at_from = load(lanes_.at_from[channel]), at_to = load(lanes_.at_to[channel]);
            const auto at = [&](VD scalar) HWY_ATTR {
                const VD sum = hn::Add(hn::Mul(at_from, hn::Div(hn::Sub(to, scalar), width)),
                                       hn::Mul(at_to, hn::Div(hn::Sub(scalar, from), width)));
                return finite(hn::IfThenElse(hn::Eq(at_from, at_to), at_from, sum));
            };
            const VD at_low = at(low), at_high = at(high);
            store(lanes_.low[channel], at_low);
            store(lanes_.high[channel], at_high);
            if (channel == extinction) most = hn::Max(at_low, at_high);
        }
        VD longest = hn::Zero(d_);
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = i + 1; j < 4; ++j) {
                const Point edge = seen_[j] - seen_[i];
                longest = hn::Max(longest, dot(edge, edge));
            }
        }
        store(lanes_.largest_depth, hn::Mul(hn::Sqrt(longest), most));
    }

    void set_cut(VD level, MD is_cut, bool lower, TetSetup::Lanes::Cut& cut) {
        const VD above_eye = hn::Sub(level, scalar_at({hn::Zero(d_), hn::Zero(d_), hn::Zero(d_)}));
        const VD divisor = view_.perspective ? above_eye : gradient_.z;
        const MD positive = hn::Ge(divisor, hn::Zero(d_));
        const VD kept =
            hn::IfThenElse(positive, hn::Max(divisor, set(1e-200)), hn::Min(divisor, set(-1e-200)));
        const VD per_pixel = hn::Div(set(-view_.view.pixel), kept);
        VD per_column = hn::Mul(gradient_.x, per_pixel), per_row = hn::Mul(gradient_.y, per_pixel);
        VD depth = at_center(hn::Div(view_.perspective ? hn::Neg(gradient_.z) : above_eye, kept),
                             per_column, per_row);
        const VD size = hn::Max(largest_of({depth, per_column, per_row}), one());
        const VD factor = hn::Min(one(), hn::Div(set(beyond_all), size));
        const MD front = lower ? positive : hn::Not(positive);
        const auto where_cut = [&](VD value, VD else_value)
                                   HWY_ATTR { return hn::IfThenElse(is_cut, value, else_value); };
        store(cut.depth, where_cut(hn::Mul(depth, factor), set(-beyond_all)));
        store(cut.per_column, where_cut(hn::Mul(per_column, factor), hn::Zero(d_)));
        store(cut.per_row, where_cut(hn::Mul(per_row, factor), hn::Zero(d_)));
        store(cut.front, where_cut(hn::IfThenElseZero(front, one()), one()));
    }

    const SetupView& view_;
    TetSetup::Lanes& lanes_;
    std::size_t first_;
    DD d_;
    Point seen_[4];
    VD values_[4];
    VD nearest_, farthest_, columns_, rows_, column_, row_, center_depth_, center_z_, least_,
        largest_;
    Point gradient_;
    MD visible_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
