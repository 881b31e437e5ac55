// SPDX-License-Identifier: Apache-2.0
#include "volume_check.h"

#include "plan_check.h"
#include "violation.h"
#include "volume/min_max_bricks.h"

namespace lamina::fuzz {
namespace {

// Largest number of samples of a volume that is planned.
constexpr std::int64_t most_planned = 4096;

void check_opened(const Volume& volume) {
    const MinMaxBricks bricks = measure_bricks(volume);
    const Grid::Bounds bounds = volume.grid().bounds();
    for (int axis = 0; axis < 3; ++axis) {
        require_finite(bounds.min[axis], "the box's least corner");
        require_finite(bounds.max[axis], "the box's largest corner");
    }
    if (bricks.whole.empty() || volume.grid().sample_count() > most_planned) return;
    Scene scene =
        scene_around({bounds.min, bounds.max}, bricks.whole.lo, bricks.whole.hi, Method::slice);
    scene.nan = NanPolicy::transparent;
    check_slice_plans(scene, volume);
}

}  // namespace

void check_volume(const std::function<Volume(const VolumeUse& use)>& open) {
    VolumeContents contents;
    VolumeUse use;
    use.contents = &contents;
    may_fail([&] { check_opened(open(use)); });
}

}  // namespace lamina::fuzz
