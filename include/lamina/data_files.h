// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "lamina/export.h"
#include "lamina/mesh_data.h"
#include "lamina/volume.h"
#include "lamina/volume_request.h"

namespace lamina {

enum class FileKind { scene, volume, mesh };

// If `only_below` is a folder, these functions refuse files that are not below it with all links
// followed, whoever names them (docs/files.md).

// Returns what a file holds, by its content, or by its name if the content does not tell. Throws
// Error if neither does.
LAMINA_API FileKind kind_of_file(const std::filesystem::path& file,
                                 const std::filesystem::path& only_below = {});

// Reads a volume, or a tetrahedral mesh with its scalars, of any kind that scenes may name
// (docs/scene.md, "What is drawn"). Throws Error: one line that names the file, what was found and
// what was expected.
LAMINA_API Volume load_volume(const std::filesystem::path& file, const VolumeRequest& request = {},
                              const std::filesystem::path& only_below = {});
LAMINA_API MeshData load_mesh_data(const std::filesystem::path& file,
                                   const std::filesystem::path& only_below = {});

// Writes a volume as .nrrd, from which load_volume() reads the same bits, or a mesh as .vtu in
// double precision. The file appears under its name when it is complete. Throws Error, also for
// other suffixes.
LAMINA_API void save_volume(const Volume& volume, const std::filesystem::path& file);
LAMINA_API void save_mesh(const MeshData& mesh, const std::filesystem::path& file);

}  // namespace lamina
