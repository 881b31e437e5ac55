// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lamina {

// Decodes the bytes of a binary array of a VTK XML file, raw or base64. Base64 may consist of
// several runs with padding of their own, because VTK encodes the header and the compressed blocks
// separately.
class EncodedBytes {
  public:
    // `what`: names the file and the array in messages.
    EncodedBytes(std::string_view text, bool base64, std::string what)
        : text_(text), base64_(base64), what_(std::move(what)) {}

    // An upper bound on the number of bytes that can still be read.
    std::size_t at_most_left() const { return base64_ ? left() / 4 * 3 + decoded_count_ : left(); }
    std::size_t used() const { return position_; }  // characters of the text that were used
    // Throws Error where there are fewer, or where it is not base64.
    void read(char* bytes, std::size_t count);

  private:
    std::size_t left() const { return text_.size() - position_; }
    bool decode_four();

    std::string_view text_;
    bool base64_;
    std::string what_;
    std::size_t position_ = 0;
    char decoded_[3] = {};  // the last decoded_count_ of these are not read yet
    std::size_t decoded_count_ = 0;
    std::size_t decoded_at_ = 0;
};

}  // namespace lamina
