// SPDX-License-Identifier: Apache-2.0
#include "different_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "named_output.h"

namespace lamina {
namespace {

using Identity = std::pair<dev_t, ino_t>;

// Returns the same identity for all names of a file, and nothing if there is no such file.
std::optional<Identity> identity_of(const std::filesystem::path& path) {
    struct stat found = {};
    if (stat(path.c_str(), &found) != 0) return std::nullopt;
    return Identity(found.st_dev, found.st_ino);
}

}  // namespace

void expect_different_files(const std::vector<std::filesystem::path>& read,
                            const std::vector<std::filesystem::path>& written) {
    std::map<Identity, std::filesystem::path> kept;
    for (const std::filesystem::path& path : read) {
        if (const auto identity = identity_of(path)) kept.emplace(*identity, path);
    }
    std::set<std::filesystem::path> made;
    for (const std::filesystem::path& path : written) {
        if (path.empty()) continue;
        const bool piped = path == standard_stream;
        const auto identity = piped ? std::nullopt : identity_of(path);
        const auto found = identity ? kept.find(*identity) : kept.end();
        if (found != kept.end()) {
            throw UsageError(
                fmt::format("{}: would replace {}, which is read: expected different files",
                            path.string(), found->second.string()));
        }
        std::error_code ignored;
        if (!made.insert(std::filesystem::weakly_canonical(path, ignored)).second) {
            throw UsageError(fmt::format("{}: would be written twice: expected different files",
                                         piped ? "-, stdout" : path.string()));
        }
    }
}

}  // namespace lamina
