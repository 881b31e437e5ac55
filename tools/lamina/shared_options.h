// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "choice/choose.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "lamina/words.h"

namespace lamina {

// Adds --memory SIZE, which sets the memory limit (base/memory.h) when the command line is parsed.
void add_memory_option(CLI::App& verb);

// Adds --only-below FOLDER: the verb opens no data outside the folder (base/input_file.h).
void add_only_below_option(CLI::App& verb);

// Options that give the layout of a file without a header.
struct RawOptions {
    std::string layout;  // "X,Y,Z,TYPE" or "X,Y,Z,TYPE,SX,SY,SZ"; empty: the file has a header
    std::int64_t offset = 0;
    bool big_endian = false;
};

void add_raw_options(CLI::App& verb, RawOptions& options);

// Throws UsageError if the options do not describe a layout.
VolumeRequest request_of(const RawOptions& options);

// Options that name a scene and change its settings.
struct SceneOptions {
    std::string file;                   // "-": stdin
    std::vector<std::string> settings;  // --set KEY=VALUE
    std::string method;                 // --method; may be empty
    RawOptions raw;                     // --raw, of a volume without a header
};

// Returns the scene of a scene file, or the scene that draws a data file
// (scene_files/scene_reader.h). `more`: settings that other options stand for. `document`: set to
// the scene's JSON with all settings. `edit`: changes the document before it is read. A mistake in
// --set, --method or `more` throws UsageError (exit 2), one in the file Error.
Scene load_scene(const SceneOptions& options, const std::vector<std::string>& more,
                 nlohmann::json& document, const std::function<void(nlohmann::json&)>& edit = {});

// Returns the scene as a document that load_scene() reads. Its `render` is that of `document`, with
// the scene's method.
nlohmann::ordered_json document_of(const Scene& scene, const nlohmann::json& document);

// Returns the path of the key of scenes that has this name, as "render.max_error" for "max_error",
// the outermost of several; empty if there is none.
std::string scene_key_named(const std::string& word);

// Returns width and height of an option's value WxH, 1 to 16384 each. Throws UsageError.
std::pair<int, int> pixels_of(const char* option, const std::string& text);

// Options that change the view without JSON.
struct ViewOptions {
    Words words;
    std::string size, background;
    bool transparent = false;
    bool legend = false, scale_bar = false, axes = false;
    std::string title;
};

void add_view_options(CLI::App& verb, ViewOptions& options);

// Returns the changes that the words make to the scene (choice/words.h). Throws UsageError.
Adjustments adjustments_of(const ViewOptions& options, ImageColorSpace space);

// Returns the options that adjustments_of() leaves out as values of --set: "image.width=800".
std::vector<std::string> settings_of(const ViewOptions& options);

// Returns the scene with transfer function and camera chosen for its volume, even if it draws a
// mesh.
Choices chosen_by_volume(const Scene& scene);

}  // namespace lamina
