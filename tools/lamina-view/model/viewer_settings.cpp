// SPDX-License-Identifier: Apache-2.0
#include "model/viewer_settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/geometric.hpp>
#include <string_view>
#include <system_error>

#include "lamina/error.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

// Returns a box for data of unknown bounds: half of the view around the camera's centre.
Grid::Bounds around_center(const Camera& camera) {
    const double reach = glm::distance(camera.eye, camera.center) / 4;
    return {camera.center - reach, camera.center + reach};
}

// Returns a plane that cuts away the half of the data nearest to the eye.
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

namespace fs = std::filesystem;

}  // namespace

bool may_be_absent(const SettingNode& node) {
    constexpr std::array<std::string_view, 9> paths{"lighting",
                                                    "image.annotations",
                                                    "clip.box",
                                                    "mesh",
                                                    "render.slice.dither",
                                                    "render.slice.tree",
                                                    "render.slice.table",
                                                    "render.project.table",
                                                    "render.project.tree"};
    return (node.kind == SettingKind::group || node.kind == SettingKind::either) &&
           (std::ranges::find(paths, node.path) != paths.end() ||
            (node.path.starts_with("image.annotations.") && !node.path.ends_with("[]")));
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
    if (node.path == "image.annotations") return {{"colorbar", true}};
    if (node.path == "image.annotations.title" || node.path == "image.annotations.texts[]")
        return {{"text", "Text"}};
    if (node.kind == SettingKind::group && node.path.starts_with("image.annotations."))
        return Json::object();
    if (node.path == "volume") return {{"generate", "gaussians"}};
    if (!node.otherwise.is_null() && node.otherwise != node.automatic_word) return node.otherwise;
    return of_kind(node);
}

void ViewerSettings::add_recent(const fs::path& path) {
    constexpr std::size_t most = 10;
    const fs::path whole = fs::absolute(path).lexically_normal();
    std::erase(recent, whole);
    recent.insert(recent.begin(), whole);
    if (recent.size() > most) recent.resize(most);
}

// The XDG specification says that a relative path in the variable must be ignored.
fs::path ViewerSettings::file() {
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    if (config != nullptr && fs::path(config).is_absolute())
        return fs::path(config) / "lamina" / "viewer.json";
    const char* const home = std::getenv("HOME");
    if (home == nullptr || *home == '\0') return {};
    return fs::path(home) / ".config" / "lamina" / "viewer.json";
}

ViewerSettings ViewerSettings::load(const fs::path& file) {
    ViewerSettings settings;
    std::ifstream stream(file);
    if (!stream) return settings;
    try {
        const nlohmann::json document = nlohmann::json::parse(stream);
        for (const std::string& path : document.value("recent", std::vector<std::string>()))
            settings.recent.emplace_back(path);
        settings.coarse = document.value("coarse", settings.coarse);
        settings.trace = document.value("trace", settings.trace);
        settings.panels = document.value("panels", settings.panels);
    } catch (const nlohmann::json::exception& error) {
        throw Error(fmt::format("{}: not the viewer's settings: {}", file.string(), error.what()));
    }
    return settings;
}

void ViewerSettings::save(const fs::path& file) const {
    std::vector<std::string> names;
    for (const fs::path& path : recent) names.push_back(path.string());
    const nlohmann::json document = {
        {"recent", names}, {"coarse", coarse}, {"trace", trace}, {"panels", panels}};
    const fs::path part = fmt::format("{}.{}.part", file.string(), getpid());
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    bool written = false;
    {
        std::ofstream stream(part);
        stream << document.dump(2) << '\n';
        written = static_cast<bool>(stream.flush());
    }
    if (written) fs::rename(part, file, failed);
    if (written && !failed) return;
    std::error_code ignored;
    fs::remove(part, ignored);
    throw Error(fmt::format("{}: cannot write the settings", file.string()));
}

}  // namespace lamina::view
