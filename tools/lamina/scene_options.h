// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/scene.h"

namespace lamina {

// A scene as the command line names it.
struct SceneOptions {
    std::string file;                   // "-": stdin
    std::vector<std::string> settings;  // --set KEY=VALUE
    std::string method;                 // --method; may be empty
};

// `document_text`: becomes the scene's JSON with these settings. A mistake in --set or --method is
// one of usage (UsageError, exit 2), one in the file is not.
Scene load_scene(const SceneOptions& options, std::string& document_text);

}  // namespace lamina
