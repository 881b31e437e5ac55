// SPDX-License-Identifier: Apache-2.0
#include "loaded_volume.h"

#include <fmt/format.h>

#include "base/stage.h"

namespace lamina {

std::shared_ptr<const VolumeData> load_volume_data(const RenderRequest& request,
                                                   RenderStats& stats) {
    Stage loading("load");
    Volume volume = load_volume(request.scene);
    stats.stages_ms["load"] = loading.end();
    Stage measuring("measure");
    Stage measuring_bricks("bricks");
    auto data = std::make_shared<const VolumeData>(std::move(volume));
    measuring_bricks.end();
    stats.stages_ms["measure"] = measuring.end();
    return data;
}

void report_volume(const RenderRequest& request, const VolumeData& data, RenderStats& stats) {
    const std::int64_t non_finite = data.bricks.non_finite;
    stats.counts["non_finite_samples"] = non_finite;
    if (non_finite > 0) {
        request.message(fmt::format(
            "{} samples are NaN or infinite: their cells are drawn transparent", non_finite));
    }
}

}  // namespace lamina
