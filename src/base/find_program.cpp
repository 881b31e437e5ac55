// SPDX-License-Identifier: Apache-2.0
#include "base/find_program.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <system_error>

namespace lamina {
namespace {

bool is_program(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored) && access(path.c_str(), X_OK) == 0;
}

// The folder of programs that was installed with the library, for other programs that load it.
std::filesystem::path programs_of_library() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&is_program), &info) == 0 || !info.dli_fname)
        return {};
    return std::filesystem::path(info.dli_fname).parent_path() / LAMINA_PROGRAMS_FROM_LIBRARY;
}

}  // namespace

std::optional<std::filesystem::path> find_program(const std::string& name) {
    std::error_code failure;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", failure);
    for (const auto& folder : {self.parent_path(), programs_of_library()}) {
        if (!folder.empty() && is_program(folder / name)) return folder / name;
    }
    const char* const folders = std::getenv("PATH");
    std::istringstream list(folders ? folders : "");
    for (std::string folder; std::getline(list, folder, ':');) {
        // Shells take an empty entry for the current folder. A program that lies there by chance
        // must not be started.
        if (folder.empty()) continue;
        if (is_program(std::filesystem::path(folder) / name))
            return std::filesystem::path(folder) / name;
    }
    return std::nullopt;
}

}  // namespace lamina
