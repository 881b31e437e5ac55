// SPDX-License-Identifier: Apache-2.0
// Pictures of ranks as bytes for other ranks: pixels that show nothing are not sent.
#pragma once

#include <cstddef>
#include <vector>

#include "lamina/image.h"
#include "parallel/active_runs.h"
#include "parallel/row_shares.h"

namespace lamina {

enum class FragmentFormat {
    float32,  // associated RGBA, 16 bytes
    half,     // associated RGBA rounded to half, 8 bytes
    fixed16,  // associated RGBA as codes of 16 bits, 8 bytes
    // RGB that is not associated as codes of 8 bits, opacity as one of 16: 5 bytes. Colours of
    // fragments enter a pixel with weights that sum to at most 1, so the pixel is off by at most
    // half a code of 8 bits, however many fragments there are.
    fixed8,
};

// The rows as bytes: the largest colour, of which codes are shares; then of each row the runs of
// pixels that show something, each as its length and the number of pixels that it leaves out before
// it, and its pixels. `runs`: of these rows or more.
void encode_rows(const Image& picture, const ActiveRuns& runs, const RowSpan& rows,
                 FragmentFormat format, std::vector<std::byte>& bytes);

// Composites rows behind what `front` has of them.
void put_rows_behind(const std::vector<std::byte>& bytes, const RowSpan& rows,
                     FragmentFormat format, Image& front);
void put_rows_behind(const Image& picture, const ActiveRuns& runs, const RowSpan& rows,
                     Image& front);

}  // namespace lamina
