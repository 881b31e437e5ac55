// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace lamina::view {

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
