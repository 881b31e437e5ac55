// SPDX-License-Identifier: Apache-2.0
#include "scene_files/data_range.h"

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/json_text.h"
#include "mesh/scalar_range.h"
#include "scene/scene_mesh.h"
#include "scene/scene_volume.h"
#include "scene_files/volume_selection_json.h"
#include "volume/volume_data.h"

namespace lamina {
namespace {

ValueRange measured(const Scene& scene) {
    if (scene.has_volume()) return VolumeData(open_volume(scene)).bricks.whole;
    return measure_range(load_mesh(scene).scalar.values).range;
}

// Identifies without reading them the values that a scene draws of a file. None: it cannot be told.
std::optional<std::string> identity(const Scene& scene) {
    if (scene.volume_request) return std::nullopt;
    const std::filesystem::path& file = scene.has_volume() ? scene.volume_file : scene.mesh_file;
    std::error_code unknown;
    const auto bytes = std::filesystem::file_size(file, unknown);
    if (unknown) return std::nullopt;
    const auto time = std::filesystem::last_write_time(file, unknown);
    if (unknown) return std::nullopt;
    // Beside the name, which JSON has in UTF-8 alone.
    const std::string part = json_text(volume_selection_json("", scene.volume_selection));
    return fmt::format("{} {} {} {} {} {}", file.string(), part, scene.mesh_time, scene.scalar,
                       bytes, time.time_since_epoch().count());
}

}  // namespace

// A study reads a scene for each of its runs.
ValueRange data_range(const Scene& scene) {
    static std::mutex access;
    static std::map<std::string, ValueRange> known;
    const std::optional<std::string> name = identity(scene);
    if (!name) return measured(scene);
    const std::lock_guard lock(access);
    const auto found = known.find(*name);
    return found != known.end() ? found->second : known[*name] = measured(scene);
}

}  // namespace lamina
