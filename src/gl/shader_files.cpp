// SPDX-License-Identifier: Apache-2.0
#include "gl/shader_files.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.h"

namespace lamina::gl {
namespace {

std::optional<std::string> find_in_override(const std::string& name) {
    const char* directory = std::getenv("LAMINA_SHADER_DIR");
    if (!directory || !*directory) return std::nullopt;
    std::error_code ignored;
    if (!std::filesystem::is_directory(directory, ignored))
        fail("{}: no such folder (LAMINA_SHADER_DIR)", directory);
    const std::filesystem::path path = std::filesystem::path(directory) / name;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) fail("{}: cannot be read (LAMINA_SHADER_DIR)", path.string());
    return text;
}

}  // namespace

std::vector<std::string> shader_names() {
    std::vector<std::string> names;
    for (const EmbeddedFile& shader : embedded_shaders()) names.emplace_back(shader.name);
    return names;
}

std::optional<std::string> find_shader(const std::string& name) {
    if (auto text = find_in_override(name)) return text;
    for (const EmbeddedFile& shader : embedded_shaders()) {
        if (shader.name == name) return std::string(shader.text);
    }
    return std::nullopt;
}

}  // namespace lamina::gl
