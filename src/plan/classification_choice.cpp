// SPDX-License-Identifier: Apache-2.0
#include "plan/classification_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "plan/light_choice.h"
#include "plan/march_limit.h"

namespace lamina {
namespace {

// Returns the number of slabs of exact segments: the scene's own, that of a tree, or `least`, which
// the context's loops need.
int slabs_of(const Scene& scene, int least) {
    const SliceSettings& slice = scene.slice;
    if (slice.samples.is_given()) return *slice.samples;
    const TreeSettings* const tree = given_tree(slice.tree);
    if (tree == nullptr) return least;
    std::int64_t leaves = 1;
    for (const int factor : tree->factors)
        leaves = std::min<std::int64_t>(leaves * factor, max_slabs);
    return static_cast<int>(leaves);
}

void check_exact(const Scene& scene, const Facts& facts, int least,
                 const Capabilities& capabilities) {
    if (scene.slice.filter == Filter::hardware) {
        fail(
            "{}: render.slice.filter: found \"hardware\", expected \"exact\" with classification "
            "\"exact\"",
            scene.file.string());
    }
    const double least_error = least_lit_error(scene, facts, capabilities);
    if (scene.max_error < least_error) {
        fail(
            "{}: render.max_error: found {}, expected at least {:.2g} with lighting and {}, which "
            "ends the loops of rays that are cut where light bends; or use --context cpu",
            scene.file.string(), scene.max_error, least_error, capabilities.renderer);
    }
    if (slabs_of(scene, least) < least) {
        fail(
            "{}: render.slice.samples: found {} with classification \"exact\", expected at least "
            "{} with {}, which ends the loops of longer segments; or use --context cpu",
            scene.file.string(), slabs_of(scene, least), least, capabilities.renderer);
    }
}

}  // namespace

ClassificationChoice choose_classification(const Scene& scene, const Facts& facts,
                                           const Capabilities& capabilities,
                                           const SampleTrials& trials) {
    check_lit_slicing(scene);
    const Auto<Classification>& asked = scene.slice.classification;
    if (asked.is_given() && asked != Classification::exact) return {*asked, 1, {}};
    const int least = least_exact_slabs(scene, facts, capabilities);
    if (asked == Classification::exact || scene.lighting) {
        check_exact(scene, facts, least, capabilities);
        return {Classification::exact, least,
                asked == Classification::exact ? "" : "light needs the gradient in every cell"};
    }
    if (scene.slice.filter == Filter::hardware)
        return {Classification::post, 1, "exact segments have no use for the hardware's filter"};
    // If neither samples nor a tree are asked for, segments get as short as they must be. A
    // tree's leaves may be longer than a slab.
    if (slabs_of(scene, least) < least || (scene.slice.tree && least > 1)) {
        return {Classification::post, 1,
                fmt::format("rays may cross so many cells and points of the transfer function that "
                            "exact segments need {} slabs in this context",
                            least)};
    }
    const auto quicker = std::ranges::find_if(trials.exact, &SlabTrial::keeps_goal);
    if (may_be_quicker(scene) && quicker != trials.exact.end()) {
        return {Classification::post, 1,
                fmt::format("of many frames each is quicker: {} slabs, less than {:.2g} a voxel, "
                            "keep the error",
                            quicker->slabs, quicker_slabs_per_voxel)};
    }
    return {Classification::exact, least,
            "a ray is integrated cell by cell: no number of slabs has to be tried"};
}

bool may_be_quicker(const Scene& scene) {
    return !scene.lighting && scene.slice.classification.is_automatic() &&
           scene.slice.samples.is_automatic() && !scene.slice.tree && !scene.slice.dither &&
           scene.target == Target::float32;
}

Scene with_classification(Scene scene, const ClassificationChoice& choice) {
    scene.slice.classification = choice.classification;
    if (choice.classification == Classification::exact)
        scene.slice.samples = slabs_of(scene, choice.slabs);
    return scene;
}

}  // namespace lamina
