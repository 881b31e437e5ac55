// SPDX-License-Identifier: Apache-2.0
#include "model/viewer_settings.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "lamina/error.h"

namespace lamina::view {
namespace {

namespace fs = std::filesystem;

}  // namespace

void ViewerSettings::add_recent(const fs::path& path) {
    constexpr std::size_t most = 10;
    const fs::path whole = fs::absolute(path).lexically_normal();
    std::erase(recent, whole);
    recent.insert(recent.begin(), whole);
    if (recent.size() > most) recent.resize(most);
}

// A relative path in the variable is to be ignored, as the specification says.
fs::path ViewerSettings::file() {
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    if (config != nullptr && fs::path(config).is_absolute())
        return fs::path(config) / "lamina" / "viewer.json";
    const char* const home = std::getenv("HOME");
    if (home == nullptr || *home == '\0') return {};
    return fs::path(home) / ".config" / "lamina" / "viewer.json";
}

ViewerSettings ViewerSettings::load(const fs::path& file) {
    ViewerSettings settings;
    std::ifstream stream(file);
    if (!stream) return settings;
    try {
        const nlohmann::json document = nlohmann::json::parse(stream);
        for (const std::string& path : document.value("recent", std::vector<std::string>()))
            settings.recent.emplace_back(path);
        settings.coarse = document.value("coarse", settings.coarse);
        settings.trace = document.value("trace", settings.trace);
        settings.panels = document.value("panels", settings.panels);
    } catch (const nlohmann::json::exception& error) {
        throw Error(fmt::format("{}: not the viewer's settings: {}", file.string(), error.what()));
    }
    return settings;
}

void ViewerSettings::save(const fs::path& file) const {
    std::vector<std::string> names;
    for (const fs::path& path : recent) names.push_back(path.string());
    const nlohmann::json document = {
        {"recent", names}, {"coarse", coarse}, {"trace", trace}, {"panels", panels}};
    const fs::path part = fmt::format("{}.{}.part", file.string(), getpid());
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    bool written = false;
    {
        std::ofstream stream(part);
        stream << document.dump(2) << '\n';
        written = static_cast<bool>(stream.flush());
    }
    if (written) fs::rename(part, file, failed);
    if (written && !failed) return;
    std::error_code ignored;
    fs::remove(part, ignored);
    throw Error(fmt::format("{}: cannot write the settings", file.string()));
}

}  // namespace lamina::view
