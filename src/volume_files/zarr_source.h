// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume_files/chunked_source.h"
#include "volume_files/file_state.h"
#include "volume_files/zarr_chunks.h"

namespace lamina {

// Samples in the chunks of a Zarr array.
class ZarrSource : public ChunkedSource {
  public:
    explicit ZarrSource(ZarrChunks chunks);

    void check_unchanged() const override { header_.check_unchanged(); }
    std::filesystem::path main_file() const override { return chunks_.array().folder; }
    std::string name() const override;
    std::string identity() const override;

  private:
    void decode(std::int64_t chunk, const SampleBox& box, void* to) const override;
    bool is_zero(std::int64_t chunk) const override;

    ZarrChunks chunks_;
    FileState header_;
};

}  // namespace lamina
