// SPDX-License-Identifier: Apache-2.0
#include "volume_files/file_source.h"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "volume_files/some_bytes.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// Rows are read with what lies between them where they begin at most so far from each other, or so
// many times as far as they are long: a call of the system takes as long as to copy as much.
constexpr std::uint64_t most_between_bytes = 4096, most_between_rows = 8;
constexpr std::size_t most_extents = 1 << 20;
// A disk reads on over so many bytes rather than to begin anew.
constexpr std::uint64_t most_skipped = 1 << 20;
// Short reads leave a disk waiting between them. So many follow each other in the file's order.
constexpr std::uint64_t read_at_once = 1 << 21;
constexpr std::size_t pieces_together = 32;
// Shorter holes are read with the data around them.
constexpr std::uint64_t shortest_hole = 1 << 15;

}  // namespace

bool FileSource::can_read(const StoredData& data) {
    const auto axes = std::ranges::count_if(
        data.axes, [](const StoredAxis& axis) { return !axis.taken.has_value(); });
    return data.encoding == DataEncoding::raw && axes == 3 && drawn_type(data.type) &&
           !data.is_scaled();
}

FileSource::FileSource(const StoredData& data, const std::array<std::int64_t, 3>& size)
    : offsets_(raw_data_offsets(data)),
      bytes_each_(stored_bytes(data.path.string(), data.axes, bytes_of(data.type)) /
                  data.files.size()),
      size_(size),
      bytes_(bytes_of(data.type)),
      swap_(data.swap_bytes) {
    say_taken(data.path.string(), data.axes);
    std::uint64_t step = bytes_;
    std::size_t axis = 0;
    for (const StoredAxis& stored : data.axes) {
        if (stored.taken)
            first_ += step * static_cast<std::uint64_t>(*stored.taken);
        else
            step_[axis++] = step;
        step *= static_cast<std::uint64_t>(stored.size);
    }
    for (const std::filesystem::path& path : data.files) files_.push_back(FileState::of(path));
    if (files_.size() > 1) return;
    only_file_ = std::make_unique<RandomAccessFile>(files_[0].path);
    find_extents();
}

// Where a file system does not know of holes, all is data.
void FileSource::find_extents() {
    const int file = open(files_[0].path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    const auto size = static_cast<off_t>(files_[0].bytes);
    for (off_t at = 0; at < size && extents_.size() < most_extents;) {
        const off_t begin = lseek(file, at, SEEK_DATA);
        if (begin < 0 && errno != ENXIO) break;
        if (begin < 0) {
            at = size;
            break;
        }
        const off_t end = std::max(lseek(file, begin, SEEK_HOLE), begin + 1);
        extents_.push_back({static_cast<std::uint64_t>(begin), static_cast<std::uint64_t>(end)});
        at = end;
    }
    close(file);
    const bool whole =
        extents_.size() == 1 && extents_[0].begin == 0 && extents_[0].end >= files_[0].bytes;
    const bool known = extents_.size() < most_extents;
    if (!known || whole) extents_ = {{0, files_[0].bytes}};
    std::uint64_t data = 0;
    for (const Extent& extent : extents_) data += extent.end - extent.begin;
    mostly_holes_ = data < files_[0].bytes / 2;
    // A system that reads on by itself would fill its cache with holes.
    if (mostly_holes_) only_file_->expect_single_reads();
}

bool FileSource::known_as_zero(const SampleBox& box) const {
    if (!only_file_) return false;
    const auto holds_data = [&](std::uint64_t begin, std::uint64_t end) {
        const auto next = std::ranges::upper_bound(extents_, begin, {}, &Extent::end);
        return next != extents_.end() && next->begin < end;
    };
    const auto place = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
        return static_cast<std::uint64_t>(offsets_[0]) + place_of(x, y, z);
    };
    const auto [x, y, z] = box.first;
    const auto [nx, ny, nz] = box.size;
    if (!holds_data(place(x, y, z), place(x + nx - 1, y + ny - 1, z + nz - 1) + bytes_))
        return true;
    for (std::int64_t k = z; k < z + nz; ++k) {
        if (!holds_data(place(x, y, k), place(x + nx - 1, y + ny - 1, k) + bytes_)) continue;
        for (std::int64_t j = y; j < y + ny; ++j)
            if (holds_data(place(x, j, k), place(x + nx - 1, j, k) + bytes_)) return false;
    }
    return true;
}

// `place`: in the data of all files, one after the other.
void FileSource::read_bytes(std::uint64_t place, char* to, std::size_t count) const {
    while (count > 0) {
        const std::uint64_t number = place / bytes_each_, within = place % bytes_each_;
        const auto here =
            static_cast<std::size_t>(std::min<std::uint64_t>(count, bytes_each_ - within));
        const std::uint64_t begin = static_cast<std::uint64_t>(offsets_[number]) + within;
        if (only_file_)
            only_file_->read(begin, to, here);
        else
            RandomAccessFile(files_[number].path).read(begin, to, here);
        place += here;
        to += here;
        count -= here;
    }
}

// Rows y .. y + rows - 1 of the box, with what lies between them.
void FileSource::read_rows(const SampleBox& box, std::int64_t y, std::int64_t z, std::int64_t rows,
                           char* to) const {
    const std::uint64_t begin = place_of(box.first[0], y, z);
    const auto along = static_cast<std::uint64_t>(box.size[0] - 1) * step_[0] + bytes_;
    const std::uint64_t span = static_cast<std::uint64_t>(rows - 1) * step_[1] + along;
    const std::size_t row_bytes = static_cast<std::size_t>(box.size[0]) * bytes_;
    if (span == row_bytes * static_cast<std::uint64_t>(rows))
        return read_bytes(begin, to, static_cast<std::size_t>(span));
    const auto bytes = std::make_unique_for_overwrite<char[]>(static_cast<std::size_t>(span));
    read_bytes(begin, bytes.get(), static_cast<std::size_t>(span));
    for (std::int64_t row = 0; row < rows; ++row) {
        const char* from = bytes.get() + static_cast<std::uint64_t>(row) * step_[1];
        if (step_[0] == bytes_) {
            std::memcpy(to, from, row_bytes);
            to += row_bytes;
            continue;
        }
        for (std::int64_t x = 0; x < box.size[0]; ++x, from += step_[0], to += bytes_)
            std::memcpy(to, from, bytes_);
    }
}

// How many rows of a box are read at once, with what lies between them.
std::int64_t FileSource::rows_together(const SampleBox& box) const {
    const std::uint64_t row_bytes = static_cast<std::uint64_t>(box.size[0]) * bytes_;
    const bool together = step_[1] <= std::max(most_between_bytes, most_between_rows * row_bytes);
    return together ? box.size[1] : 1;
}

void FileSource::read(const SampleBox& box, void* to) const {
    auto* at = static_cast<char*>(to);
    const std::size_t row_bytes = static_cast<std::size_t>(box.size[0]) * bytes_;
    if (!extents_.empty() && known_as_zero(box)) {
        std::memset(at, 0, row_bytes * static_cast<std::size_t>(box.size[1] * box.size[2]));
        return;
    }
    const std::int64_t rows = rows_together(box);
    for (std::int64_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
        for (std::int64_t y = box.first[1]; y < box.first[1] + box.size[1]; y += rows) {
            read_rows(box, y, z, rows, at);
            at += row_bytes * static_cast<std::size_t>(rows);
        }
    }
    if (swap_) swap_bytes_alone(to, box.count(), bytes_);
}

// Extents in ascending order of their beginnings, as one where at most so many bytes lie between.
std::vector<FileSource::Extent> FileSource::joined(std::span<const Extent> extents,
                                                   std::uint64_t between) {
    std::vector<Extent> all;
    for (const Extent& extent : extents) {
        if (all.empty() || extent.begin > all.back().end + between)
            all.push_back(extent);
        else
            all.back().end = std::max(all.back().end, extent.end);
    }
    return all;
}

// The data in a part of the file, without its holes.
std::vector<FileSource::Extent> FileSource::data_in(const Extent& part) const {
    std::vector<Extent> found;
    for (auto next = std::ranges::upper_bound(extents_, part.begin, {}, &Extent::end);
         next != extents_.end() && next->begin < part.end; ++next)
        found.push_back({std::max(next->begin, part.begin), std::min(next->end, part.end)});
    return joined(found, shortest_hole);
}

void FileSource::will_read(std::span<const SampleBox> boxes) const {
    if (!only_file_) return;
    // More would be gone from the cache before it is read.
    const std::uint64_t most_bytes = machine_memory() / 2;
    const auto offset = static_cast<std::uint64_t>(offsets_[0]);
    std::vector<Extent> extents;
    for (const SampleBox& box : boxes) {
        if (extents.size() > most_extents) return;
        const std::int64_t rows = step_[1] <= most_skipped ? box.size[1] : 1;
        const std::int64_t last_x = box.first[0] + box.size[0] - 1;
        for (std::int64_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
            for (std::int64_t y = box.first[1]; y < box.first[1] + box.size[1]; y += rows)
                extents.push_back({offset + place_of(box.first[0], y, z),
                                   offset + place_of(last_x, y + rows - 1, z) + bytes_});
        }
    }
    std::ranges::sort(extents, {}, &Extent::begin);
    std::vector<Extent> pieces;
    std::uint64_t bytes = 0;
    for (const Extent& extent : joined(extents, most_skipped)) {
        for (const Extent& data : data_in(extent)) {
            bytes += data.end - data.begin;
            for (std::uint64_t at = data.begin; at < data.end; at += read_at_once)
                pieces.push_back({at, std::min(at + read_at_once, data.end)});
        }
    }
    if (bytes > most_bytes) return;
    const std::size_t parts = (pieces.size() + pieces_together - 1) / pieces_together;
    Progress progress("reading ahead", static_cast<std::int64_t>(parts));
    parallel_for(static_cast<std::int64_t>(parts), 1, [&](std::int64_t part) {
        const RandomAccessFile file(files_[0].path);  // each has a place in it of its own
        mostly_holes_ ? file.expect_single_reads() : file.expect_in_order();
        const auto some = std::make_unique_for_overwrite<char[]>(read_at_once);
        const std::size_t first = static_cast<std::size_t>(part) * pieces_together;
        for (std::size_t i = first; i < std::min(first + pieces_together, pieces.size()); ++i)
            file.read_some(pieces[i].begin, some.get(), pieces[i].end - pieces[i].begin);
        progress.advance();
    });
}

void FileSource::check_unchanged() const {
    for (const FileState& file : files_) file.check_unchanged();
}

std::string FileSource::name() const {
    ContentHash files;
    for (const FileState& file : files_) files.add(std::filesystem::absolute(file.path).string());
    return fmt::format("{} {} {} {} {} {} {}", files.hex(), fmt::join(size_, " "),
                       fmt::join(step_, " "), offsets_[0], first_, bytes_, swap_);
}

std::string FileSource::identity() const {
    ContentHash hash;
    hash.add(name());
    for (const FileState& file : files_) hash.add(file.text());
    add_some_bytes(
        hash, bytes_each_ * files_.size(),
        [&](std::uint64_t place, char* to, std::size_t count) { read_bytes(place, to, count); });
    return hash.hex();
}

}  // namespace lamina
