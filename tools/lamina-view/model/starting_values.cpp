// SPDX-License-Identifier: Apache-2.0
#include "model/starting_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>

#include "model/scene_edit.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

// A size for data of unknown bounds: half of the camera's view around its centre.
Grid::Bounds around_center(const Camera& camera) {
    const double reach = glm::distance(camera.eye, camera.center) / 4;
    return {camera.center - reach, camera.center + reach};
}

// Cuts the half in front of the data away.
Json first_plane(const Camera& camera, const Grid::Bounds& box) {
    return {{"point", json_of((box.min + box.max) / 2.0)},
            {"normal", json_of(glm::normalize(camera.center - camera.eye))}};
}

Json least_number(const SettingNode& node) {
    if (std::isfinite(node.least)) return node.least_excluded ? node.least + 1 : node.least;
    return 0;
}

Json of_kind(const SettingNode& node) {
    switch (node.kind) {
        case SettingKind::fixed:
        case SettingKind::choice:
            return node.words.front();
        case SettingKind::flag:
            return false;
        case SettingKind::whole:
        case SettingKind::number:
            return least_number(node);
        case SettingKind::text:
            return "";
        case SettingKind::factors:
            return {32, 32};
        case SettingKind::vector:
            return {0, 0, 1};
        case SettingKind::color:
            return {1, 1, 1};
        case SettingKind::list:
            return Json::array();
        case SettingKind::group:
        case SettingKind::either:
            return Json::object();
    }
    return {};
}

}  // namespace

bool may_be_absent(const SettingNode& node) {
    constexpr std::array<std::string_view, 8> paths{"lighting",
                                                    "clip.box",
                                                    "mesh",
                                                    "render.slice.dither",
                                                    "render.slice.tree",
                                                    "render.slice.table",
                                                    "render.project.table",
                                                    "render.project.tree"};
    return (node.kind == SettingKind::group || node.kind == SettingKind::either) &&
           std::ranges::find(paths, node.path) != paths.end();
}

Json starting_value(const SettingNode& node, const std::string& path, const Scene& scene,
                    const Scene* resolved, const std::optional<Grid::Bounds>& bounds) {
    const Camera camera = scene.camera.value_or(resolved != nullptr ? *resolved->camera : Camera{});
    const Grid::Bounds box = bounds.value_or(around_center(camera));
    if (resolved != nullptr) {
        const Json chosen = setting_at(settings_of(*resolved), path);
        if (!chosen.is_null() && chosen != node.automatic_word) return chosen;
    }
    if (node.path == "clip.planes[]") return first_plane(camera, box);
    if (node.path == "clip.box") return {{"min", json_of(box.min)}, {"max", json_of(box.max)}};
    if (node.path == "lighting.lights[]") return Json::object();
    if (node.path == "render.slice.tree") return {{"factors", {32, 32}}};
    if (node.path == "render.project.tree") return {{"factors", {32}}, {"nodes", "fixed"}};
    if (node.path == "volume") return {{"generate", "gaussians"}};
    if (!node.otherwise.is_null() && node.otherwise != node.automatic_word) return node.otherwise;
    return of_kind(node);
}

}  // namespace lamina::view
