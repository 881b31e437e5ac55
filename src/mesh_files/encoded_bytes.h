// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/input_file.h"
#include "mesh_files/vtu_source.h"

namespace lamina {

// Decodes the bytes of a binary array of a VTK XML file, raw or base64. Base64 may consist of
// several runs with padding of their own, because VTK encodes the header and the compressed blocks
// separately.
class EncodedBytes {
  public:
    // `what`: names the file and the array in messages.
    EncodedBytes(const VtuSource& source, std::string what)
        : source_(source), text_(source.text), what_(std::move(what)) {}

    // An upper bound on the number of bytes that can still be read.
    std::uint64_t at_most_left() const {
        return source_.base64 ? left() / 4 * 3 + decoded_count_ : left();
    }
    std::uint64_t used() const { return before_ + position_; }  // bytes of the source
    // Throws Error where there are fewer, or where it is not base64.
    void read(char* bytes, std::size_t count);

  private:
    std::uint64_t left() const { return source_.left() - used(); }
    bool read_on();
    bool decode_four();
    std::size_t decode_whole_groups(char* bytes, std::size_t count);

    VtuSource source_;
    ByteBuffer window_;      // a part of the source, where that is in a file
    std::string_view text_;  // of the source, or the window's
    std::string what_;
    std::uint64_t before_ = 0;  // bytes of the source before the text
    std::size_t position_ = 0;  // in the text
    char decoded_[3] = {};      // the last decoded_count_ of these are not read yet
    std::size_t decoded_count_ = 0;
    std::size_t decoded_at_ = 0;
};

}  // namespace lamina
