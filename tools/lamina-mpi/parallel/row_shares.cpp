// SPDX-License-Identifier: Apache-2.0
#include "parallel/row_shares.h"

namespace lamina {

std::vector<RowSpan> divide_rows(const std::vector<std::int64_t>& weights, const RowSpan& rows,
                                 int count) {
    std::int64_t all = 0;
    for (int row = rows.first; row < rows.end; ++row) all += weights[static_cast<std::size_t>(row)];
    std::vector<RowSpan> spans;
    std::int64_t sum = 0;
    int row = rows.first;
    for (int i = 0; i < count; ++i) {
        RowSpan span{row, row};
        // A row belongs to the span in which its middle lies.
        const auto ends_in = [&](std::int64_t weight) {
            return i + 1 == count || (2 * sum + weight) * count < 2 * all * (i + 1);
        };
        while (row < rows.end && ends_in(weights[static_cast<std::size_t>(row)]))
            sum += weights[static_cast<std::size_t>(row++)];
        span.end = row;
        spans.push_back(span);
    }
    return spans;
}

}  // namespace lamina
