// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "base/input_file.h"
#include "volume/sample_source.h"
#include "volume_files/file_state.h"
#include "volume_files/stored_data.h"

namespace lamina {

// Samples that lie in files as they are, without compression.
class FileSource : public SampleSource {
  public:
    // Whether the data can be read so: raw, and of a type that is drawn as it is.
    static bool can_read(const StoredData& data);

    // `size`: of the volume, whose three axes are those of the data that are taken as a whole.
    // Checks as read_stored() does, and warns of what was taken untold.
    FileSource(const StoredData& data, const std::array<std::int64_t, 3>& size);

    void read(const SampleBox& box, void* to) const override;
    void will_read(std::span<const SampleBox> boxes) const override;
    bool known_as_zero(const SampleBox& box) const override;
    void check_unchanged() const override;
    std::filesystem::path main_file() const override { return files_[0].path; }
    std::string name() const override;
    std::string identity() const override;

  private:
    // Bytes begin .. end - 1 of a file that hold data; all others are a hole.
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
    std::unique_ptr<RandomAccessFile>
        only_file_;  // where there is one; others are opened each time
    std::uint64_t bytes_each_;
    std::array<std::int64_t, 3> size_;
    std::size_t bytes_;  // of a sample
    std::uint64_t first_ = 0;
    std::array<std::uint64_t, 3> step_{};  // bytes between neighbours
    bool swap_;
    std::vector<Extent> extents_;  // the data of one file
    bool mostly_holes_ = false;
};

}  // namespace lamina
