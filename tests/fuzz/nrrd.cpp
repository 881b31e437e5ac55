// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nrrd.h"

#include <algorithm>
#include <cctype>

#include "input_parts.h"
#include "plan_check.h"
#include "runs.h"
#include "scratch_folder.h"
#include "violation.h"
#include "volume/min_max_bricks.h"

namespace lamina::fuzz {
namespace {

constexpr std::int64_t most_planned = 4096;

// Whether no line that may be the field `data file` names a path.
bool data_file_stays_in_folder(std::string_view header) {
    std::string lower(header);
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char* const field : {"data file", "datafile"}) {
        for (std::size_t at = lower.find(field); at != lower.npos; at = lower.find(field, at + 1)) {
            const std::size_t end = std::min(lower.find('\n', at), lower.size());
            if (!stays_in_folder(std::string_view(lower).substr(at, end - at))) return false;
        }
    }
    return true;
}

void check_volume(const Volume& volume) {
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

void run_nrrd(std::string_view input) {
    const InputParts parts = parts_of(input);
    if (!data_file_stays_in_folder(parts.first)) return;
    const auto file = scratch_file("volume.nrrd", parts.first);
    scratch_file("data", parts.second);
    may_fail([&] { check_volume(read_nrrd(file)); });
}

}  // namespace lamina::fuzz
