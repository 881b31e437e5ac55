// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace lamina {

// Decompresses a stream (of one or more members) from where `stream` stands, and checks checksums.
// Throws Error; `file` is for messages.
class PackedReader {
  public:
    virtual ~PackedReader() = default;
    PackedReader(const PackedReader&) = delete;
    PackedReader& operator=(const PackedReader&) = delete;

    void read(void* bytes, std::size_t count);
    void skip(std::size_t count);

    // What nobody asked for.
    struct Surplus {
        // Bytes of the member that was read last, counted to most_unpacked.
        std::uint64_t unpacked = 0;
        std::uint64_t behind = 0;  // bytes of the file behind that member
    };
    static constexpr std::uint64_t most_unpacked = std::uint64_t{1} << 26;
    // Once all is read: ends the member, with its checksum, as far as its surplus is counted.
    Surplus finish();

  protected:
    using Input = std::span<const unsigned char>;
    using Output = std::span<unsigned char>;

    PackedReader(std::FILE* stream, std::string file, const char* format);
    [[noreturn]] void fail_as_damaged(const char* reason) const;

  private:
    // Moves some bytes from one to the other and leaves the rest of both. True at a member's end,
    // from where it can go on with another.
    virtual bool unpack(Input& from, Output& to) = 0;

    bool unpack_some(Output& to);  // false at the end of the file

    std::FILE* stream_;
    std::string file_;
    const char* format_;
    std::vector<unsigned char> input_;
    Input left_;              // of input_
    bool in_member_ = false;  // which has begun and not ended
};

}  // namespace lamina
