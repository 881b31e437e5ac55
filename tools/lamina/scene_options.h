// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "raw_options.h"

namespace lamina {

// Options that name a scene and change its settings.
struct SceneOptions {
    std::string file;                   // "-": stdin
    std::vector<std::string> settings;  // --set KEY=VALUE
    std::string method;                 // --method; may be empty
    RawOptions raw;                     // --raw, of a volume without a header
};

// Returns the scene of a scene file, or the one that draws a data file
// (scene_files/scene_reader.h). `more`: settings that other options stand for. `document`:
// becomes the scene's JSON with all settings. `edit`: changes the document before it is read. A
// mistake in --set, --method or one of `more` is one of usage (UsageError, exit 2); one in the file
// is not.
Scene load_scene(const SceneOptions& options, const std::vector<std::string>& more,
                 nlohmann::json& document, const std::function<void(nlohmann::json&)>& edit = {});

// Returns the scene as a document that load_scene() reads. Its key `render` is that of `document`,
// with the scene's method.
nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document);

}  // namespace lamina
