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

// The state of a file at one time, such as when it was opened.
struct FileState {
    // Throws Error if there is no such file.
    static FileState of(const std::filesystem::path& path);

    // Throws Error if the file now has another size or time.
    void check_unchanged() const;
    std::string text() const;        // identifies the file and its state
    std::string bytes_hash() const;  // hash of some of its bytes, as they are now; throws Error

    std::filesystem::path path;
    std::uint64_t bytes = 0;
    std::int64_t modified = 0;  // nanoseconds
    // These tell a file from a copy with the same size and time. Moving a file, or changing its
    // mode, changes `changed`: check_unchanged() still passes, but text() differs.
    std::uint64_t inode = 0;
    std::int64_t changed = 0;  // nanoseconds
};

// Samples that lie in files uncompressed, and in the type in which they are drawn.
class FileSource : public SampleSource {
  public:
    // Tells if this class can read the data: if they are raw, and of a type that is drawn as it is.
    static bool can_read(const StoredData& data);

    // `size`: samples of the volume along the three axes of the data that are read in full. Checks
    // the data as read_stored() does, and warns as say_taken() does.
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
    // Returns the byte at which a sample begins in the data of all files, one after another.
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
    // The open file if there is one only; several are opened anew for each read.
    std::unique_ptr<RandomAccessFile> only_file_;
    std::uint64_t bytes_each_;  // of data in each file
    std::array<std::int64_t, 3> size_;
    std::size_t bytes_;                    // of a sample
    std::uint64_t first_ = 0;              // byte of the data with the volume's first sample
    std::array<std::uint64_t, 3> step_{};  // bytes between neighbours along x, y, z
    bool swap_;
    std::vector<Extent> extents_;  // the data of the only file; empty: it is a hole
    bool mostly_holes_ = false;
};

// Samples of compressed data, which can be read only once and in order, in boxes of whole slices.
class StreamSource : public SampleSource {
  public:
    // Tells if the data are compressed, and of a type that is drawn as it is.
    static bool can_read(const StoredData& data);

    // Takes `size`, checks the data and warns as FileSource does.
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
    std::vector<StoredAxis> inner_, outer_;  // the axes up to z, and the slower ones
    std::unique_ptr<ByteReader> bytes_;
    mutable std::int64_t next_ = 0;  // slice that is read next
};

// Samples in chunks, each decoded as a whole. Recently used ones stay decoded in memory.
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
    // A decoded chunk, or one that a thread decodes now. `used`: clock_ at its last use.
    struct Kept {
        std::once_flag once;
        ByteBuffer samples;
        std::int64_t used = 0;
    };

    // Decodes the samples of a chunk that lie in the volume, which are those of `box`, in the order
    // of read(). Chunks are counted along x, then y, then z. Called from several threads.
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
