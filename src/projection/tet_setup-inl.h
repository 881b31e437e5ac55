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

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "facts/far_scalars.h"
#include "projection/face_planes-inl.h"
#include "projection/point_vectors-inl.h"
#include "projection/stored_gradients.h"
#include "projection/tet_record.h"
#include "projection/tet_setup_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
            good = hn::And(good, set_whole());
        }
        if (lit) set_gradients();
        store_whole(lanes_.limits[2], fronts_);
        store(lanes_.good, hn::IfThenElseZero(good, one()));
        store(lanes_.visible, hn::IfThenElseZero(visible_, one()));
    }

  private:
    using Row = TetSetup::Lanes::Row;
    using FloatRow = TetSetup::Lanes::FloatRow;
    VD load(const Row& row) const { return hn::Load(d_, row.data() + first_); }
    void store(Row& row, VD v) const { hn::Store(v, d_, row.data() + first_); }
    void store(FloatRow& row, VD v) const {
        const hn::Rebind<float, DD> floats;
        hn::Store(hn::DemoteTo(floats, v), floats, row.data() + first_);
    }
    // Stores whole numbers as 32-bit integers, in the bits of floats.
    void store_whole(FloatRow& row, VD v) const {
        const hn::Rebind<float, DD> floats;
        const hn::Rebind<std::int32_t, DD> numbers;
        hn::Store(hn::BitCast(floats, hn::DemoteTo(numbers, v)), floats, row.data() + first_);
    }
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
        store(lanes_.center[0], column);
        store(lanes_.center[1], row);
        column_ = hn::Sub(column, hn::Mul(half, width));
        row_ = hn::Sub(row, hn::Mul(half, height));
        center_depth_ = to_float_and_back(inverted(sum));
        store(lanes_.center[2], center_depth_);
        center_z_ = inverted(center_depth_);
        store(lanes_.center[3], center_z_);
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
        store_whole(lanes_.pixels[0], first_column);
        store_whole(lanes_.pixels[1], last_column);
        const VD top = set(view_.view.height - 1);
        store_whole(lanes_.pixels[2], hn::Sub(top, last_row));
        store_whole(lanes_.pixels[3], hn::Sub(top, first_row));
    }

    // The plane's depth at the center, from its change per pixel.
    VD at_center(VD at_middle, VD per_column, VD per_row) const {
        return hn::Sub(
            hn::Add(hn::Add(at_middle, hn::Mul(column_, per_column)), hn::Mul(row_, per_row)),
            center_depth_);
    }

    // Returns true where the signs are certain and float32 is good enough.
    MD find_faces() {
        VD reach = hn::Zero(d_), rounding = hn::Zero(d_);
        FacePlanes planes(d_);
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
            const MD front = hn::Gt(hn::Mul(divisor, across), hn::Zero(d_));
            const VD per_pixel = hn::Div(set(-view_.view.pixel), divisor);
            const VD per_column = hn::Mul(normal.x, per_pixel),
                     per_row = hn::Mul(normal.y, per_pixel);
            const VD depth =
                at_center(hn::Div(view_.perspective ? hn::Neg(normal.z) : distance, divisor),
                          per_column, per_row);
            planes.add(front, depth, per_column, per_row);
            steepest = hn::Max(steepest, hn::Add(hn::Abs(per_column), hn::Abs(per_row)));
            rounding = hn::Max(
                rounding, hn::Add(hn::Add(hn::Abs(depth), hn::Mul(columns_, hn::Abs(per_column))),
                                  hn::Mul(rows_, hn::Abs(per_row))));
        }
        for (std::size_t place = 0; place < 4; ++place) {
            store(lanes_.depth[place], planes.depth[place]);
            store(lanes_.per_column[place], planes.per_column[place]);
            store(lanes_.per_row[place], planes.per_row[place]);
        }
        fronts_ = planes.fronts;
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
        return hn::And(good, hn::And(hn::Gt(fronts_, hn::Zero(d_)), hn::Lt(fronts_, set(4))));
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
        store(lanes_.scalar[0], finite(hn::Mul(hn::Sub(scalar_at(center), origin), scale)));
        store(lanes_.scalar[1], finite(dot(gradient, direction)));
        store(lanes_.scalar[2], finite(hn::Mul(gradient.x, pixel)));
        store(lanes_.scalar[3], finite(hn::Mul(gradient.y, pixel)));
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
        VD largest = hn::Zero(d_);
        for (const auto& corners : lanes_.gradient) {
            for (const Row& corner : corners) largest = hn::Max(largest, hn::Abs(load(corner)));
        }
        // As StoredGradients::scale_of_tet().
        const VD most = set(StoredGradients::most_of_tet);
        const VD scale = hn::IfThenElse(hn::Gt(largest, most), hn::Div(most, largest), one());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& corners = lanes_.gradient[axis];
            const auto value = [&](std::size_t i)
                                   HWY_ATTR { return hn::Mul(load(corners[i]), scale); };
            const VD first = value(0);
            const VD v1 = hn::Sub(value(1), first), v2 = hn::Sub(value(2), first),
                     v3 = hn::Sub(value(3), first);
            const auto sum = [&](VD a, VD b, VD c) HWY_ATTR {
                return hn::Mul(inverse,
                               hn::Add(hn::Add(hn::Mul(v1, a), hn::Mul(v2, b)), hn::Mul(v3, c)));
            };
            const Point slope{sum(n1.x, n2.x, n3.x), sum(n1.y, n2.y, n3.y), sum(n1.z, n2.z, n3.z)};
            auto& lit = lanes_.lit[axis];
            store(lit[0], finite(hn::Add(first, dot(slope, from_corner))));
            store(lit[1], finite(dot(slope, direction)));
            store(lit[2], finite(hn::Mul(slope.x, pixel)));
            store(lit[3], finite(hn::Mul(slope.y, pixel)));
        }
    }

    // Returns true where float32 is good enough for the scalars (facts/far_scalars.h).
    MD set_whole() {
        const VD origin = set(view_.range.lo), width = set(view_.range.hi - view_.range.lo);
        set_scalars(origin, width);
        const VD least = hn::Div(hn::Sub(least_, origin), width),
                 largest = hn::Div(hn::Sub(largest_, origin), width);
        store(lanes_.limits[0], least);
        store(lanes_.limits[1], largest);
        const VD most = hn::Max(hn::Neg(least), hn::Sub(largest, one()));
        const MD meets = hn::And(hn::Lt(least, one()), hn::Gt(largest, hn::Zero(d_)));
        return hn::Le(most, hn::IfThenElse(meets, set(far_for_floats), set(farthest_normalised)));
    }

    void set_part() {
        const VD from = load(lanes_.piece_from), to = load(lanes_.piece_to);
        const VD low = hn::Min(hn::Max(least_, from), to),
                 high = hn::Min(hn::Max(largest_, from), to);
        set_scalars(low, hn::Sub(high, low));
        const Cut lower = cut_at(low, hn::Gt(from, least_), true);
        const Cut upper = cut_at(high, hn::Lt(to, largest_), false);
        store(lanes_.cuts[0], lower.depth);
        store(lanes_.cuts[1], lower.per_column);
        store(lanes_.cuts[2], lower.per_row);
        store(lanes_.cuts[3], upper.depth);
        store(lanes_.limits[0], upper.per_column);
        store(lanes_.limits[1], upper.per_row);
        const auto bit = [&](MD front, std::uint32_t value)
                             HWY_ATTR { return hn::IfThenElseZero(front, set(value)); };
        fronts_ = hn::Add(fronts_, hn::Add(bit(lower.front, TetRecord::lower_cut_is_front),
                                           bit(upper.front, TetRecord::upper_cut_is_front)));
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

    // A plane of constant scalar, as in TetRecord.
    struct Cut {
        VD depth, per_column, per_row;
        MD front;
    };
    Cut cut_at(VD level, MD is_cut, bool lower) const {
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
        return {where_cut(hn::Mul(depth, factor), set(-beyond_all)),
                where_cut(hn::Mul(per_column, factor), hn::Zero(d_)),
                where_cut(hn::Mul(per_row, factor), hn::Zero(d_)), hn::Or(front, hn::Not(is_cut))};
    }

    const SetupView& view_;
    TetSetup::Lanes& lanes_;
    std::size_t first_;
    DD d_;
    Point seen_[4];
    VD values_[4];
    VD fronts_, nearest_, farthest_, columns_, rows_, column_, row_, center_depth_, center_z_,
        least_, largest_;
    Point gradient_;
    MD visible_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
