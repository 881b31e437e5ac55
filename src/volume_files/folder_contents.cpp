// SPDX-License-Identifier: Apache-2.0
#include "volume_files/folder_contents.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh_files/mesh_file.h"
#include "volume_files/foreign_files.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// Names of entries by their kind, "NRRD" or "meshes"; those of all else are under "".
using NamesByKind = std::map<std::string_view, std::vector<std::string>>;

// Entries that are looked at, so that the message comes at once: of a folder, and of each in it.
constexpr std::size_t most_looked_at = 64, most_looked_below = 8;

std::string_view kind_of(const Path& path) {
    try {
        const std::string_view format = volume_format_of(path);
        return format.empty() && is_mesh_file(path) ? "meshes" : format;
    } catch (const Error&) {
        return {};  // the client may not open it (base/input_file.h)
    }
}

std::vector<Path> entries_of(const Path& folder, std::size_t most) {
    std::vector<Path> entries;
    std::error_code error;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        if (!entry->path().filename().string().starts_with('.')) entries.push_back(entry->path());
    }
    std::ranges::sort(entries);
    if (entries.size() > most) entries.resize(most);
    return entries;
}

// Lists what is in a folder and, unless `is_below`, what is in the folders in it.
NamesByKind contents_of(const Path& folder, bool is_below = false) {
    NamesByKind contents;
    for (const Path& entry : entries_of(folder, is_below ? most_looked_below : most_looked_at)) {
        std::error_code absent;
        const bool is_folder = std::filesystem::is_directory(entry, absent);
        const std::string name =
            one_line(shortened(entry.filename().string())) + (is_folder ? "/" : "");
        const std::string_view kind = kind_of(entry);
        NamesByKind inner;
        if (kind.empty() && is_folder && !is_below) inner = contents_of(entry, true);
        inner.erase("");
        for (const auto& [inner_kind, names] : inner)
            for (const std::string& each : names) contents[inner_kind].push_back(name + each);
        if (inner.empty()) contents[kind].push_back(name);
    }
    return contents;
}

// Returns the kinds, each with its first names: "DICOM (ct/), NRRD (a.nrrd, b.nrrd)".
std::string text_of(const NamesByKind& contents) {
    constexpr std::size_t most_examples = 3;
    std::vector<std::string> texts;
    for (const auto& [kind, names] : contents) {
        const std::span first(names.data(), std::min(names.size(), most_examples));
        texts.push_back(fmt::format("{} ({}{})", kind.empty() ? "unknown kinds" : kind,
                                    fmt::join(first, ", "),
                                    names.size() > most_examples ? ", ..." : ""));
    }
    return texts.empty() ? "nothing in it" : fmt::format("{}", fmt::join(texts, ", "));
}

// Returns the first of a folder's files if all have one extension; else nothing.
Path only_kind(const Path& folder) {
    const std::vector<Path> entries = entries_of(folder, most_looked_at);
    const auto differ = [&](const Path& entry) {
        return entry.extension() != entries[0].extension();
    };
    return entries.empty() || std::ranges::any_of(entries, differ) ? Path() : entries[0];
}

}  // namespace

void expect_no_folder(const Path& path) {
    std::error_code absent;
    if (!std::filesystem::is_directory(path, absent)) return;
    const NamesByKind contents = contents_of(path);
    if (const Path first = only_kind(path); !first.empty()) expect_no_foreign_file(first);
    const bool has_data = contents.size() > contents.count("");
    fail("{}: found a folder with {}, expected {}", path.string(), text_of(contents),
         has_data ? "the name of one of these" : "a volume: " + volume_format_names());
}

}  // namespace lamina
