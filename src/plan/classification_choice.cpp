// SPDX-License-Identifier: Apache-2.0
#include "plan/classification_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "plan/lit_check.h"

namespace lamina {
namespace {

void check_exact(const Scene& scene, const Capabilities& capabilities) {
    if (!capabilities.tiles) {
        fail(
            "{}: render.slice.classification: \"exact\" needs the native engine, expected "
            "--context cpu or another classification: {}",
            scene.file.string(), capabilities.renderer);
    }
    if (scene.slice.filter == Filter::hardware) {
        fail(
            "{}: render.slice.filter: found \"hardware\", expected \"exact\" with classification "
            "\"exact\"",
            scene.file.string());
    }
}

}  // namespace

ClassificationChoice choose_classification(const Scene& scene, const Capabilities& capabilities,
                                           const SampleTrials& trials) {
    check_lit_slicing(scene, capabilities);
    const Classification asked = scene.slice.classification;
    if (asked == Classification::exact) check_exact(scene, capabilities);
    if (asked != Classification::automatic) return {asked, {}};
    if (!capabilities.tiles)
        return {Classification::post, "exact segments need the native engine (--context cpu)"};
    if (scene.lighting) {
        check_exact(scene, capabilities);
        return {Classification::exact, "light needs the gradient in every cell"};
    }
    if (scene.slice.filter == Filter::hardware)
        return {Classification::post, "exact segments have no use for the hardware's filter"};
    const auto quicker = std::ranges::find_if(trials.exact, &SlabTrial::keeps_goal);
    if (may_be_quicker(scene) && quicker != trials.exact.end()) {
        return {Classification::post,
                fmt::format("of many frames each is quicker: {} slabs, less than {:.2g} a voxel, "
                            "keep the error",
                            quicker->slabs, quicker_slabs_per_voxel)};
    }
    return {Classification::exact,
            "a ray is integrated cell by cell: no number of slabs has to be tried"};
}

bool may_be_quicker(const Scene& scene) {
    return !scene.lighting && scene.slice.classification == Classification::automatic &&
           !scene.slice.samples && !scene.slice.tree && !scene.slice.dither &&
           scene.target == Target::float32 && !scene.automatic_target;
}

Scene with_classification(Scene scene, Classification classification) {
    SliceSettings& slice = scene.slice;
    slice.classification = classification;
    if (classification != Classification::exact || slice.samples) return scene;
    std::int64_t samples = 1;
    if (slice.tree && !slice.tree->automatic) {
        for (const int factor : slice.tree->factors)
            samples = std::min<std::int64_t>(samples * factor, max_slabs);
    }
    slice.samples = static_cast<int>(samples);
    return scene;
}

}  // namespace lamina
