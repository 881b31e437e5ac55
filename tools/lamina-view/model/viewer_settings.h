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

// Returns true if a scene may lack this group of keys, so that it can be switched on and off.
bool may_be_absent(const SettingNode& node);

// Returns a key's value when it is switched on, or no longer automatic: the value that was chosen
// for it (`resolved`, may be null), else its default, else a value that can be drawn. `bounds`: the
// data's, if they are known. `path` contains the indices of list elements.
nlohmann::ordered_json starting_value(const SettingNode& node, const std::string& path,
                                      const Scene& scene, const Scene* resolved,
                                      const std::optional<Grid::Bounds>& bounds);

// Settings that the viewer keeps from one run to the next.
struct ViewerSettings {
    std::vector<std::filesystem::path> recent;  // files, the last one first
    bool coarse = true;                         // pictures while something moves
    bool trace = true;                          // at rest
    bool panels = true;                         // are shown

    void add_recent(const std::filesystem::path& file);  // 10 at most

    // Returns the path of viewer.json in the folder lamina of the XDG base directories; empty if
    // there is no home.
    static std::filesystem::path file();
    // Returns defaults if there is no such file. Throws Error for a file that cannot be understood.
    static ViewerSettings load(const std::filesystem::path& file);
    // Writes the file, which appears when it is complete. Throws Error.
    void save(const std::filesystem::path& file) const;
};

}  // namespace lamina::view
