// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_document.h"

#include <nlohmann/json.hpp>
#include <string>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "mesh_files/mesh_file.h"
#include "scene_files/data_keys.h"
#include "volume_files/volume_file.h"

namespace lamina {

FileKind kind_of_file(const std::filesystem::path& file, const std::filesystem::path& only_below) {
    const OnlyBelowScope scope(only_below);
    if (is_volume_file(file)) return FileKind::volume;
    if (is_mesh_file(file)) return FileKind::mesh;
    const std::string beginning = file_beginning(file, 64);
    const std::size_t first = beginning.find_first_not_of(" \t\r\n");
    // What cannot be read is for the scene's reader to name.
    const bool scene = file.extension() == ".json" || beginning.empty() ||
                       (first != std::string::npos && beginning[first] == '{');
    if (scene) return FileKind::scene;
    fail(
        "{}: unknown kind of file: expected a scene (JSON), a volume ({}) or a mesh (.vtu, .pvtu, "
        ".pvd, .vtk, .node, .ele)",
        file.string(), volume_format_names());
}

nlohmann::json scene_document(const std::filesystem::path& file, const VolumeRequest& request) {
    const FileKind kind = request.raw ? FileKind::volume : kind_of_file(file);
    if (kind == FileKind::scene) return load_json(file);
    const std::string path = std::filesystem::absolute(file).string();
    nlohmann::json document{{"version", 1}, {"nan", "transparent"}};
    if (kind == FileKind::volume)
        document["volume"] = volume_selection_json(path, request);
    else
        document["mesh"] = path;
    return document;
}

}  // namespace lamina
