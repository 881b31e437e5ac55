// SPDX-License-Identifier: Apache-2.0
#include "scene_files.h"

#include "mesh_files/mesh_file.h"
#include "scene/given_transfer.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Paths = std::vector<std::filesystem::path>;

void append(Paths& files, const Paths& more) {
    files.insert(files.end(), more.begin(), more.end());
}

}  // namespace

Paths files_of(const Scene& scene) {
    Paths files{scene.file};
    const std::filesystem::path colormap = colormap_file_of(scene);
    if (!colormap.empty()) files.push_back(colormap);
    if (const VolumeFile* const volume = scene.volume_file())
        append(files, files_of_volume(volume->path, volume->selection));
    if (const MeshFile* const mesh = scene.mesh_file()) append(files, files_of_mesh(mesh->path));
    return files;
}

}  // namespace lamina
