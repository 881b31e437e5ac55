// SPDX-License-Identifier: Apache-2.0
#include "reference/cell_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/cell_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/cubic_lanes-inl.h"
#include "reference/visible_ranges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// Returns a x + b.
HWY_INLINE Doubles sum(Doubles a, Doubles x, Doubles b) {
    return hn::MulAdd(a, x, b);
}

struct CornerLanes {
    Doubles v[8];

    HWY_INLINE CornerLanes(const CellBatch& cells, std::size_t i) {
        for (std::size_t corner = 0; corner < 8; ++corner)
            v[corner] = hn::Load(Lanes(), cells.corners[corner] + i);
    }
    HWY_INLINE Doubles least() const {
        return hn::Min(hn::Min(hn::Min(v[0], v[1]), hn::Min(v[2], v[3])),
                       hn::Min(hn::Min(v[4], v[5]), hn::Min(v[6], v[7])));
    }
    HWY_INLINE Doubles most() const {
        return hn::Max(hn::Max(hn::Max(v[0], v[1]), hn::Max(v[2], v[3])),
                       hn::Max(hn::Max(v[4], v[5]), hn::Max(v[6], v[7])));
    }
    // The sum of eight finite samples, which are floats at most, is finite.
    HWY_INLINE Mask finite() const {
        return hn::IsFinite(hn::Add(hn::Add(hn::Add(v[0], v[1]), hn::Add(v[2], v[3])),
                                    hn::Add(hn::Add(v[4], v[5]), hn::Add(v[6], v[7]))));
    }
};

// The chord inside cells, in the cells' coordinates: start + t * step, 0 <= t <= 1.
struct PathLanes {
    Doubles start[3], step[3], along;

    HWY_INLINE PathLanes(const CellBatch& cells, const Chord& chord, std::size_t i) {
        const Lanes d;
        const Doubles from = hn::Load(d, cells.from + i);
        along = hn::Sub(hn::Load(d, cells.to + i), from);
        for (int axis = 0; axis < 3; ++axis) {
            const Doubles direction = number(chord.direction[axis]);
            const Doubles at = hn::MulAdd(from, direction, number(chord.entry[axis]));
            const Doubles cell = hn::ConvertTo(d, hn::Load(NumberLanes(), cells.cell[axis] + i));
            start[axis] = hn::Min(hn::Max(hn::Sub(at, cell), hn::Zero(d)), number(1));
            step[axis] = hn::Mul(along, direction);
        }
    }
};

HWY_INLINE Cubics field_along(const CornerLanes& corners, const PathLanes& path) {
    const Doubles(&v)[8] = corners.v;
    const Doubles x = hn::Sub(v[1], v[0]), y = hn::Sub(v[2], v[0]), z = hn::Sub(v[4], v[0]);
    const Doubles xy = hn::Sub(hn::Sub(v[3], v[2]), x), xz = hn::Sub(hn::Sub(v[5], v[4]), x);
    const Doubles yz = hn::Sub(hn::Sub(v[6], v[4]), y);
    const Doubles xyz = hn::Sub(hn::Sub(hn::Sub(v[7], v[6]), hn::Sub(v[5], v[4])), xy);
    const auto& [u, w, q] = path.start;
    const auto& [du, dw, dq] = path.step;
    // The field's derivatives at the start, by each axis and by pairs of them.
    const Doubles by_xy = sum(q, xyz, xy), by_xz = sum(w, xyz, xz), by_yz = sum(u, xyz, yz);
    const Doubles by_x = sum(w, by_xy, sum(q, xz, x)), by_y = sum(u, by_xy, sum(q, yz, y));
    const Doubles by_z = sum(u, by_xz, sum(w, yz, z));
    Cubics field;
    field.c[0] = sum(u, by_x, sum(w, sum(q, yz, y), sum(q, z, v[0])));
    field.c[1] = sum(du, by_x, sum(dw, by_y, hn::Mul(dq, by_z)));
    field.c[2] =
        sum(hn::Mul(du, dw), by_xy, sum(hn::Mul(du, dq), by_xz, hn::Mul(hn::Mul(dw, dq), by_yz)));
    field.c[3] = hn::Mul(hn::Mul(du, dw), hn::Mul(dq, xyz));
    return field;
}

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline void make_segments_of(CellBatch& cells, const Chord& chord, const IntervalColumns& intervals,
                             SegmentBatch& segments) {
    using namespace reference;
    const Lanes d;
    const VisibleRanges visible(intervals);
    segments.count = 0;
    for (std::size_t i = 0; i < cells.count; i += hn::Lanes(d)) {
        const CornerLanes corners(cells, i);
        const Doubles lo = corners.least(), hi = corners.most();
        const Mask seen = hn::And(hn::And(visible.meet(lo, hi), corners.finite()),
                                  hn::FirstN(d, cells.count - i));
        if (hn::AllFalse(d, seen)) continue;
        const PathLanes path(cells, chord, i);
        const Cubics field = field_along(corners, path);
        const KeptLanes kept(seen);
        const std::size_t first = segments.count;
        for (std::size_t power = 0; power < 4; ++power)
            kept.store(field.c[power], segments.scalar[power] + first);
        kept.store(lo, segments.lo + first);
        kept.store(hi, segments.hi + first);
        kept.store(hn::Mul(path.along, number(chord.world_per_z)), segments.length + first);
        kept.store(hn::Iota(NumberLanes(), static_cast<std::int64_t>(i)), cells.seen + first);
        segments.count += kept.count();
    }
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(make_segments_of);

void make_segments(CellBatch& cells, const Chord& chord, const IntervalColumns& intervals,
                   SegmentBatch& segments) {
    HWY_DYNAMIC_DISPATCH(make_segments_of)(cells, chord, intervals, segments);
}

}  // namespace lamina
#endif
