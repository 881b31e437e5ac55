// SPDX-License-Identifier: Apache-2.0
#include "facts/finite_check.h"

#include "base/error.h"

namespace lamina {

void check_finite(const Scene& scene, const Grid& grid, const MinMaxBricks& bricks) {
    const VolumeFile* const file = scene.volume_file();
    const std::string name = file == nullptr ? "volume" : file->path.string();
    const std::int64_t samples = grid.sample_count();
    if (bricks.non_finite == samples) fail("{}: all {} samples are NaN or infinite", name, samples);
    if (bricks.non_finite > 0 && scene.nan == NanPolicy::error) {
        fail(
            "{}: found {} NaN or infinite samples of {}, expected none; \"nan\": \"transparent\" "
            "in the scene draws their cells as transparent",
            name, bricks.non_finite, samples);
    }
}

void check_finite(const Scene& scene, const SceneMesh& mesh, const ScalarRange& found) {
    const std::string name = name_of_mesh(scene);
    if (found.range.empty()) {
        fail("{}: all {} values of \"{}\" are NaN or infinite", name, mesh.mesh.points().size(),
             mesh.scalar.name);
    }
    if (found.non_finite > 0 && scene.nan == NanPolicy::error) {
        fail(
            "{}: found {} NaN or infinite values of \"{}\", expected none; \"nan\": "
            "\"transparent\" in the scene draws their tets as transparent",
            name, found.non_finite, mesh.scalar.name);
    }
}

}  // namespace lamina
