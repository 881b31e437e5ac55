// SPDX-License-Identifier: Apache-2.0
#include "volume_files/sample_sources.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "volume/brick_cache.h"

namespace lamina {
namespace {

using Triple = std::array<std::int64_t, 3>;

// Adds 64 pieces of 4096 bytes, spread evenly over `all` bytes, to a hash, which so notices most
// changes of contents. read(place, to, count) reads `count` bytes from byte `place` on.
template <typename Read>
void add_some_bytes(ContentHash& hash, std::uint64_t all, const Read& read) {
    constexpr std::uint64_t places = 64, bytes_each = 4096;
    char bytes[bytes_each];
    for (std::uint64_t i = 0; i < places; ++i) {
        check_interrupt();
        const std::uint64_t place = all / places * i;
        const auto count =
            static_cast<std::size_t>(std::min<std::uint64_t>(bytes_each, all - place));
        read(place, bytes, count);
        hash.add(bytes, count);
    }
}

// All rows of a box in a slice are read in one call if the distance from one to the next is at most
// most_between_bytes, or most_between_rows times a row's length: a system call costs as much time.
constexpr std::uint64_t most_between_bytes = 4096, most_between_rows = 8;
constexpr std::size_t most_extents = 1 << 20;  // longer lists are not used
// Max gap in bytes that will_read() reads, too: a disk takes longer to go on behind a larger one.
constexpr std::uint64_t most_skipped = 1 << 20;
// Bytes of each read of will_read(), and max reads of a task: a disk would wait between shorter
// ones.
constexpr std::uint64_t read_at_once = 1 << 21;
constexpr std::size_t pieces_together = 32;
// Holes shorter than this are read with the data around them.
constexpr std::uint64_t shortest_hole = 1 << 15;

// Most bytes of decoded chunks that stay in memory, unless bytes_to_keep() demands more.
constexpr std::uint64_t most_kept = std::uint64_t{1} << 26;

// Returns how many bytes of decoded chunks may stay in memory, the max of: an eighth of the memory
// limit, at most most_kept; the chunks that a row of bricks touches, at most a quarter of the
// limit; two chunks for each thread. `count`: chunks along each axis.
std::uint64_t bytes_to_keep(const Triple& edge, const Triple& count, std::uint64_t chunk_bytes) {
    // Chunks that a row of bricks along x touches. A row is read before the next one.
    std::int64_t touched = count[0];
    for (const std::size_t axis : {1, 2})
        touched *= std::min(count[axis], BrickCache::samples / edge[axis] + 2);
    const std::uint64_t limit = memory_limit();
    const std::uint64_t row = static_cast<std::uint64_t>(touched) * chunk_bytes;
    const std::uint64_t fewest = 2 * std::max(1u, std::thread::hardware_concurrency());
    return std::max(
        {std::min(most_kept, limit / 8), std::min(row, limit / 4), fewest * chunk_bytes});
}

// Tells if exactly three axes are read in full, and the samples are drawn as they are.
bool is_drawn_volume(const StoredData& data) {
    const auto axes = std::ranges::count_if(
        data.axes, [](const StoredAxis& axis) { return !axis.taken.has_value(); });
    return axes == 3 && drawn_type(data.type) && !data.is_scaled();
}

}  // namespace

FileState FileState::of(const std::filesystem::path& path) {
    expect_allowed(path);
    struct stat found {};
    if (stat(path.c_str(), &found) != 0)
        fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    const auto nanoseconds = [](const timespec& time) {
        return time.tv_sec * std::int64_t{1'000'000'000} + time.tv_nsec;
    };
    return {path, static_cast<std::uint64_t>(found.st_size), nanoseconds(found.st_mtim),
            static_cast<std::uint64_t>(found.st_ino), nanoseconds(found.st_ctim)};
}

void FileState::check_unchanged() const {
    const FileState now = of(path);
    if (now.bytes != bytes)
        fail("{}: found {} bytes, expected {}: the file was changed while it was read",
             path.string(), now.bytes, bytes);
    if (now.modified != modified) fail("{}: the file was changed while it was read", path.string());
}

std::string FileState::text() const {
    return fmt::format("{} {} {} {} {}", std::filesystem::absolute(path).string(), bytes, modified,
                       inode, changed);
}

std::string FileState::bytes_hash() const {
    const RandomAccessFile file(path);
    ContentHash hash;
    add_some_bytes(hash, file.size(), [&](std::uint64_t place, char* to, std::size_t count) {
        file.read(place, to, count);
    });
    return hash.hex();
}

bool FileSource::can_read(const StoredData& data) {
    return data.encoding == DataEncoding::raw && is_drawn_volume(data);
}

FileSource::FileSource(const StoredData& data, const std::array<std::int64_t, 3>& size)
    : offsets_(StoredReader(data).raw_offsets()),
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

// Finds a sparse file's extents of data: one if the file system does not know of holes.
void FileSource::find_extents() {
    const Extent all{0, files_[0].bytes};
    extents_ = {all};
    const int file = open(files_[0].path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    std::vector<Extent> found;
    bool known = true;  // false if the file system does not tell
    for (off_t at = 0; at < static_cast<off_t>(all.end) && found.size() < most_extents;) {
        const off_t begin = lseek(file, at, SEEK_DATA);
        if (begin < 0) {
            known = errno == ENXIO;  // a hole up to the end
            break;
        }
        at = std::max(lseek(file, begin, SEEK_HOLE), begin + 1);
        found.push_back({static_cast<std::uint64_t>(begin), static_cast<std::uint64_t>(at)});
    }
    close(file);
    if (known && found.size() < most_extents) extents_ = std::move(found);
    std::uint64_t data = 0;
    for (const Extent& extent : extents_) data += extent.end - extent.begin;
    mostly_holes_ = data < files_[0].bytes / 2;
    // The system's own read-ahead would fill its cache with holes.
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

// Reads `count` bytes from byte `place` of the data of all files, one after another.
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

// Reads the rows y .. y + rows - 1 at z of a box in one call, with the bytes between them.
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

// Returns how many rows of a box are read in one call: all of a slice, or one.
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

// Joins extents, in ascending order of their beginnings, that lie at most `between` bytes apart.
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

// Returns the extents with data in an extent. Holes below shortest_hole count as data.
std::vector<FileSource::Extent> FileSource::data_in(const Extent& part) const {
    std::vector<Extent> found;
    for (auto next = std::ranges::upper_bound(extents_, part.begin, {}, &Extent::end);
         next != extents_.end() && next->begin < part.end; ++next)
        found.push_back({std::max(next->begin, part.begin), std::min(next->end, part.end)});
    return joined(found, shortest_hole);
}

void FileSource::will_read(std::span<const SampleBox> boxes) const {
    if (!only_file_) return;
    // If more is read ahead, the first bytes have left the system's cache before they are used.
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
        const RandomAccessFile file(files_[0].path);  // each task has its own read position
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

bool StreamSource::can_read(const StoredData& data) {
    const bool packed = data.encoding == DataEncoding::gzip || data.encoding == DataEncoding::bzip2;
    return packed && is_drawn_volume(data);
}

StreamSource::StreamSource(const StoredData& data, const std::array<std::int64_t, 3>& size)
    : data_(data), reader_(data_), file_(FileState::of(data.files.front())), slices_(size[2]) {
    say_taken(data.path.string(), data.axes);
    const auto last = std::ranges::find_if(data_.axes.rbegin(), data_.axes.rend(),
                                           [](const StoredAxis& axis) { return !axis.taken; });
    inner_.assign(data_.axes.begin(), last.base());
    outer_.assign(last.base(), data_.axes.end());
    bytes_ = reader_.open_all();
    skip_outer(true);
}

// Skips samples on the axes outside of z (channel, time): those before or after the ones read.
void StreamSource::skip_outer(bool is_before) const {
    std::size_t bytes = stored_bytes(data_.path.string(), inner_, bytes_of(data_.type));
    for (const StoredAxis& axis : outer_) {
        const std::int64_t count = is_before ? *axis.taken : axis.size - 1 - *axis.taken;
        bytes_->skip(static_cast<std::size_t>(count) * bytes);
        bytes *= static_cast<std::size_t>(axis.size);
    }
}

void StreamSource::read(const SampleBox& box, void* to) const {
    if (box.first[2] != next_)
        fail("{}: slice {} is read after slice {}", data_.path.string(), box.first[2], next_ - 1);
    std::vector<StoredAxis> axes = inner_;
    axes.back().size = box.size[2];
    read_taken(*bytes_, axes, bytes_of(data_.type), to);
    if (data_.swap_bytes) swap_bytes(to, box.count(), bytes_of(data_.type));
    next_ += box.size[2];
    if (next_ < slices_) return;
    skip_outer(false);
    reader_.warn_of_surplus(*bytes_);
}

ChunkedSource::ChunkedSource(const Triple& size, const Triple& edge, std::size_t sample_bytes)
    : size_(size), edge_(edge), sample_bytes_(sample_bytes), chunk_bytes_(sample_bytes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count_[axis] = (size_[axis] + edge_[axis] - 1) / edge_[axis];
        chunk_bytes_ *= static_cast<std::size_t>(edge_[axis]);
    }
    most_kept_ = bytes_to_keep(edge_, count_, chunk_bytes_);
}

template <typename Visit>
void ChunkedSource::for_each_chunk(const SampleBox& box, const Visit& visit) const {
    std::array<std::int64_t, 3> first{}, last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = box.first[axis] / edge_[axis];
        last[axis] = (box.first[axis] + box.size[axis] - 1) / edge_[axis];
    }
    for (std::int64_t z = first[2]; z <= last[2]; ++z) {
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                SampleBox own{{x * edge_[0], y * edge_[1], z * edge_[2]}, edge_};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    own.size[axis] = std::min(edge_[axis], size_[axis] - own.first[axis]);
                visit((z * count_[1] + y) * count_[0] + x, own);
            }
        }
    }
}

// Returns the chunk's entry, made if need be; may drop the least recently used one for memory.
std::shared_ptr<ChunkedSource::Kept> ChunkedSource::kept(std::int64_t chunk) const {
    const std::lock_guard lock(access_);
    std::shared_ptr<Kept>& found = decoded_[chunk];
    if (!found) found = std::make_shared<Kept>();
    found->used = ++clock_;
    const std::shared_ptr<Kept> result = found;
    if (decoded_.size() * chunk_bytes_ > most_kept_) {
        const auto oldest = std::ranges::min_element(
            decoded_, {}, [](const auto& each) { return each.second->used; });
        decoded_.erase(oldest);
    }
    return result;
}

// Copies the samples of a chunk that lie in a box. `from`: the box of the chunk.
void ChunkedSource::copy_part(const char* chunk, const SampleBox& from, const SampleBox& box,
                              char* to) const {
    std::array<std::int64_t, 3> begin{}, count{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        begin[axis] = std::max(from.first[axis], box.first[axis]);
        count[axis] =
            std::min(from.first[axis] + from.size[axis], box.first[axis] + box.size[axis]) -
            begin[axis];
    }
    const auto place_in = [&](const SampleBox& whole, std::int64_t y, std::int64_t z) {
        return static_cast<std::size_t>(
                   ((z - whole.first[2]) * whole.size[1] + y - whole.first[1]) * whole.size[0] +
                   begin[0] - whole.first[0]) *
               sample_bytes_;
    };
    const std::size_t row_bytes = static_cast<std::size_t>(count[0]) * sample_bytes_;
    for (std::int64_t z = begin[2]; z < begin[2] + count[2]; ++z)
        for (std::int64_t y = begin[1]; y < begin[1] + count[1]; ++y)
            std::memcpy(to + place_in(box, y, z), chunk + place_in(from, y, z), row_bytes);
}

void ChunkedSource::read(const SampleBox& box, void* to) const {
    for_each_chunk(box, [&](std::int64_t chunk, const SampleBox& own) {
        const std::shared_ptr<Kept> one = kept(chunk);
        std::call_once(one->once, [&] {
            ByteBuffer samples(static_cast<std::size_t>(own.count()) * sample_bytes_);
            decode(chunk, own, samples.data());
            one->samples = std::move(samples);
        });
        copy_part(one->samples.data(), own, box, static_cast<char*>(to));
    });
}

bool ChunkedSource::known_as_zero(const SampleBox& box) const {
    bool zero = true;
    for_each_chunk(box,
                   [&](std::int64_t chunk, const SampleBox&) { zero = zero && is_zero(chunk); });
    return zero;
}

}  // namespace lamina
