// SPDX-License-Identifier: Apache-2.0
#include "optics/shipped_colormaps.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/text.h"
#include "optics/colormap.h"
#include "optics/embedded_colormaps.h"

namespace lamina {
namespace {

constexpr std::string_view suffix = ".json";

const EmbeddedFile* find(const std::string& name) {
    const auto files = embedded_colormaps();
    const auto found = std::ranges::find_if(
        files, [&](const EmbeddedFile& file) { return file.name == name + std::string(suffix); });
    return found == files.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string> colormap_names() {
    std::vector<std::string> names;
    for (const EmbeddedFile& file : embedded_colormaps())
        names.emplace_back(file.name.substr(0, file.name.size() - suffix.size()));
    return names;
}

bool is_colormap_name(const std::string& name) {
    return find(name) != nullptr;
}

Colormap load_colormap(const std::string& name_or_path, ImageColorSpace space) {
    if (const EmbeddedFile* const file = find(name_or_path)) {
        const nlohmann::json preset = parse_json(std::string(file->text));
        Colormap colormap = colormap_of(preset, name_or_path, space);
        colormap.own_range = preset.contains("Units");
        return colormap;
    }
    expect_allowed(name_or_path);
    std::error_code unknown;
    if (!std::filesystem::exists(name_or_path, unknown)) {
        const auto names = colormap_names();
        const std::string word = std::filesystem::path(name_or_path).filename().string();
        fail("{}: no such file, and no colour map has that name{}", shortened(name_or_path),
             suggestion({names.begin(), names.end()}, word));
    }
    return read_paraview_colormap(name_or_path, space);
}

}  // namespace lamina
