// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "base/input_file.h"
#include "volume/sample_source.h"

namespace lamina {

// Samples in chunks of which each is decoded as a whole. Those that were used last stay decoded.
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

    // What a chunk has of the volume, as read() gives it. Chunks are counted along x, then y, then
    // z. Called from several threads.
    virtual void decode(std::int64_t chunk, const SampleBox& box, void* to) const = 0;
    // Whether all samples of a chunk are 0, as far as that is known without decoding it.
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
