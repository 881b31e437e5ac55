// SPDX-License-Identifier: Apache-2.0
#include "volume_files/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "volume_files/byte_readers.h"

namespace lamina {
namespace {

// Bytes of an archive's parts without their variable fields, and signatures (APPNOTE 4.3.7-16).
constexpr std::size_t local_header_bytes = 30, entry_bytes = 46, end_bytes = 22;
constexpr std::size_t wide_locator_bytes = 20, wide_end_bytes = 56;
constexpr std::string_view local_mark = "PK\3\4", entry_mark = "PK\1\2", end_mark = "PK\5\6";
constexpr std::string_view wide_locator_mark = "PK\6\7", wide_end_mark = "PK\6\6";

constexpr std::size_t longest_comment = 65535;  // bytes, behind the end record
constexpr std::uint64_t most_directory_bytes = std::uint64_t{1} << 30;
constexpr std::size_t zip_step_bytes = std::size_t{1} << 20;  // read between looks for a stop

// Returns the number that `count` bytes from `at` on hold, the lowest first. They must be there.
std::uint64_t zip_number(std::string_view bytes, std::size_t at, std::size_t count) {
    return number_of_bytes(bytes.substr(at, count), false);
}

// Reads an entry of the directory (APPNOTE 4.3.12). `extra`: its extra fields, of which that of
// Zip64 (4.5.3) holds the numbers that 32 bits do not, in this order.
ZipMember member_of_entry(std::string_view entry, std::string_view name, std::string_view extra) {
    constexpr std::uint64_t in_extra_field = 0xffffffff, wide_field = 1;
    ZipMember member;
    member.name = name;
    member.is_encrypted = (zip_number(entry, 8, 2) & 1) != 0;
    member.method = static_cast<std::uint16_t>(zip_number(entry, 10, 2));
    member.crc = static_cast<std::uint32_t>(zip_number(entry, 16, 4));
    member.stored_bytes = zip_number(entry, 20, 4);
    member.bytes = zip_number(entry, 24, 4);
    member.header = zip_number(entry, 42, 4);
    while (extra.size() >= 4) {
        const std::size_t length = std::min<std::size_t>(zip_number(extra, 2, 2), extra.size() - 4);
        std::string_view field = extra.substr(4, length);
        if (zip_number(extra, 0, 2) == wide_field) {
            for (std::uint64_t* number : {&member.bytes, &member.stored_bytes, &member.header}) {
                if (*number != in_extra_field || field.size() < 8) continue;
                *number = zip_number(field, 0, 8);
                field.remove_prefix(8);
            }
        }
        extra.remove_prefix(4 + length);
    }
    return member;
}

}  // namespace

bool has_zip_mark(const std::filesystem::path& path) {
    const std::string mark = file_beginning(path, local_mark.size());
    return mark == local_mark || mark == end_mark;  // the latter: an archive without members
}

ZipArchive::ZipArchive(const std::filesystem::path& path) : name_(path.string()), file_(path) {
    read_members(find_directory());
}

const ZipMember* ZipArchive::find(std::string_view name) const {
    const auto found = members_.find(name);
    return found == members_.end() ? nullptr : &found->second;
}

ByteBuffer ZipArchive::read(const ZipMember& member) const {
    const std::uint64_t begin = place_of(member);
    ByteBuffer contents(member.bytes);
    if (!member.is_stored()) inflate(member, contents, true);
    uLong crc = 0;
    for (std::size_t done = 0, step = 0; done < contents.size(); done += step) {
        check_interrupt();
        step = std::min(contents.size() - done, zip_step_bytes);
        char* const to = contents.data() + done;
        if (member.is_stored()) file_.read(begin + done, to, step);
        crc = crc32_z(crc, reinterpret_cast<const Bytef*>(to), step);
    }
    if (crc != member.crc) {
        fail("{}: {}: damaged: its CRC is {:08x}, the directory says {:08x}", name_,
             one_line(member.name), crc, member.crc);
    }
    return contents;
}

ByteBuffer ZipArchive::read_beginning(const ZipMember& member, std::size_t most) const {
    const std::uint64_t begin = place_of(member);
    ByteBuffer contents(std::min<std::uint64_t>(member.bytes, most));
    if (member.is_stored())
        file_.read(begin, contents.data(), contents.size());
    else
        inflate(member, contents, false);
    return contents;
}

std::uint64_t ZipArchive::place_of(const ZipMember& member) const {
    const std::string name = name_ + ": " + one_line(member.name);
    if (member.is_encrypted) fail("{}: encrypted, expected a member without a password", name);
    constexpr std::uint16_t deflated = 8;
    if (!member.is_stored() && member.method != deflated) {
        fail("{}: compressed by ZIP's method {}, expected 0 (stored) or 8 (deflated)", name,
             member.method);
    }
    const std::string header = bytes_at(member.header, local_header_bytes);
    if (!header.starts_with(local_mark)) fail("{}: damaged: it is not at its place", name);
    const std::uint64_t begin =
        member.header + local_header_bytes + zip_number(header, 26, 2) + zip_number(header, 28, 2);
    if (begin > directory_begin_ || member.stored_bytes > directory_begin_ - begin)
        fail("{}: damaged: found {} bytes, which reach too far", name, member.stored_bytes);
    if (member.is_stored() ? member.bytes != member.stored_bytes
                           : member.bytes / gzip_expansion > member.stored_bytes) {
        fail("{}: damaged: its {} bytes cannot hold the {} that the directory says", name,
             member.stored_bytes, member.bytes);
    }
    return begin;
}

// Decompresses a member to `contents`, which it fills. `all`: the contents must end there.
void ZipArchive::inflate(const ZipMember& member, ByteBuffer& contents, bool all) const {
    z_stream state{};
    constexpr int raw_window = -15;  // zlib.h, inflateInit2: no header, no checksum
    if (inflateInit2(&state, raw_window) != Z_OK) throw std::bad_alloc();
    const std::unique_ptr<z_stream, int (*)(z_stream*)> ends(&state, &inflateEnd);
    std::vector<char> input(std::min<std::uint64_t>(member.stored_bytes, zip_step_bytes));
    std::uint64_t at = place_of(member);
    const std::uint64_t end = at + member.stored_bytes;
    std::size_t done = 0;
    Bytef beyond = 0;  // contents that go on are noticed by a byte more
    for (int result = Z_OK; result != Z_STREAM_END && (all || done < contents.size());) {
        check_interrupt();
        if (state.avail_in == 0) {
            const std::size_t count = std::min<std::uint64_t>(input.size(), end - at);
            file_.read(at, input.data(), count);
            at += count;
            state.next_in = reinterpret_cast<Bytef*>(input.data());
            state.avail_in = static_cast<uInt>(count);
        }
        const std::size_t step = std::min(contents.size() - done, zip_step_bytes);
        state.next_out = step > 0 ? reinterpret_cast<Bytef*>(contents.data() + done) : &beyond;
        const uInt room = step > 0 ? static_cast<uInt>(step) : 1;
        state.avail_out = room;
        result = ::inflate(&state, Z_NO_FLUSH);
        done += room - state.avail_out;
        if (result == Z_MEM_ERROR) throw std::bad_alloc();
        if ((result != Z_OK && result != Z_STREAM_END) || done > contents.size()) break;
    }
    if (done != contents.size()) {
        fail("{}: {}: damaged deflate data: found {} bytes{}, the directory says {}", name_,
             one_line(member.name), done, done > contents.size() ? " or more" : "", member.bytes);
    }
}

void ZipArchive::fail_as_damaged(std::string_view what) const {
    fail("{}: damaged or truncated ZIP archive: {}", name_, what);
}

std::string ZipArchive::bytes_at(std::uint64_t begin, std::size_t count) const {
    if (begin > file_.size() || count > file_.size() - begin)
        fail_as_damaged("the file ends too early");
    std::string bytes(count, '\0');
    file_.read(begin, bytes.data(), count);
    return bytes;
}

// Looks for the end record, behind which only a comment lies (APPNOTE 4.3.16).
ZipArchive::Directory ZipArchive::find_directory() const {
    const std::uint64_t size = file_.size();
    const std::size_t searched = std::min<std::uint64_t>(size, end_bytes + longest_comment);
    const std::string tail = bytes_at(size - searched, searched);
    std::size_t at = tail.rfind(end_mark);
    while (at != tail.npos &&
           (searched - at < end_bytes || searched - at != end_bytes + zip_number(tail, at + 20, 2)))
        at = at == 0 ? tail.npos : tail.rfind(end_mark, at - 1);
    if (at == tail.npos) fail_as_damaged("its directory is missing at the end");
    const std::uint64_t place = size - searched + at;
    if (place >= wide_locator_bytes && bytes_at(place - wide_locator_bytes, 4) == wide_locator_mark)
        return wide_directory(place - wide_locator_bytes);
    if (zip_number(tail, at + 4, 4) != 0)
        fail("{}: found a part of a ZIP archive, expected all of it in one file", name_);
    const std::uint64_t bytes = zip_number(tail, at + 12, 4);
    return {place - std::min(place, bytes), place, zip_number(tail, at + 16, 4)};
}

// Reads the end record of Zip64 (APPNOTE 4.3.14), which lies before its locator.
ZipArchive::Directory ZipArchive::wide_directory(std::uint64_t locator) const {
    const std::uint64_t place = locator - std::min<std::uint64_t>(locator, wide_end_bytes);
    const std::string end = bytes_at(place, wide_end_bytes);
    if (!end.starts_with(wide_end_mark)) fail_as_damaged("the end record of Zip64 is missing");
    if (zip_number(end, 16, 8) != 0)
        fail("{}: found a part of a ZIP archive, expected all of it in one file", name_);
    return {place - std::min(place, zip_number(end, 40, 8)), place, zip_number(end, 48, 8)};
}

void ZipArchive::read_members(const Directory& directory) {
    if (directory.counted_begin > directory.begin) fail_as_damaged("its directory is cut off");
    const std::uint64_t before = directory.begin - directory.counted_begin;
    const std::uint64_t bytes = directory.end - directory.begin;
    if (bytes > most_directory_bytes) {
        fail("{}: found a directory of {} bytes, expected at most {}", name_, bytes,
             most_directory_bytes);
    }
    directory_begin_ = directory.begin;
    const std::string entries = bytes_at(directory.begin, bytes);
    for (std::string_view rest = entries; !rest.empty();) {
        if (!rest.starts_with(entry_mark) || rest.size() < entry_bytes)
            fail_as_damaged("its directory has a wrong entry");
        const std::size_t name = zip_number(rest, 28, 2), extra = zip_number(rest, 30, 2);
        const std::size_t whole = entry_bytes + name + extra + zip_number(rest, 32, 2);
        if (whole > rest.size()) fail_as_damaged("its directory has a wrong entry");
        ZipMember member = member_of_entry(rest, rest.substr(entry_bytes, name),
                                           rest.substr(entry_bytes + name, extra));
        member.header += before;  // if the sum overflows, it is a wrong place, too
        members_.insert_or_assign(member.name, std::move(member));
        rest.remove_prefix(whole);
    }
}

}  // namespace lamina
