// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "base/input_file.h"

namespace lamina {

// A file in a ZIP archive, as the archive's directory describes it.
struct ZipMember {
    std::string name;         // with '/' between folders, as "levels/0/.zarray"
    std::uint64_t bytes = 0;  // of its contents
    std::uint64_t stored_bytes = 0;
    std::uint64_t header = 0;  // byte of the archive at which the member begins
    std::uint32_t crc = 0;
    std::uint16_t method = 0;  // 0: stored as it is, 8: deflated
    bool is_encrypted = false;

    bool is_stored() const { return method == 0; }
};

// Tells if a file begins like a ZIP archive. Never throws.
bool has_zip_mark(const std::filesystem::path& path);

// A ZIP archive (PKWARE's APPNOTE 6.3), Zip64 too, in one file. Safe from any thread. All functions
// throw Error, which names the archive and the member.
class ZipArchive {
  public:
    // By name. Of several members with one name, the directory's last counts: programs write it to
    // replace those before it.
    using Members = std::map<std::string, ZipMember, std::less<>>;

    explicit ZipArchive(const std::filesystem::path& path);

    const Members& members() const { return members_; }
    const ZipMember* find(std::string_view name) const;  // null if there is none

    // Returns a member's contents, whose size and CRC are verified. Takes memory only after it has
    // checked that the member can hold what the directory says.
    ByteBuffer read(const ZipMember& member) const;
    // Returns the first bytes of the contents, up to `most`, without a look at the CRC.
    ByteBuffer read_beginning(const ZipMember& member, std::size_t most) const;
    // Returns the byte of the archive at which the bytes of a member begin. Throws Error for
    // members that are encrypted, are compressed by other codes than deflate, or are impossible.
    std::uint64_t place_of(const ZipMember& member) const;

  private:
    // The directory's bytes in the file, and its first byte as the archive counts: bytes that a
    // program has put before the archive do not count.
    struct Directory {
        std::uint64_t begin, end, counted_begin;
    };

    [[noreturn]] void fail_as_damaged(std::string_view what) const;
    std::string bytes_at(std::uint64_t begin, std::size_t count) const;
    Directory find_directory() const;
    Directory wide_directory(std::uint64_t locator) const;
    void read_members(const Directory& directory);
    void inflate(const ZipMember& member, ByteBuffer& contents, bool all) const;

    std::string name_;
    RandomAccessFile file_;
    std::uint64_t directory_begin_ = 0;  // byte behind the last member
    Members members_;
};

}  // namespace lamina
