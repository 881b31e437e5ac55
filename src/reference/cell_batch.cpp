// SPDX-License-Identifier: Apache-2.0
#include "reference/cell_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/cell_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/cubic_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// Returns a x + b.
HWY_INLINE Doubles sum(Doubles a, Doubles x, Doubles b) {
    return hn::MulAdd(a, x, b);
}

HWY_INLINE void make_lanes(const CellBatch& cells, const Chord& chord, std::size_t i,
                           SegmentBatch& segments) {
    const Lanes d;
    const Doubles from = hn::Load(d, cells.from + i);
    const Doubles along = hn::Sub(hn::Load(d, cells.to + i), from);
    Doubles start[3], step[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Doubles direction = number(chord.direction[axis]);
        const Doubles at = hn::MulAdd(from, direction, number(chord.entry[axis]));
        const Doubles inside = hn::Sub(at, hn::Load(d, cells.place[axis] + i));
        start[axis] = hn::Min(hn::Max(inside, hn::Zero(d)), number(1));
        step[axis] = hn::Mul(along, direction);
    }
    Doubles v[8];
    for (std::size_t corner = 0; corner < 8; ++corner)
        v[corner] = hn::Load(d, cells.corners[corner] + i);
    const Doubles x = hn::Sub(v[1], v[0]), y = hn::Sub(v[2], v[0]), z = hn::Sub(v[4], v[0]);
    const Doubles xy = hn::Sub(hn::Sub(v[3], v[2]), x), xz = hn::Sub(hn::Sub(v[5], v[4]), x);
    const Doubles yz = hn::Sub(hn::Sub(v[6], v[4]), y);
    const Doubles xyz = hn::Sub(hn::Sub(hn::Sub(v[7], v[6]), hn::Sub(v[5], v[4])), xy);
    const auto& [u, w, q] = start;
    const auto& [du, dw, dq] = step;
    // The field's derivatives at the start, by each axis and by pairs of them.
    const Doubles by_xy = sum(q, xyz, xy), by_xz = sum(w, xyz, xz), by_yz = sum(u, xyz, yz);
    const Doubles by_x = sum(w, by_xy, sum(q, xz, x)), by_y = sum(u, by_xy, sum(q, yz, y));
    const Doubles by_z = sum(u, by_xz, sum(w, yz, z));
    const Doubles c0 = sum(u, by_x, sum(w, sum(q, yz, y), sum(q, z, v[0])));
    const Doubles c1 = sum(du, by_x, sum(dw, by_y, hn::Mul(dq, by_z)));
    const Doubles c2 =
        sum(hn::Mul(du, dw), by_xy, sum(hn::Mul(du, dq), by_xz, hn::Mul(hn::Mul(dw, dq), by_yz)));
    hn::Store(c0, d, segments.scalar[0] + i);
    hn::Store(c1, d, segments.scalar[1] + i);
    hn::Store(c2, d, segments.scalar[2] + i);
    hn::Store(hn::Mul(hn::Mul(du, dw), hn::Mul(dq, xyz)), d, segments.scalar[3] + i);
    hn::Store(hn::Load(d, cells.lo + i), d, segments.lo + i);
    hn::Store(hn::Load(d, cells.hi + i), d, segments.hi + i);
    hn::Store(hn::Mul(along, number(chord.world_per_z)), d, segments.length + i);
}

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline void make_segments_of(const CellBatch& cells, const Chord& chord, SegmentBatch& segments) {
    using namespace reference;
    for (std::size_t i = 0; i < cells.count; i += hn::Lanes(Lanes()))
        make_lanes(cells, chord, i, segments);
    segments.count = cells.count;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(make_segments_of);

void make_segments(const CellBatch& cells, const Chord& chord, SegmentBatch& segments) {
    HWY_DYNAMIC_DISPATCH(make_segments_of)(cells, chord, segments);
}

}  // namespace lamina
#endif
