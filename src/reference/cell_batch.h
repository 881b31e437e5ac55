// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "reference/cell_index.h"
#include "reference/chord.h"
#include "reference/interval_columns.h"
#include "reference/segment_batch.h"

namespace lamina {

// Consecutive cells of a chord, front to back.
struct CellBatch {
    static constexpr std::size_t capacity = SegmentBatch::capacity;

    alignas(64) std::int64_t cell[3][capacity];
    alignas(64) double from[capacity];  // parameters of the chord
    alignas(64) double to[capacity];
    std::size_t count = 0;
    std::size_t wanted = capacity;  // the batch is complete with so many cells

    alignas(64) double corners[8][capacity];  // CellSamples::fetch(): samples, at index x + 2y + 4z
    // make_segments(): each segment's cell in this batch.
    alignas(64) std::int64_t seen[capacity];

    bool complete() const { return count >= wanted; }
    void add(const CellIndex& index, double begin, double end) {
        for (std::size_t axis = 0; axis < 3; ++axis) cell[axis][count] = index[axis];
        from[count] = begin;
        to[count] = end;
        ++count;
    }
};

// Sets the segments to the chord's inside those cells that may show something, of the trilinear
// field. Cells with a NaN or infinite corner are transparent. In vectors: CellCorners::along() does
// one.
void make_segments(CellBatch& cells, const Chord& chord, const IntervalColumns& intervals,
                   SegmentBatch& segments);

}  // namespace lamina
