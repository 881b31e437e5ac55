// SPDX-License-Identifier: Apache-2.0
// The effect of dithering along depth on a structure that fills only some of a ray's slabs (LaMar
// 2004, section 5.2).
#pragma once

#include "compositing/dither.h"

namespace lamina::papers {

struct SpanSetting {
    double code = 0.1;  // opacity of its samples in codes of 8 bits, 0 < code < 1
    int slabs = 9;      // number of slabs that it fills, >= 1
    Dither dither;
};

// Statistics over all positions of the structure relative to the pattern.
struct SpanLoss {
    double lost = 0;  // share of positions at which nothing of it shows
    // Mean number of slabs from its boundary to the first slab that shows, where one does.
    double mean_shift = 0;
    int largest_shift = 0;
    double sum_error = 0;  // RMS difference between the sum of its codes and slabs * code, in codes
};

SpanLoss span_loss(const SpanSetting& setting);

}  // namespace lamina::papers
