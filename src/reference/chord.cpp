// SPDX-License-Identifier: Apache-2.0
#include "reference/chord.h"

#include <limits>

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/chord.cpp"
#include "simd/foreach_target.h"

#include "simd/double_doubles-inl.h"
#include "simd/lane_set.h"

LAMINA_SIMD_BEGIN
namespace reference {

// One coordinate of rays in index space: position + z * slope.
struct Coordinates {
    DoubleDoubles position, slope;
};

struct RaySpans {
    DoubleDoubles from, to;
};

// Returns the dot product. It skips zeros of b: the axes of most grids are along the world's.
LAMINA_INLINE DoubleDoubles dot(const DoubleDoubles (&a)[3], const glm::dvec3& b) {
    DoubleDoubles sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        if (b[i] != 0) sum = sum + a[i] * DoubleDoubles(b[i]);
    }
    return sum;
}

LAMINA_INLINE DoubleDoubles in_all_lanes(DoubleDouble value) {
    return {Double(value.hi), Double(value.lo)};
}

LAMINA_INLINE DoubleDoubles project(const DoubleDoubles (&vector)[3], const GridAxes::Axis& axis) {
    return dot(vector, axis.scaled) * in_all_lanes(axis.inverse_square) *
           DoubleDoubles(axis.unscale);
}

// Returns the z at which a coordinate is `first` and `second`.
LAMINA_INLINE RaySpans meet(const Coordinates& rays, double first, double second) {
    const DoubleDoubles to_first = DoubleDoubles(first) - rays.position;
    const DoubleDoubles to_second = DoubleDoubles(second) - rays.position;
    const DoubleDoubles inverse = DoubleDoubles(1.0) / rays.slope;
    const RaySpans met{to_first * inverse, to_second * inverse};
    // If the inverse is subnormal, its low part is lost: divide by the slope instead.
    const DoubleMask whole = inverse.finite() & (abs(inverse.hi) >= 1e-290);
    const DoubleMask slopes = rays.slope.hi != 0;
    if (all_of(whole | !slopes)) return met;
    return {select(whole, met.from, to_first / rays.slope),
            select(whole, met.to, to_second / rays.slope)};
}

// Clips a vector of rays to a grid's box and to half-spaces, as chord.h says.
class RayLanes {
  public:
    LAMINA_INLINE RayLanes(const GridAxes& grid, std::span<const View::Ray> rays)
        : grid_(grid), rays_(rays) {
        DoubleDoubles offset[3], direction[3];
        for (int i = 0; i < 3; ++i) {
            direction_[i] = row([&](const View::Ray& ray) { return ray.direction[i]; });
            direction[i] = DoubleDoubles(direction_[i]);
            offset[i] = exact_sum(row([&](const View::Ray& ray) { return ray.origin[i]; }),
                                  Double(-grid.origin[i]));
        }
        Double steepest = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Coordinates& along = along_[axis];
            along = {project(offset, grid.axes[axis]), project(direction, grid.axes[axis])};
            const DoubleMask finite = along.position.finite() & along.slope.finite();
            valid_ = axis == 0 ? finite : valid_ & finite;
            steepest = max(steepest, abs(along.slope.hi));
        }
        // Slopes that move less than 1e-30 voxels count as 0: their inverses might overflow.
        for (Coordinates& along : along_) {
            const DoubleMask none = abs(along.slope.hi) < 1e-40 * steepest;
            along.slope = select(none, DoubleDoubles(0.0), along.slope);
        }
    }

    // Finds the range of z >= 0 in which every coordinate is inside its closed range.
    LAMINA_INLINE void clip_to_faces() {
        inside_ = {0.0, std::numeric_limits<double>::infinity()};
        for (int axis = 0; axis < 3; ++axis) {
            const Coordinates& along = along_[axis];
            const double lowest = grid_.lowest[axis], highest = grid_.highest[axis];
            const DoubleMask slopes = along.slope.hi != 0;
            const DoubleMask outside = (along.position < DoubleDoubles(lowest)) |
                                       (DoubleDoubles(highest) < along.position);
            valid_ = valid_ & (slopes | !outside);
            const RaySpans met = meet(along, lowest, highest);
            const DoubleMask swapped = met.to < met.from;
            const DoubleDoubles near = select(swapped, met.to, met.from);
            const DoubleDoubles far = select(swapped, met.from, met.to);
            const DoubleMask later = slopes & (inside_.from < near);
            inside_.from = select(later, near, inside_.from);
            entry_axis_ = select(later, axis, entry_axis_);
            inside_.to = select(slopes & (far < inside_.to), far, inside_.to);
        }
        valid_ = valid_ & (inside_.from < inside_.to);
    }

    LAMINA_INLINE void clip_to(std::span<const HalfSpace> clip) {
        if (clip.empty()) return;
        const DoubleDoubles of_box = inside_.from;
        alignas(64) double rows[4][longest_vector];
        DoubleDoubles* const ends[2] = {&inside_.from, &inside_.to};
        for (std::size_t end = 0; end < 2; ++end) {
            store(ends[end]->hi, rows[2 * end]);
            store(ends[end]->lo, rows[2 * end + 1]);
        }
        for (std::size_t lane = 0; lane < std::min(rays_.size(), Double::lanes); ++lane) {
            RaySpan span{{rows[0][lane], rows[1][lane]}, {rows[2][lane], rows[3][lane]}};
            clip_span(clip, rays_[lane], span);
            rows[0][lane] = span.from.hi;
            rows[1][lane] = span.from.lo;
            rows[2][lane] = span.to.hi;
            rows[3][lane] = span.to.lo;
        }
        for (std::size_t end = 0; end < 2; ++end)
            *ends[end] = {load<Double>(rows[2 * end]), load<Double>(rows[2 * end + 1])};
        valid_ = valid_ & (inside_.from < inside_.to);
        entry_axis_ = select(of_box < inside_.from, -1, entry_axis_);
    }

    LAMINA_INLINE void write(std::span<Chord> chords) const {
        alignas(64) double entry[3][longest_vector], direction[3][longest_vector];
        alignas(64) double length[longest_vector], world_per_z[longest_vector];
        for (int axis = 0; axis < 3; ++axis) {
            const auto& [position, slope] = along_[axis];
            const Double lowest(grid_.lowest[axis]), highest(grid_.highest[axis]);
            const Double place = (position + slope * inside_.from).rounded();
            const Double steps = slope.rounded();
            const Double face = select(steps > 0, lowest, highest);
            const DoubleMask enters = entry_axis_ == axis;
            store(select(enters, face, clamp(place, lowest, highest)), entry[axis]);
            store(steps, direction[axis]);
        }
        const auto& [x, y, z] = direction_;
        store(sqrt(x * x + y * y + z * z), world_per_z);
        store(zero_unless(valid_, (inside_.to - inside_.from).rounded()), length);
        for (std::size_t lane = 0; lane < std::min(chords.size(), Double::lanes); ++lane) {
            chords[lane] = {};
            if (!(length[lane] > 0)) continue;
            chords[lane] = {{entry[0][lane], entry[1][lane], entry[2][lane]},
                            {direction[0][lane], direction[1][lane], direction[2][lane]},
                            length[lane],
                            world_per_z[lane]};
        }
    }

  private:
    // Returns one number of each ray. Lanes behind the last ray hold the last ray's.
    template <typename Of>
    LAMINA_INLINE Double row(const Of& of) const {
        alignas(64) double values[longest_vector];
        for (std::size_t lane = 0; lane < Double::lanes; ++lane)
            values[lane] = of(rays_[std::min(lane, rays_.size() - 1)]);
        return load<Double>(values);
    }

    const GridAxes& grid_;
    std::span<const View::Ray> rays_;
    Double direction_[3];
    Coordinates along_[3];
    RaySpans inside_;
    Double entry_axis_ = -1;  // axis of the face by which the ray enters; -1: by none
    DoubleMask valid_;        // lanes in which a part of the ray is left
};

}  // namespace reference

inline void clip_rays(const GridAxes& grid, std::span<const View::Ray> rays,
                      std::span<const HalfSpace> clip, std::span<Chord> chords) {
    using namespace reference;
    for (std::size_t i = 0; i < rays.size(); i += Double::lanes) {
        RayLanes lanes(grid, rays.subspan(i));
        lanes.clip_to_faces();
        lanes.clip_to(clip);
        lanes.write(chords.subspan(i));
    }
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {
namespace {

GridAxes::Axis scaled_axis(const glm::dvec3& step) {
    const double largest = std::max({std::abs(step.x), std::abs(step.y), std::abs(step.z)});
    int exponent = 0;
    std::frexp(largest, &exponent);
    --exponent;  // to [1, 2): even a subnormal distance from a face must not vanish
    GridAxes::Axis axis;
    DoubleDouble square;
    for (int i = 0; i < 3; ++i) {
        axis.scaled[i] = std::scalbn(step[i], -exponent);
        square = square + exact_product(axis.scaled[i], axis.scaled[i]);
    }
    axis.inverse_square = DoubleDouble{1, 0} / square;
    axis.unscale = std::scalbn(1.0, -exponent);
    return axis;
}

}  // namespace

GridAxes::GridAxes(const Grid& grid)
    : origin(grid.index_origin()),
      lowest(grid.index_min()),
      highest(grid.index_max()),
      axes{scaled_axis(grid.step[0]), scaled_axis(grid.step[1]), scaled_axis(grid.step[2])} {}

LAMINA_EXPORT(clip_rays);

void clip_to_box(const GridAxes& grid, std::span<const View::Ray> rays,
                 std::span<const HalfSpace> clip, std::span<Chord> chords) {
    LAMINA_DISPATCH(clip_rays)(grid, rays, clip, chords);
}

void clip_span(std::span<const HalfSpace> clip, const View::Ray& ray, RaySpan& span) {
    for (const HalfSpace& half : clip) {
        DoubleDouble distance, slope;  // from the plane at the ray's origin; change with z
        for (int axis = 0; axis < 3; ++axis) {
            const DoubleDouble normal{half.normal[axis], 0};
            distance = distance + normal * exact_sum(ray.origin[axis], -half.point[axis]);
            slope = slope + normal * DoubleDouble{ray.direction[axis], 0};
        }
        if (slope.hi == 0) {
            if (distance < DoubleDouble{}) span.to = span.from;
            continue;
        }
        const DoubleDouble at = -distance / slope;
        if (!at.finite()) {  // the ray is nearly parallel to the plane
            if (distance < DoubleDouble{}) span.to = span.from;
        } else if (slope.hi > 0) {
            if (span.from < at) span.from = at;
        } else {
            if (at < span.to) span.to = at;
        }
    }
}

SeenRange seen_range(std::span<const HalfSpace> clip, const View::Ray& ray) {
    RaySpan span{{0, 0}, {INFINITY, 0}};
    clip_span(clip, ray, span);
    return {span.from.rounded(), span.to.hi == INFINITY ? INFINITY : span.to.rounded()};
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
