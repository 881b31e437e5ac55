// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_file.h"
#include "base/value_type.h"

namespace lamina {

// An encoded array of a VTK XML file, up to the end of the text or data that may belong to it.
struct VtkXmlSource {
    std::string_view text;                   // the base64 text, if `file` is null
    const RandomAccessFile* file = nullptr;  // else the array lies in its bytes begin .. end - 1
    std::uint64_t begin = 0, end = 0;
    bool base64 = true;

    std::uint64_t left() const { return file != nullptr ? end - begin : text.size(); }
    void skip(std::uint64_t count) {
        if (file != nullptr)
            begin += count;
        else
            text.remove_prefix(count);
    }
};

// How a VTK XML file encodes its binary arrays: attributes of its VTKFile element.
struct VtkXmlEncoding {
    bool swap_bytes = false;
    ValueType header_type = ValueType::uint32;
    std::string compressor;  // empty: none
};

// Returns the type of a VTK XML file, such as "ImageData"; empty if it is none.
std::string vtk_xml_type(const std::filesystem::path& path);

// Values in their own type and native byte order.
struct VtkXmlValues {
    ValueType type = ValueType::uint8;
    ByteBuffer bytes;
};

// The XML of a VTK XML file without its appended data, which are no XML if they are raw. They stay
// in the file until an array is read. Throws Error if the file does not end as it should.
class VtkXmlText {
  public:
    explicit VtkXmlText(const std::filesystem::path& path);

    std::uint64_t byte_count() const { return file_.size(); }
    std::span<char> xml();  // to be parsed in place
    bool has_appended() const { return has_appended_; }
    VtkXmlSource appended() const { return appended_; }  // all appended data

  private:
    void read_beginning();
    std::string_view text() const { return bytes_.text().substr(0, read_); }
    void cut_off_appended(std::size_t tag);
    void find_end(std::uint64_t mark);

    std::string name_;
    RandomAccessFile file_;
    ByteBuffer bytes_;      // as long as the file
    std::size_t read_ = 0;  // bytes_ holds this many bytes of the file
    std::string xml_;       // instead of bytes_, if there are appended data
    bool has_appended_ = false;
    VtkXmlSource appended_;
};

// A VTK XML file of one kind of grid: its elements, and the numbers of its DataArrays in any
// encoding. Throws Error for anything invalid.
class VtkXmlFile {
  public:
    explicit VtkXmlFile(const std::filesystem::path& path,
                        const char* grid_type = "UnstructuredGrid");

    const std::string& name() const { return name_; }
    std::uint64_t byte_count() const { return text_.byte_count(); }
    pugi::xml_node grid() const { return grid_; }

    // Returns a whole number >= 0 in an attribute.
    std::int64_t count_in(pugi::xml_node node, const char* attribute,
                          const std::string& what) const;
    std::int64_t components_of(pugi::xml_node array, const std::string& what) const;

    // Returns tuples * components values of a DataArray as double or int64. `what`: for messages.
    template <typename To>
    std::vector<To> values(pugi::xml_node array, std::int64_t tuples, std::int64_t components,
                           const std::string& what) const;
    // Returns the values in their own type and native byte order.
    VtkXmlValues stored_values(pugi::xml_node array, std::int64_t tuples, std::int64_t components,
                               const std::string& what) const;

  private:
    // Calls binary(source) if the array has `count` binary values, text(reader) if these are text.
    template <typename Binary, typename Text>
    auto decoded(pugi::xml_node array, std::int64_t count, const std::string& what,
                 const Binary& binary, const Text& text) const;
    std::int64_t value_count(std::int64_t tuples, std::int64_t components,
                             const std::string& what) const;
    void parse(std::span<char> xml, const char* grid_type);
    void read_root(pugi::xml_node root, const char* grid_type);
    ValueType type_of(pugi::xml_node array, const std::string& what) const;
    VtkXmlSource appended_at(pugi::xml_node array, const std::string& what) const;
    void count_appended(std::uint64_t bytes, const std::string& what) const;
    void count_kept(std::int64_t count, const std::string& what) const;

    std::string name_;
    VtkXmlText text_;                          // xml_nodes point into it
    mutable std::uint64_t appended_used_ = 0;  // bytes of appended data that were read
    mutable std::uint64_t values_kept_ = 0;    // number of values of all arrays that were read
    pugi::xml_document document_;
    pugi::xml_node grid_;
    VtkXmlEncoding encoding_;
};

}  // namespace lamina
