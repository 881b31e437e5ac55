// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lamina/image.h"
#include "parallel/row_shares.h"

namespace lamina {

// The runs of pixels of some rows of a picture that show something.
class ActiveRuns {
  public:
    struct Run {
        int first, end;  // columns
    };

    ActiveRuns(const Image& picture, const RowSpan& rows);

    // The runs of one of the rows, from left to right.
    const Run* begin(int row) const { return runs_.data() + starts_[place(row)]; }
    const Run* end(int row) const { return runs_.data() + starts_[place(row) + 1]; }

    std::int64_t pixels(int row) const;

  private:
    std::size_t place(int row) const { return static_cast<std::size_t>(row - first_row_); }

    int first_row_;
    std::vector<Run> runs_;
    std::vector<std::size_t> starts_;  // of each row, and the end
};

}  // namespace lamina
