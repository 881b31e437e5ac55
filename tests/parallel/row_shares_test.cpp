// SPDX-License-Identifier: Apache-2.0
#include "parallel/fragment_code.h"

#include <gtest/gtest.h>

namespace lamina {
namespace {

TEST(RowShares, HoldAboutTheSameWeight) {
    const std::vector<std::int64_t> weights{0, 0, 4, 4, 4, 4, 8, 0, 0};
    const std::vector<RowSpan> expected{{0, 4}, {4, 6}, {6, 9}};
    EXPECT_EQ(divide_rows(weights, {0, 9}, 3), expected);
}

TEST(RowShares, CoverAllRowsOnce) {
    for (const int count : {1, 2, 7, 40}) {
        for (const std::int64_t weight : {0, 1, 1000}) {
            const std::vector<std::int64_t> weights(13, weight);
            int row = 2;
            const auto spans = divide_rows(weights, {2, 11}, count);
            ASSERT_EQ(spans.size(), static_cast<std::size_t>(count));
            for (const RowSpan& span : spans) {
                EXPECT_EQ(span.first, row);
                EXPECT_GE(span.end, span.first);
                row = span.end;
            }
            EXPECT_EQ(row, 11);
        }
    }
}

}  // namespace
}  // namespace lamina
