// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/value_type.h"
#include "mesh_files/vtk_xml_text.h"
#include "mesh_files/vtu_data.h"

namespace lamina {

// A VTK XML file of one kind of grid: its elements, and the numbers of its DataArrays in any
// encoding. Throws Error for anything invalid.
class VtuFile {
  public:
    explicit VtuFile(const std::filesystem::path& path, const char* grid_type = "UnstructuredGrid");

    const std::string& name() const { return name_; }
    std::uint64_t byte_count() const { return text_.byte_count(); }
    pugi::xml_node grid() const { return grid_; }

    // A whole number >= 0 in an attribute.
    std::int64_t count_in(pugi::xml_node node, const char* attribute,
                          const std::string& what) const;
    std::int64_t components_of(pugi::xml_node array, const std::string& what) const;

    // The values (tuples times components) of a DataArray as To: double or int64. `what`: names the
    // file and the array in messages.
    template <typename To>
    std::vector<To> values(pugi::xml_node array, std::int64_t tuples, std::int64_t components,
                           const std::string& what) const;
    // The same in their own type and native byte order.
    VtuValues stored_values(pugi::xml_node array, std::int64_t tuples, std::int64_t components,
                            const std::string& what) const;

  private:
    // Calls binary(source) or text(reader), whichever holds the values, for `count` of them.
    template <typename Binary, typename Text>
    auto decoded(pugi::xml_node array, std::int64_t count, const std::string& what,
                 const Binary& binary, const Text& text) const;
    std::int64_t value_count(std::int64_t tuples, std::int64_t components,
                             const std::string& what) const;
    void parse(std::span<char> xml, const char* grid_type);
    void read_root(pugi::xml_node root, const char* grid_type);
    ValueType type_of(pugi::xml_node array, const std::string& what) const;
    VtuSource appended_at(pugi::xml_node array, const std::string& what) const;
    void count_appended(std::uint64_t bytes, const std::string& what) const;
    void count_kept(std::int64_t count, const std::string& what) const;

    std::string name_;
    VtkXmlText text_;                          // xml_nodes point into it
    mutable std::uint64_t appended_used_ = 0;  // bytes used by all arrays that were read
    mutable std::uint64_t values_kept_ = 0;    // number of values of all arrays that were read
    pugi::xml_document document_;
    pugi::xml_node grid_;
    VtuEncoding encoding_;
};

}  // namespace lamina
