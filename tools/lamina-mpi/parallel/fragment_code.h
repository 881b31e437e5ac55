// SPDX-License-Identifier: Apache-2.0
// Encodes pictures for transfers between ranks. Pixels that show nothing are not sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lamina/image.h"

namespace lamina {

// Formats of pixels between ranks; --wire chooses one.
enum class Wire {
    float32,  // 16 bytes a pixel, no loss
    half,     // 8 bytes: four halves, associated
    coded,    // 5 bytes in the first transfer, 8 in later ones: docs/cluster.md
};

const char* name_of(Wire wire);
Wire wire_of(const std::string& word);  // throws UsageError for another word

struct RowSpan {
    int first = 0, end = 0;

    friend bool operator==(const RowSpan&, const RowSpan&) = default;
};

// Divides `rows` into `count` consecutive spans of about equal weight. `weights` has the weight of
// each row of the picture, 0 or more.
std::vector<RowSpan> divide_rows(const std::vector<std::int64_t>& weights, const RowSpan& rows,
                                 int count);

// Runs of neighbouring pixels that show something (are not all 0), in some rows of a picture.
class ActiveRuns {
  public:
    struct Run {
        int first, end;  // columns
    };

    ActiveRuns(const Image& picture, const RowSpan& rows);

    // Return the bounds of a row's runs, which are in order from left to right.
    const Run* begin(int row) const { return runs_.data() + starts_[place(row)]; }
    const Run* end(int row) const { return runs_.data() + starts_[place(row) + 1]; }

    std::int64_t pixels(int row) const;  // number of pixels in the row's runs

  private:
    std::size_t place(int row) const { return static_cast<std::size_t>(row - first_row_); }

    int first_row_;
    std::vector<Run> runs_;
    std::vector<std::size_t> starts_;  // index of each row's first run; at the end, runs_.size()
};

enum class FragmentFormat {
    float32,  // associated RGBA, 16 bytes
    half,     // associated RGBA rounded to half, 8 bytes
    fixed16,  // associated RGBA as codes of 16 bits, 8 bytes
    // Colour, not associated, as codes of 8 bits, and opacity as a code of 16 bits: 5 bytes. In a
    // composited pixel the weights of these colours add up to at most 1. So their rounding changes
    // the pixel by at most half a code of 8 bits, however many ranks contribute to it.
    fixed8,
};

// Encodes rows as bytes: first, as a float, the largest colour, to which colour codes refer; then
// for each row its runs and a 0. A run is encoded as its length, the number of hidden pixels before
// it, and its pixels. `runs` must contain the runs of these rows.
void encode_rows(const Image& picture, const ActiveRuns& runs, const RowSpan& rows,
                 FragmentFormat format, std::vector<std::byte>& bytes);

// Composite rows, encoded or from a picture, behind the same rows of `front`.
void put_rows_behind(const std::vector<std::byte>& bytes, const RowSpan& rows,
                     FragmentFormat format, Image& front);
void put_rows_behind(const Image& picture, const ActiveRuns& runs, const RowSpan& rows,
                     Image& front);

}  // namespace lamina
