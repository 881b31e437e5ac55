// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/linear_batch.h"
#include "reference/linear_round.h"
#include "reference/transfer_intervals.h"

namespace lamina {

// Parts of the segments of one batch, front to back, on which extinction and colour are linear,
// too.
struct LinearParts {
    using Column = std::vector<double>;

    std::vector<std::int64_t> segment, interval;  // numbers
    Column from, to;  // the places in the interval, 0 at its lower knot, 1 at its upper one
    Column p, q;      // extinction * length there
    Column depth;     // optical depth, >= 0
    Column before;    // and of what lies in front: set by the caller

    // The results of weigh_parts(): exp(-before), and the weights of the colours of the interval's
    // lower knot and of the change from there to the upper one (TransferIntervals::color()).
    Column transmittance, opacity, change;

    std::size_t count = 0;
    std::vector<LinearRound> rounds;  // memory of append_parts()

    // Makes sure that columns have room for so many parts, and a vector of doubles more.
    void make_room(std::size_t parts) {
        if (parts + longest_vector <= from.size()) return;
        const std::size_t room = std::max(2 * from.size(), parts + longest_vector);
        segment.resize(room);
        interval.resize(room);
        for (Column* column :
             {&from, &to, &p, &q, &depth, &before, &transmittance, &opacity, &change})
            column->resize(room);
    }
};

// Appends the parts that have extinction, with their depths.
void append_parts(const LinearBatch& segments, const IntervalColumns& intervals,
                  LinearParts& parts);
// Sets the results. The relative error of each weight is some 1e-13 (optics/segment_integral.h).
void weigh_parts(LinearParts& parts);

}  // namespace lamina
