// SPDX-License-Identifier: Apache-2.0
#include "lamina/scene_text.h"

#include <nlohmann/json.hpp>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "scene_files/scene_reader.h"

namespace lamina {
namespace {

nlohmann::json parsed(const std::string& json, const std::filesystem::path& name) {
    try {
        return parse_json(json);
    } catch (const Error& error) {
        fail("{}: {}", name.string(), error.what());
    }
}

}  // namespace

Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                  const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(parsed(json, name), name);
}

Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                  const Volume& /*data*/, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(parsed(json, name), name, GivenData::volume);
}

Scene parse_scene(const std::string& json, const std::filesystem::path& name,
                  const MeshData& /*data*/, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    return read_scene(parsed(json, name), name, GivenData::mesh);
}

std::string scene_text(const Scene& scene) {
    return json_text(scene_json(scene), 1) + "\n";
}

}  // namespace lamina
