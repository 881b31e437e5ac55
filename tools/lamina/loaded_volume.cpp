// SPDX-License-Identifier: Apache-2.0
#include "loaded_volume.h"

#include <fmt/format.h>

#include "base/stopwatch.h"
#include "slicing/slab_trials.h"

namespace lamina {
namespace {

Volume timed_load(const Scene& scene, RenderStats& stats) {
    const Stopwatch watch;
    Volume volume = load_volume(scene);
    stats.stages_ms["load"] = watch.milliseconds();
    return volume;
}

}  // namespace

LoadedVolume::LoadedVolume(const RenderRequest& request, RenderStats& stats)
    : volume(timed_load(request.scene, stats)) {
    const Stopwatch watch;
    facts = measure_slicing(request.scene, volume, measure_bricks(volume));
    stats.stages_ms["measure"] = watch.milliseconds();
    stats.counts["non_finite_samples"] = facts.non_finite;
    if (facts.non_finite > 0) {
        request.message(fmt::format(
            "{} samples are NaN or infinite: their cells are drawn transparent", facts.non_finite));
    }
}

}  // namespace lamina
