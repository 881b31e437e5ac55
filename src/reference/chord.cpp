// SPDX-License-Identifier: Apache-2.0
#include "reference/chord.h"

#include <algorithm>

#include "reference/clip_span.h"
#include "reference/longest_vector.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/chord.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/double_doubles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// One coordinate of rays in index space: position + z * slope.
struct Coordinates {
    DoubleDoubles position, slope;
};

// A part of rays, as in RaySpan.
struct RaySpans {
    DoubleDoubles from, to;
};

// The dot product, in twice the precision of double. Axes of most grids are along the world's.
HWY_INLINE DoubleDoubles dot(const DoubleDoubles (&a)[3], const glm::dvec3& b) {
    DoubleDoubles sum = double_doubles(hn::Zero(Lanes()));
    for (int i = 0; i < 3; ++i) {
        if (b[i] != 0) sum = sum + a[i] * double_doubles(number(b[i]));
    }
    return sum;
}

HWY_INLINE DoubleDoubles all(DoubleDouble value) {
    return {number(value.hi), number(value.lo)};
}

// Projects on one (orthogonal) grid axis.
HWY_INLINE DoubleDoubles project(const DoubleDoubles (&vector)[3], const GridAxes::Axis& axis) {
    return dot(vector, axis.scaled) * all(axis.inverse_square) *
           double_doubles(number(axis.unscale));
}

// Where a coordinate meets two planes.
HWY_INLINE RaySpans meet(const Coordinates& rays, double first, double second) {
    const DoubleDoubles to_first = double_doubles(number(first)) - rays.position;
    const DoubleDoubles to_second = double_doubles(number(second)) - rays.position;
    const DoubleDoubles inverse = double_doubles(number(1)) / rays.slope;
    const RaySpans met{to_first * inverse, to_second * inverse};
    // A subnormal inverse has lost its low part.
    const Mask whole = hn::And(inverse.finite(), hn::Ge(hn::Abs(inverse.hi), number(1e-290)));
    const Mask slopes = hn::Ne(rays.slope.hi, hn::Zero(Lanes()));
    if (hn::AllTrue(Lanes(), hn::Or(whole, hn::Not(slopes)))) return met;
    return {where(whole, met.from, to_first / rays.slope),
            where(whole, met.to, to_second / rays.slope)};
}

// A vector of rays on their way to their chords.
class RayLanes {
  public:
    HWY_INLINE RayLanes(const GridAxes& grid, std::span<const View::Ray> rays)
        : grid_(grid), rays_(rays) {
        DoubleDoubles offset[3], direction[3];
        for (int i = 0; i < 3; ++i) {
            direction_[i] = row([&](const View::Ray& ray) { return ray.direction[i]; });
            direction[i] = double_doubles(direction_[i]);
            offset[i] = exact_sum(row([&](const View::Ray& ray) { return ray.origin[i]; }),
                                  number(-grid.origin[i]));
        }
        Doubles steepest = hn::Zero(Lanes());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Coordinates& along = along_[axis];
            along = {project(offset, grid.axes[axis]), project(direction, grid.axes[axis])};
            const Mask finite = hn::And(along.position.finite(), along.slope.finite());
            valid_ = axis == 0 ? finite : hn::And(valid_, finite);
            steepest = hn::Max(steepest, hn::Abs(along.slope.hi));
        }
        // A slope that moves the ray by less than 1e-30 voxels while it crosses the box has no
        // effect but a risk of overflow.
        for (Coordinates& along : along_) {
            const Mask none = hn::Lt(hn::Abs(along.slope.hi), hn::Mul(number(1e-40), steepest));
            along.slope = where(none, double_doubles(hn::Zero(Lanes())), along.slope);
        }
    }

    // The part of z >= 0 where every coordinate is inside its closed range.
    HWY_INLINE void clip_to_faces() {
        inside_ = {double_doubles(hn::Zero(Lanes())), double_doubles(hn::Inf(Lanes()))};
        for (int axis = 0; axis < 3; ++axis) {
            const Coordinates& along = along_[axis];
            const double lowest = grid_.lowest[axis], highest = grid_.highest[axis];
            const Mask slopes = hn::Ne(along.slope.hi, hn::Zero(Lanes()));
            const Mask outside = hn::Or(along.position < double_doubles(number(lowest)),
                                        double_doubles(number(highest)) < along.position);
            valid_ = hn::And(valid_, hn::Or(slopes, hn::Not(outside)));
            const RaySpans met = meet(along, lowest, highest);
            const Mask swapped = met.to < met.from;
            const DoubleDoubles near = where(swapped, met.to, met.from);
            const DoubleDoubles far = where(swapped, met.from, met.to);
            const Mask later = hn::And(slopes, inside_.from < near);
            inside_.from = where(later, near, inside_.from);
            entry_axis_ = hn::IfThenElse(later, number(axis), entry_axis_);
            inside_.to = where(hn::And(slopes, far < inside_.to), far, inside_.to);
        }
        valid_ = hn::And(valid_, inside_.from < inside_.to);
    }

    HWY_INLINE void clip_to(std::span<const HalfSpace> clip) {
        if (clip.empty()) return;
        const DoubleDoubles of_box = inside_.from;
        alignas(64) double rows[4][longest_vector];
        DoubleDoubles* const ends[2] = {&inside_.from, &inside_.to};
        for (std::size_t end = 0; end < 2; ++end) {
            hn::Store(ends[end]->hi, Lanes(), rows[2 * end]);
            hn::Store(ends[end]->lo, Lanes(), rows[2 * end + 1]);
        }
        for (std::size_t lane = 0; lane < std::min(rays_.size(), hn::Lanes(Lanes())); ++lane) {
            RaySpan span{{rows[0][lane], rows[1][lane]}, {rows[2][lane], rows[3][lane]}};
            clip_span(clip, rays_[lane], span);
            rows[0][lane] = span.from.hi;
            rows[1][lane] = span.from.lo;
            rows[2][lane] = span.to.hi;
            rows[3][lane] = span.to.lo;
        }
        for (std::size_t end = 0; end < 2; ++end)
            *ends[end] = {hn::Load(Lanes(), rows[2 * end]), hn::Load(Lanes(), rows[2 * end + 1])};
        valid_ = hn::And(valid_, inside_.from < inside_.to);
        entry_axis_ = hn::IfThenElse(of_box < inside_.from, number(-1), entry_axis_);
    }

    HWY_INLINE void store(std::span<Chord> chords) const {
        alignas(64) double entry[3][longest_vector], direction[3][longest_vector];
        alignas(64) double length[longest_vector], world_per_z[longest_vector];
        for (int axis = 0; axis < 3; ++axis) {
            const auto& [position, slope] = along_[axis];
            const Doubles lowest = number(grid_.lowest[axis]),
                          highest = number(grid_.highest[axis]);
            const Doubles place = (position + slope * inside_.from).rounded();
            const Doubles steps = slope.rounded();
            const Doubles face = hn::IfThenElse(hn::Gt(steps, hn::Zero(Lanes())), lowest, highest);
            const Mask enters = hn::Eq(entry_axis_, number(axis));
            hn::Store(hn::IfThenElse(enters, face, hn::Min(hn::Max(place, lowest), highest)),
                      Lanes(), entry[axis]);
            hn::Store(steps, Lanes(), direction[axis]);
        }
        const auto& [x, y, z] = direction_;
        hn::Store(hn::Sqrt(hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z))), Lanes(),
                  world_per_z);
        hn::Store(hn::IfThenElseZero(valid_, (inside_.to - inside_.from).rounded()), Lanes(),
                  length);
        for (std::size_t lane = 0; lane < std::min(chords.size(), hn::Lanes(Lanes())); ++lane) {
            chords[lane] = {};
            if (!(length[lane] > 0)) continue;
            chords[lane] = {{entry[0][lane], entry[1][lane], entry[2][lane]},
                            {direction[0][lane], direction[1][lane], direction[2][lane]},
                            length[lane],
                            world_per_z[lane]};
        }
    }

  private:
    // Lanes behind the last ray repeat it.
    template <typename Of>
    HWY_INLINE Doubles row(const Of& of) const {
        alignas(64) double values[longest_vector];
        for (std::size_t lane = 0; lane < hn::Lanes(Lanes()); ++lane)
            values[lane] = of(rays_[std::min(lane, rays_.size() - 1)]);
        return hn::Load(Lanes(), values);
    }

    const GridAxes& grid_;
    std::span<const View::Ray> rays_;
    Doubles direction_[3];
    Coordinates along_[3];
    RaySpans inside_;
    Doubles entry_axis_ = number(-1);
    Mask valid_;
};

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline void clip_rays(const GridAxes& grid, std::span<const View::Ray> rays,
                      std::span<const HalfSpace> clip, std::span<Chord> chords) {
    using namespace reference;
    for (std::size_t i = 0; i < rays.size(); i += hn::Lanes(Lanes())) {
        RayLanes lanes(grid, rays.subspan(i));
        lanes.clip_to_faces();
        lanes.clip_to(clip);
        lanes.store(chords.subspan(i));
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(clip_rays);

void clip_to_box(const GridAxes& grid, std::span<const View::Ray> rays,
                 std::span<const HalfSpace> clip, std::span<Chord> chords) {
    HWY_DYNAMIC_DISPATCH(clip_rays)(grid, rays, clip, chords);
}

Chord clip_to_box(const GridAxes& grid, const View::Ray& ray, std::span<const HalfSpace> clip) {
    Chord chord;
    clip_to_box(grid, {&ray, 1}, clip, {&chord, 1});
    return chord;
}

Chord clip_to_box(const Grid& grid, const View::Ray& ray, std::span<const HalfSpace> clip) {
    return clip_to_box(GridAxes(grid), ray, clip);
}

double chord_length(const Grid& grid, const View& view, double column, double row) {
    return clip_to_box(grid, view.ray(column, row)).world_length();
}

}  // namespace lamina
#endif
