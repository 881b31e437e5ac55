// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "raw_options.h"

namespace lamina {

// A scene as the command line names it.
struct SceneOptions {
    std::string file;                   // "-": stdin
    std::vector<std::string> settings;  // --set KEY=VALUE
    std::string method;                 // --method; may be empty
    RawOptions raw;                     // --raw, of a volume without a header
};

// The scene that a file is, or the one that draws a data file (scene_files/scene_reader.h).
// `more`: settings that other options stand for. `document`: becomes the scene's JSON with all
// settings. A mistake in --set, --method or one of `more` is one of usage (UsageError, exit 2), one
// in the file is not.
// `edit`: changes the document before it is read.
Scene load_scene(const SceneOptions& options, const std::vector<std::string>& more,
                 nlohmann::json& document, const std::function<void(nlohmann::json&)>& edit = {});

// The scene as a document that load_scene() reads: all of it that is not about drawing, and what
// `document` says about that.
nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document);

}  // namespace lamina
