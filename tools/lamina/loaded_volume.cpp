// SPDX-License-Identifier: Apache-2.0
#include "loaded_volume.h"

#include <fmt/format.h>

namespace lamina {

void report_volume(const RenderRequest& request, const VolumeData& data, RenderStats& stats) {
    const std::int64_t non_finite = data.bricks.non_finite;
    stats.counts["non_finite_samples"] = non_finite;
    if (non_finite > 0) {
        request.message(fmt::format(
            "{} samples are NaN or infinite: their cells are drawn transparent", non_finite));
    }
}

}  // namespace lamina
