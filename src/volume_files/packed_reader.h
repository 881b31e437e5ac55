// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "volume_files/byte_reader.h"
#include "volume_files/opened_file.h"

namespace lamina {

// Decompresses one or more members from the current position of a file, and verifies checksums.
class PackedReader : public ByteReader {
  public:
    void read(void* bytes, std::size_t count) override;
    void skip(std::size_t count) override;
    std::vector<std::string> surplus() override;

    static constexpr std::uint64_t most_unpacked = std::uint64_t{1} << 26;

  protected:
    using Input = std::span<const unsigned char>;
    using Output = std::span<unsigned char>;

    // `name`: for messages.
    PackedReader(OpenedFile stream, std::string name, const char* format);
    [[noreturn]] void fail_as_damaged(const char* reason) const;

  private:
    // The data beyond what was read.
    struct Surplus {
        // Bytes of the last member that were not read, counted up to most_unpacked.
        std::uint64_t unpacked = 0;
        std::uint64_t behind = 0;  // bytes of the file after that member
    };
    // Decompresses the rest of the member, up to the counted surplus, and verifies its checksum.
    Surplus rest();

    // Decompresses some bytes from `from` to `to` and updates both. Returns true at the end of a
    // member; the next call may then start another member.
    virtual bool unpack(Input& from, Output& to) = 0;

    bool unpack_some(Output& to);  // false at the end of the file

    OpenedFile stream_;
    std::string name_;
    const char* format_;
    std::vector<unsigned char> input_;
    Input left_;              // of input_
    bool in_member_ = false;  // whether a member has begun and not ended
};

}  // namespace lamina
