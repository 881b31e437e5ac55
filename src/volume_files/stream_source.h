// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/sample_source.h"
#include "volume_files/byte_reader.h"
#include "volume_files/file_state.h"
#include "volume_files/stored_data.h"
#include "volume_files/stored_reader.h"

namespace lamina {

// Samples of packed data, which can be read once: whole slices, one after the other.
class StreamSource : public SampleSource {
  public:
    // Whether the data can be read so: packed, and of a type that is drawn as it is.
    static bool can_read(const StoredData& data);

    // `size`: of the volume, whose three axes are those of the data that are taken as a whole.
    // Checks as read_stored() does, and warns of what was taken untold.
    StreamSource(const StoredData& data, const std::array<std::int64_t, 3>& size);

    // Boxes of whole slices, of which the first is the one after those of the box before.
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

}  // namespace lamina
