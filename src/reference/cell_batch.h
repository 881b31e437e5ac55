// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "reference/chord.h"
#include "reference/segment_batch.h"
#include "reference/trilinear.h"

namespace lamina {

// Consecutive cells of a chord, front to back.
struct CellBatch {
    static constexpr std::size_t capacity = SegmentBatch::capacity;

    alignas(64) double corners[8][capacity];  // CellCorners, corner by corner
    alignas(64) double lo[capacity];          // their range
    alignas(64) double hi[capacity];
    alignas(64) double place[3][capacity];  // of corner 0, in index space
    alignas(64) double from[capacity];      // parameters of the chord
    alignas(64) double to[capacity];
    std::size_t count = 0;

    void add(const CellCorners& values, const CellCorners::Range& range, const CellIndex& cell,
             double begin, double end) {
        for (std::size_t corner = 0; corner < 8; ++corner)
            corners[corner][count] = values.v[corner];
        lo[count] = range.lo;
        hi[count] = range.hi;
        for (std::size_t axis = 0; axis < 3; ++axis)
            place[axis][count] = static_cast<double>(cell[axis]);
        from[count] = begin;
        to[count] = end;
        ++count;
    }
};

// Sets the segments to the chord's inside the cells, of the trilinear field. In vectors:
// CellCorners::along() does one.
void make_segments(const CellBatch& cells, const Chord& chord, SegmentBatch& segments);

}  // namespace lamina
