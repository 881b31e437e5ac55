// SPDX-License-Identifier: Apache-2.0
#include "loaded_volume.h"

#include <fmt/format.h>

#include "base/stage.h"
#include "slicing/slab_trials.h"

namespace lamina {
namespace {

Volume timed_load(const Scene& scene, RenderStats& stats) {
    Stage loading("load");
    Volume volume = load_volume(scene);
    stats.stages_ms["load"] = loading.end();
    return volume;
}

}  // namespace

LoadedVolume::LoadedVolume(const RenderRequest& request, RenderStats& stats)
    : volume(timed_load(request.scene, stats)) {
    Stage measuring("measure");
    Stage measuring_bricks("bricks");
    const MinMaxBricks bricks = measure_bricks(volume);
    measuring_bricks.end();
    Stage finding("facts");
    facts = measure_slicing(request.scene, volume, bricks);
    finding.end();
    stats.stages_ms["measure"] = measuring.end();
    stats.counts["non_finite_samples"] = facts.non_finite;
    if (facts.non_finite > 0) {
        request.message(fmt::format(
            "{} samples are NaN or infinite: their cells are drawn transparent", facts.non_finite));
    }
}

}  // namespace lamina
