// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "base/byte_buffer.h"
#include "volume/sample_source.h"
#include "volume_files/file_state.h"
#include "volume_files/zarr_chunks.h"

namespace lamina {

// Samples in the chunks of a Zarr array. The chunks that were used last stay decoded.
class ZarrSource : public SampleSource {
  public:
    explicit ZarrSource(ZarrChunks chunks);

    void read(const SampleBox& box, void* to) const override;
    std::array<std::int64_t, 3> block() const override;
    std::uint64_t memory() const override;
    bool known_as_zero(const SampleBox& box) const override;
    void check_unchanged() const override { header_.check_unchanged(); }
    std::filesystem::path main_file() const override { return chunks_.array().folder; }
    std::string name() const override;
    std::string identity() const override;

  private:
    struct Kept {
        std::once_flag once;
        ByteBuffer samples;
        std::int64_t used = 0;
    };

    // Calls visit(number) for the chunks that a box touches.
    template <typename Visit>
    void for_each_chunk(const SampleBox& box, const Visit& visit) const;
    std::shared_ptr<Kept> kept(std::int64_t chunk) const;

    ZarrChunks chunks_;
    FileState header_;
    mutable std::mutex access_;
    mutable std::map<std::int64_t, std::shared_ptr<Kept>> decoded_;
    mutable std::int64_t clock_ = 0;
};

}  // namespace lamina
