// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace lamina {

// A VTK XML file without numbers of its own, which names other files: .pvtu, .pvd.
class VtkIndex {
  public:
    // `type`: of its VTKFile element, and the name of the one element in that. Throws Error.
    VtkIndex(const std::filesystem::path& path, const char* type);

    const std::string& name() const { return name_; }
    pugi::xml_node node() const { return node_; }
    // The file that an attribute names, relative to this one. `what`: for messages.
    std::filesystem::path file_in(pugi::xml_node node, const char* attribute,
                                  const std::string& what) const;

  private:
    std::string name_;
    pugi::xml_document document_;
    pugi::xml_node node_;
};

// Throws Error where two of the files, which `name` lists, are one: it would be read twice.
void expect_each_once(const std::vector<std::filesystem::path>& files, const std::string& name);

}  // namespace lamina
