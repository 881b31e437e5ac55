// SPDX-License-Identifier: Apache-2.0
#include "base/own_files.h"

#include <sstream>
#include <utility>

#include "base/atomic_file.h"
#include "base/client.h"
#include "base/error.h"
#include "base/file_bytes.h"
#include "base/folder.h"

namespace lamina {
namespace {

constexpr const char* first_line = "Written by lamina, which replaces nothing else here:";

bool is_there(const std::filesystem::path& path) {
    std::error_code ignored;  // a link that leads nowhere is there, too
    return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
}

}  // namespace

OwnFiles::OwnFiles(std::filesystem::path folder, std::string verb)
    : folder_(std::move(folder)), verb_(std::move(verb)) {}

std::set<std::string> OwnFiles::listed() const {
    const std::filesystem::path list = folder_ / list_name;
    if (!is_there(list)) return {};
    const OwnFilesScope own;
    std::istringstream lines(read_file_bytes(list));
    std::string line;
    if (!std::getline(lines, line) || line != first_line)
        fail("{}: not a list of files that lamina wrote: expected a folder without it",
             list.string());
    std::set<std::string> listed;
    while (std::getline(lines, line)) listed.insert(line);
    return listed;
}

void OwnFiles::expect_own(const std::vector<std::string>& names) const {
    // The folder is read before the list, because another process that writes into the folder at
    // the same time puts its files on the list before it makes them.
    std::vector<std::string> there;
    for (const std::string& name : names) {
        if (is_there(folder_ / name)) there.push_back(name);
    }
    const std::set<std::string> own = listed();
    for (const std::string& name : there) {
        if (own.contains(verb_ + ": " + name)) continue;
        fail("{}: not written by lamina {}: expected a folder without it, or --force to replace it",
             (folder_ / name).string(), verb_);
    }
}

void OwnFiles::add(const std::vector<std::string>& names) const {
    make_folder(folder_);
    std::set<std::string> lines = listed();
    const std::size_t before = lines.size();
    for (const std::string& name : names) lines.insert(verb_ + ": " + name);
    if (lines.size() == before) return;
    AtomicFile file(folder_ / list_name);
    file.write(std::string(first_line) + "\n");
    for (const std::string& line : lines) file.write(line + "\n");
    file.commit();
}

}  // namespace lamina
