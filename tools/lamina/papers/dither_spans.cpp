// SPDX-License-Identifier: Apache-2.0
#include "papers/dither_spans.h"

#include <algorithm>
#include <cmath>

namespace lamina::papers {

SpanLoss span_loss(const SpanSetting& setting) {
    const int period = setting.dither.period;
    const std::vector<std::uint32_t> ranks = dither_ranks(period, setting.dither.seed);
    SpanLoss loss;
    int shown = 0;
    for (int place = 0; place < period; ++place) {
        std::uint32_t sum = 0;
        int first = -1;
        for (int i = 0; i < setting.slabs; ++i) {
            const std::uint32_t rank = ranks[static_cast<std::size_t>((place + i) % period)];
            const std::uint32_t code =
                dither_code(setting.code, rank, period, setting.dither.increment, largest_code(8));
            if (code > 0 && first < 0) first = i;
            sum += code;
        }
        const double error = sum - setting.slabs * setting.code;
        loss.sum_error += error * error / period;
        if (first < 0) continue;
        ++shown;
        loss.mean_shift += first;
        loss.largest_shift = std::max(loss.largest_shift, first);
    }
    loss.sum_error = std::sqrt(loss.sum_error);
    loss.lost = static_cast<double>(period - shown) / period;
    if (shown > 0) loss.mean_shift /= shown;
    return loss;
}

}  // namespace lamina::papers
