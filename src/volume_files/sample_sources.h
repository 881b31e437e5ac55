// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "base/input_file.h"
#include "volume/sample_source.h"
#include "volume_files/byte_readers.h"
#include "volume_files/stored_data.h"

namespace lamina {

// A file as it was when it was opened.
struct FileState {
    // Throws Error if there is no such file.
    static FileState of(const std::filesystem::path& path);

    // Throws Error if the file now has another size or time.
    void check_unchanged() const;
    std::string text() const;        // tells it from others, and from what it may become
    std::string bytes_hash() const;  // hash of some of its bytes, as they are now; throws Error

    std::filesystem::path path;
    std::uint64_t bytes = 0;
    std::int64_t modified = 0;  // nanoseconds
    // These tell a file from a copy with its size and time. A file that is moved, or gets another
    // mode, has another `changed`: check_unchanged() passes, text() differs.
    std::uint64_t inode = 0;
    std::int64_t changed = 0;  // nanoseconds
};

// Samples that lie in files as they are, without compression.
class FileSource : public SampleSource {
  public:
    // Tells if the data can be read so: if they are raw, and of a type that is drawn as it is.
    static bool can_read(const StoredData& data);

    // `size`: the volume's, whose three axes are those that are taken as a whole. Checks the data
    // as read_stored() does, and warns of an axis of which the first index is taken though the
    // request names none.
    FileSource(const StoredData& data, const std::array<std::int64_t, 3>& size);

    void read(const SampleBox& box, void* to) const override;
    void will_read(std::span<const SampleBox> boxes) const override;
    bool known_as_zero(const SampleBox& box) const override;
    void check_unchanged() const override;
    std::filesystem::path main_file() const override { return files_[0].path; }
    std::string name() const override;
    std::string identity() const override;

  private:
    // Bytes begin .. end - 1 of a file, which hold data; bytes in no extent are a hole.
    struct Extent {
        std::uint64_t begin, end;
    };

    void find_extents();
    std::uint64_t place_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return first_ + static_cast<std::uint64_t>(x) * step_[0] +
               static_cast<std::uint64_t>(y) * step_[1] + static_cast<std::uint64_t>(z) * step_[2];
    }
    static std::vector<Extent> joined(std::span<const Extent> extents, std::uint64_t between);
    std::vector<Extent> data_in(const Extent& part) const;
    std::int64_t rows_together(const SampleBox& box) const;
    void read_bytes(std::uint64_t place, char* to, std::size_t count) const;
    void read_rows(const SampleBox& box, std::int64_t y, std::int64_t z, std::int64_t rows,
                   char* to) const;

    std::vector<FileState> files_;
    std::vector<std::int64_t> offsets_;
    // Open if there is one file only; several are opened anew for each read.
    std::unique_ptr<RandomAccessFile> only_file_;
    std::uint64_t bytes_each_;
    std::array<std::int64_t, 3> size_;
    std::size_t bytes_;  // a sample's
    std::uint64_t first_ = 0;
    std::array<std::uint64_t, 3> step_{};  // bytes between neighbours
    bool swap_;
    std::vector<Extent> extents_;  // the data of one file
    bool mostly_holes_ = false;
};

// Samples of packed data, which can be read once: whole slices, one after the other.
class StreamSource : public SampleSource {
  public:
    // Tells if the data can be read so: if they are packed, and of a type that is drawn as it is.
    static bool can_read(const StoredData& data);

    // `size`: of the volume, whose three axes are those of the data that are taken as a whole.
    // Checks as read_stored() does, and warns of what was taken untold.
    StreamSource(const StoredData& data, const std::array<std::int64_t, 3>& size);

    // Reads a box of whole slices, the first of which follows the last one of the box before.
    void read(const SampleBox& box, void* to) const override;
    void check_unchanged() const override { file_.check_unchanged(); }
    std::filesystem::path main_file() const override { return data_.path; }
    std::string name() const override { return data_.path.string(); }
    std::string identity() const override { return file_.text(); }

  private:
    void skip_outer(bool is_before) const;

    StoredData data_;
    StoredReader reader_;
    FileState file_;
    std::int64_t slices_;
    std::vector<StoredAxis> inner_, outer_;  // the axes up to z, and those behind it
    std::unique_ptr<ByteReader> bytes_;
    mutable std::int64_t next_ = 0;  // slice
};

// Samples in chunks, each of which is decoded as a whole. The most recently used ones stay decoded.
class ChunkedSource : public SampleSource {
  public:
    void read(const SampleBox& box, void* to) const override;
    std::array<std::int64_t, 3> block() const override { return edge_; }
    std::uint64_t memory() const override { return most_kept_; }
    bool known_as_zero(const SampleBox& box) const override;

  protected:
    // `size`, `edge`: samples of the volume and of a chunk along x, y and z.
    ChunkedSource(const std::array<std::int64_t, 3>& size, const std::array<std::int64_t, 3>& edge,
                  std::size_t sample_bytes);

  private:
    struct Kept {
        std::once_flag once;
        ByteBuffer samples;
        std::int64_t used = 0;
    };

    // Decodes the part of a chunk that lies in the volume, which is `box`, in the order of read().
    // Chunks are counted along x, then y, then z. Called from several threads.
    virtual void decode(std::int64_t chunk, const SampleBox& box, void* to) const = 0;
    // Tells if all samples of a chunk are 0, as far as that is known without decoding it.
    virtual bool is_zero(std::int64_t /*chunk*/) const { return false; }

    // Calls visit(chunk, its box) for the chunks that a box touches.
    template <typename Visit>
    void for_each_chunk(const SampleBox& box, const Visit& visit) const;
    std::shared_ptr<Kept> kept(std::int64_t chunk) const;
    void copy_part(const char* chunk, const SampleBox& from, const SampleBox& box, char* to) const;

    std::array<std::int64_t, 3> size_, edge_, count_{};
    std::size_t sample_bytes_, chunk_bytes_;
    std::uint64_t most_kept_;  // bytes of decoded chunks
    mutable std::mutex access_;
    mutable std::map<std::int64_t, std::shared_ptr<Kept>> decoded_;
    mutable std::int64_t clock_ = 0;
};

}  // namespace lamina
