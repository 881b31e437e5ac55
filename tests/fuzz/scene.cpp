// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"
#include "scene/given_transfer.h"
#include "scene_files/scene_reader.h"

#include "input_parts.h"
#include "json_paths.h"
#include "runs.h"
#include "scene_files/keys.h"
#include "violation.h"

namespace lamina::fuzz {

// Reads a scene, writes and reads it again, and makes the first and the last ray of the top row.
// The second part of the input is the colour map that the scene may name, map.json.
void run_scene(std::string_view input) {
    const InputParts parts = parts_of(input);
    const auto file = scratch_file("scene.json", parts.first);
    scratch_file("map.json", parts.second);
    may_fail([&] {
        const nlohmann::json document = load_json(file);
        if (!paths_stay_in_folder(document)) return;
        Scene scene = read_scene(document, file);
        read_scene(scene_json(scene), file);
        if (has_open_colormap(scene)) close_colormap(scene, {0, 255});
        const View view(*scene.camera, scene.width, scene.height);
        for (const double column : {0.0, scene.width - 1.0}) {
            const View::Ray ray = view.ray(column, 0);
            for (int axis = 0; axis < 3; ++axis) {
                require_finite(ray.origin[axis], "where a ray starts");
                require_finite(ray.direction[axis], "where a ray leads");
            }
        }
    });
}

}  // namespace lamina::fuzz
