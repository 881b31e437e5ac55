// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "volume_files/byte_reader.h"

namespace lamina {

// Bytes in memory, which must outlive the reader.
class MemoryReader : public ByteReader {
  public:
    // `name`: for messages.
    MemoryReader(std::string_view bytes, std::string name)
        : bytes_(bytes), name_(std::move(name)) {}

    void read(void* to, std::size_t count) override {
        const char* const from = bytes_.data();
        skip(count);
        std::memcpy(to, from, count);
    }
    void skip(std::size_t count) override {
        if (count > bytes_.size())
            fail("{}: found {} bytes of data, expected {}", name_, bytes_.size(), count);
        bytes_.remove_prefix(count);
    }
    std::vector<std::string> surplus() override {
        if (bytes_.empty()) return {};
        return {fmt::format("{} bytes more", bytes_.size())};
    }

  private:
    std::string_view bytes_;  // not read yet
    std::string name_;
};

}  // namespace lamina
