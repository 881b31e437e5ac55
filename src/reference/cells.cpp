// SPDX-License-Identifier: Apache-2.0
#include "reference/cells.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/cells.cpp"
#include "simd/foreach_target.h"

#include "reference/cubic-inl.h"
#include "reference/transfer_intervals-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Returns a x + b.
LAMINA_INLINE Double sum(Double a, Double x, Double b) {
    return fma(a, x, b);
}

struct CornerLanes {
    Double v[8];

    LAMINA_INLINE CornerLanes(const CellBatch& cells, std::size_t i) {
        for (std::size_t corner = 0; corner < 8; ++corner)
            v[corner] = load<Double>(cells.corners[corner] + i);
    }
    LAMINA_INLINE Double least() const {
        return min(min(min(v[0], v[1]), min(v[2], v[3])), min(min(v[4], v[5]), min(v[6], v[7])));
    }
    LAMINA_INLINE Double most() const {
        return max(max(max(v[0], v[1]), max(v[2], v[3])), max(max(v[4], v[5]), max(v[6], v[7])));
    }
    // The sum of eight finite samples, which are floats at most, is finite.
    LAMINA_INLINE DoubleMask finite() const {
        return is_finite(v[0] + v[1] + (v[2] + v[3]) + (v[4] + v[5] + (v[6] + v[7])));
    }
};

// The chord inside cells, in the cells' coordinates: start + t * step, 0 <= t <= 1.
struct PathLanes {
    Double start[3], step[3], along;

    LAMINA_INLINE PathLanes(const CellBatch& cells, const Chord& chord, std::size_t i) {
        const Double from = load<Double>(cells.from + i);
        along = load<Double>(cells.to + i) - from;
        for (int axis = 0; axis < 3; ++axis) {
            const Double direction(chord.direction[axis]);
            const Double at = fma(from, direction, chord.entry[axis]);
            const Double cell = to_double(load<Long>(cells.cell[axis] + i));
            start[axis] = clamp(at - cell, 0, 1);
            step[axis] = along * direction;
        }
    }
};

LAMINA_INLINE Cubics field_along(const CornerLanes& corners, const PathLanes& path) {
    const Double(&v)[8] = corners.v;
    const Double x = v[1] - v[0], y = v[2] - v[0], z = v[4] - v[0];
    const Double xy = v[3] - v[2] - x, xz = v[5] - v[4] - x;
    const Double yz = v[6] - v[4] - y;
    const Double xyz = v[7] - v[6] - (v[5] - v[4]) - xy;
    const auto& [u, w, q] = path.start;
    const auto& [du, dw, dq] = path.step;
    // The field's derivatives at the start, by each axis and by pairs of them.
    const Double by_xy = sum(q, xyz, xy), by_xz = sum(w, xyz, xz), by_yz = sum(u, xyz, yz);
    const Double by_x = sum(w, by_xy, sum(q, xz, x)), by_y = sum(u, by_xy, sum(q, yz, y));
    const Double by_z = sum(u, by_xz, sum(w, yz, z));
    Cubics field;
    field.c[0] = sum(u, by_x, sum(w, sum(q, yz, y), sum(q, z, v[0])));
    field.c[1] = sum(du, by_x, sum(dw, by_y, dq * by_z));
    field.c[2] = sum(du * dw, by_xy, sum(du * dq, by_xz, dw * dq * by_yz));
    field.c[3] = du * dw * (dq * xyz);
    return field;
}

}  // namespace reference

// LAMINA_EXPORT takes functions of this namespace alone.
inline void make_segments_of(const CellBatch& cells, const Chord& chord,
                             const IntervalColumns& intervals, SegmentBatch& segments) {
    using namespace reference;
    const VisibleRanges visible(intervals);
    segments.count = 0;
    for (std::size_t i = 0; i < cells.count; i += Double::lanes) {
        const CornerLanes corners(cells, i);
        const Double lo = corners.least(), hi = corners.most();
        const DoubleMask seen =
            visible.meet(lo, hi) & corners.finite() & first_lanes<DoubleMask>(cells.count - i);
        if (none_of(seen)) continue;
        const PathLanes path(cells, chord, i);
        const Cubics field = field_along(corners, path);
        const KeptLanes kept(seen);
        const std::size_t first = segments.count;
        for (std::size_t power = 0; power < 4; ++power)
            kept.store(field.c[power], segments.scalar[power] + first);
        kept.store(lo, segments.lo + first);
        kept.store(hi, segments.hi + first);
        kept.store(path.along * chord.world_per_z, segments.length + first);
        kept.store(iota<Long>(static_cast<std::int64_t>(i)), segments.cell + first);
        segments.count += kept.count();
    }
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(make_segments_of);

void make_segments(const CellBatch& cells, const Chord& chord, const IntervalColumns& intervals,
                   SegmentBatch& segments) {
    LAMINA_DISPATCH(make_segments_of)(cells, chord, intervals, segments);
}

}  // namespace lamina
#endif
