// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/input_file.h"
#include "mesh_files/vtu_source.h"

namespace lamina {

// The text of a VTK XML file without its appended data, which are no XML where they are raw and
// stay in the file until an array is read. Throws Error where the file does not end as it should.
class VtkXmlText {
  public:
    explicit VtkXmlText(const std::filesystem::path& path);

    std::uint64_t byte_count() const { return file_.size(); }
    std::span<char> xml();  // of the file, to be parsed in place
    bool has_appended() const { return has_appended_; }
    VtuSource appended() const { return appended_; }  // all of them, after the underscore

  private:
    void read_beginning();
    std::string_view text() const { return bytes_.text().substr(0, read_); }
    void cut_off_appended(std::size_t tag);
    void find_end(std::uint64_t mark);

    std::string name_;
    RandomAccessFile file_;
    ByteBuffer bytes_;      // as many as the file has
    std::size_t read_ = 0;  // of these
    std::string xml_;       // where there are appended data
    bool has_appended_ = false;
    VtuSource appended_;
};

}  // namespace lamina
