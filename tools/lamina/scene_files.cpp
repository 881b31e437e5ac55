// SPDX-License-Identifier: Apache-2.0
#include "scene_files.h"

#include "base/error.h"
#include "volume/nrrd_header.h"

namespace lamina {
namespace {

void add_volume(const std::filesystem::path& volume, std::vector<std::filesystem::path>& files) {
    files.push_back(volume);
    try {
        files.push_back(read_nrrd_header(volume).data_path);
    } catch (const Error&) {
        // Said when the volume is read, if it is.
    }
}

void add_mesh(std::filesystem::path mesh, std::vector<std::filesystem::path>& files) {
    files.push_back(mesh);
    if (mesh.extension() == ".node") files.push_back(mesh.replace_extension(".ele"));
    if (mesh.extension() == ".ele") files.push_back(mesh.replace_extension(".node"));
}

}  // namespace

std::vector<std::filesystem::path> files_of(const Scene& scene) {
    std::vector<std::filesystem::path> files;
    if (!scene.colormap_file.empty()) files.push_back(scene.colormap_file);
    if (!scene.volume_file.empty()) add_volume(scene.volume_file, files);
    if (!scene.mesh_file.empty()) add_mesh(scene.mesh_file, files);
    return files;
}

}  // namespace lamina
