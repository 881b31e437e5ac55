// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace lamina {

struct RowSpan {
    int first = 0, end = 0;

    friend bool operator==(const RowSpan&, const RowSpan&) = default;
};

// Divides rows into `count` spans, one after the other, that hold about the same weight each.
// `weights`: of each row of the picture, 0 or more.
std::vector<RowSpan> divide_rows(const std::vector<std::int64_t>& weights, const RowSpan& rows,
                                 int count);

}  // namespace lamina
