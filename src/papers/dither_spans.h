// SPDX-License-Identifier: Apache-2.0
// What dithering along depth does to a structure that fills only some of a ray's slabs (LaMar 2004,
// section 5.2).
#pragma once

#include "compositing/dither.h"

namespace lamina::papers {

struct SpanSetting {
    double code = 0.1;  // opacity of its samples in codes of 8 bits, 0 < code < 1
    int slabs = 9;      // that it fills, >= 1
    Dither dither;
};

// Over all places that the structure can have against the pattern.
struct SpanLoss {
    double lost = 0;        // share of the places where nothing of it shows
    double mean_shift = 0;  // slabs from its boundary to the first that shows, where one does
    int largest_shift = 0;
    double sum_error = 0;  // RMS of the sum of its codes against slabs * code, in codes
};

SpanLoss span_loss(const SpanSetting& setting);

}  // namespace lamina::papers
