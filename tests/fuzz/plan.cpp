// SPDX-License-Identifier: Apache-2.0
#include "plan/plan.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "json_paths.h"
#include "plan_check.h"
#include "runs.h"
#include "scene/given_transfer.h"
#include "scene/scene.h"
#include "scene_files/keys.h"
#include "scene_files/scene_reader.h"
#include "violation.h"
#include "volume/min_max_bricks.h"

namespace lamina::fuzz {
namespace {

// Largest size of a volume along an axis, and largest number of tets.
constexpr std::int64_t longest_axis = 12;
constexpr std::int64_t most_tets = 600;
// Largest size of a table: one as large as scenes may ask for takes seconds to fill.
constexpr int most_nodes = 32, most_layers = 4;

// Makes the data and tables that a scene asks for small, because only the plan is tested.
void shrink(Scene& scene) {
    const auto* const asked = std::get_if<GeneratorRequest>(&scene.volume);
    GeneratorRequest volume = asked != nullptr ? *asked : GeneratorRequest{"gaussians", {}, {}};
    if (!volume.size) volume.size = {9, 7, 5};
    for (std::int64_t& edge : *volume.size) edge = std::min(edge, longest_axis);
    scene.volume = volume;
    if (scene.has_mesh()) {
        MeshSettings mesh = mesh_settings(scene);
        mesh.kuhn = true;
        mesh.max_tets = most_tets;
        scene.mesh = mesh;
    }
    if (auto& table = scene.project.table; table.is_given()) {
        table->scalar = std::min(table->scalar, most_nodes);
        table->length = std::min(table->length, most_layers);
    }
}

}  // namespace

void run_plan(std::string_view input) {
    const auto file = scratch_file("scene.json", input);
    may_fail([&] {
        const nlohmann::json document = load_json(file);
        if (!paths_stay_in_folder(document)) return;
        Scene scene = read_scene(document, file);
        shrink(scene);
        if (has_open_colormap(scene))
            close_colormap(scene, measure_bricks(load_volume(scene)).whole);
        if (scene.draws_mesh())
            check_project_plans(scene, load_mesh(scene));
        else
            check_slice_plans(scene, load_volume(scene));
    });
}

}  // namespace lamina::fuzz
