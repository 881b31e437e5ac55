// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace lamina {

enum class FileKind { scene, volume, mesh };

// What a file holds: by its content, and by its name where that does not tell. Throws Error where
// neither does.
FileKind kind_of_file(const std::filesystem::path& file);

// The JSON of a scene file; of a data file, a scene that draws it: all else is automatic, and cells
// with NaN are transparent.
nlohmann::json scene_document(const std::filesystem::path& file);

}  // namespace lamina
