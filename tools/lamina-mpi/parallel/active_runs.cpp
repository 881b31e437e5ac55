// SPDX-License-Identifier: Apache-2.0
#include "parallel/active_runs.h"

#include <cstring>

namespace lamina {
namespace {

// Whether a number of pixels show something: all their bits are looked at together.
template <int pixels>
bool any_shows(const float* row, int column) {
    std::uint64_t words[2 * pixels], any = 0;
    std::memcpy(words, row + 4 * static_cast<std::size_t>(column), sizeof words);
    for (const std::uint64_t word : words) any |= word;
    return any != 0;
}

int first_shown(const float* row, int column, int width) {
    while (column + 8 <= width && !any_shows<8>(row, column)) column += 8;
    while (column < width && !any_shows<1>(row, column)) ++column;
    return column;
}

int first_hidden(const float* row, int column, int width) {
    while (column < width && any_shows<1>(row, column)) ++column;
    return column;
}

}  // namespace

ActiveRuns::ActiveRuns(const Image& picture, const RowSpan& rows) : first_row_(rows.first) {
    starts_.push_back(0);
    for (int row = rows.first; row < rows.end; ++row) {
        const float* const pixels = picture.pixel(0, row);
        for (int end = 0;;) {
            const int first = first_shown(pixels, end, picture.width);
            if (first == picture.width) break;
            end = first_hidden(pixels, first, picture.width);
            runs_.push_back({first, end});
        }
        starts_.push_back(runs_.size());
    }
}

std::int64_t ActiveRuns::pixels(int row) const {
    std::int64_t sum = 0;
    for (const Run* run = begin(row); run != end(row); ++run) sum += run->end - run->first;
    return sum;
}

}  // namespace lamina
