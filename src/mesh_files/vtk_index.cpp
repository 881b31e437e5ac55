// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/vtk_index.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "base/error.h"
#include "base/input_file.h"

namespace lamina {

VtkIndex::VtkIndex(const std::filesystem::path& path, const char* type) : name_(path.string()) {
    expect_allowed(path);
    constexpr std::size_t most_bytes = std::size_t{64} << 20, most_marks = 1'000'000;
    const std::uintmax_t size =
        std::filesystem::is_regular_file(path) ? std::filesystem::file_size(path) : 0;
    if (size > most_bytes) {
        fail("{}: found {} bytes, expected at most {}, because it only names files", name_, size,
             most_bytes);
    }
    const std::string text = read_file_bytes(path);
    const auto marks = static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return c == '<' || c == '='; }));
    if (marks > most_marks)
        fail("{}: found {} tags and attributes, expected at most {}", name_, marks, most_marks);
    const pugi::xml_parse_result result =
        document_.load_buffer(text.data(), text.size(), pugi::parse_escapes, pugi::encoding_utf8);
    if (!result) {
        fail("{}: truncated or damaged XML at byte {} of {}: {}", name_, result.offset, text.size(),
             result.description());
    }
    const pugi::xml_node root = document_.child("VTKFile");
    if (!root) fail("{}: not a VTK XML file: no <VTKFile> in it", name_);
    const std::string found = root.attribute("type").value();
    if (found != type)
        fail("{}: VTKFile type: found '{}', expected '{}'", name_, one_line(found), type);
    node_ = root.child(type);
    if (!node_) fail("{}: no <{}> in it", name_, type);
}

std::filesystem::path VtkIndex::file_in(pugi::xml_node node, const char* attribute,
                                        const std::string& what) const {
    const std::filesystem::path file = node.attribute(attribute).value();
    if (file.empty()) fail("{}: {}: {}: found none, expected a file", name_, what, attribute);
    return std::filesystem::path(name_).parent_path() / file;  // an absolute one stays as it is
}

void expect_each_once(const std::vector<std::filesystem::path>& files, const std::string& name) {
    std::set<std::filesystem::path> seen;
    for (const std::filesystem::path& file : files) {
        std::error_code unreadable;  // such a file fails when it is read
        const auto canonical = std::filesystem::weakly_canonical(file, unreadable);
        if (!seen.insert(unreadable ? file : canonical).second)
            fail("{}: found the file {} twice, expected each once", name, one_line(file.string()));
    }
}

}  // namespace lamina
