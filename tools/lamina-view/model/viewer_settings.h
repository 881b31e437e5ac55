// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "lamina/volume.h"
#include "model/scene_keys.h"

namespace lamina::view {

// Returns true if a scene may lack this group of keys, so that it can be switched off.
bool may_be_absent(const SettingNode& node);

// Returns the value that a key gets when it is switched on or stops being automatic: the value in
// `resolved` (may be null), else its default, else one that can be drawn. `path` is the node's path
// with indices of list elements. `bounds`: bounds of the data, if known.
nlohmann::ordered_json starting_value(const SettingNode& node, const std::string& path,
                                      const Scene& scene, const Scene* resolved,
                                      const std::optional<Grid::Bounds>& bounds);

// Settings of the viewer that are kept when it ends.
struct ViewerSettings {
    std::vector<std::filesystem::path> recent;  // files, last opened first
    bool coarse = true;                         // draw coarse pictures while something moves
    bool trace = true;                          // trace at rest
    bool panels = true;                         // show the panels

    void add_recent(const std::filesystem::path& file);  // keeps at most 10

    // Returns lamina/viewer.json in the XDG configuration folder; empty if there is no home.
    static std::filesystem::path file();
    // Returns defaults if the file does not exist. Throws Error if it is invalid.
    static ViewerSettings load(const std::filesystem::path& file);
    // Writes a temporary file and renames it to `file`. Throws Error if that fails.
    void save(const std::filesystem::path& file) const;
};

}  // namespace lamina::view
