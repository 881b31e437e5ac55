// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/enum_words.h"
#include "lamina/volume.h"
#include "plan/plan.h"
#include "slicing/gradient_map.h"
#include "slicing/tile_pages.h"
#include "volume/min_max_bricks.h"
#include "volume/volume_store.h"

namespace lamina {

// Ways in which the samples of a brick are stored.
enum class TileLayout {
    bytes,   // uint8 as in the volume
    words,   // int16 or uint16 as in the volume
    floats,  // normalised to the volume's range; NaN if not finite
};

// Returns the bytes from one element to the next.
constexpr std::size_t bytes_of_sample(TileLayout layout) {
    switch (layout) {
        case TileLayout::bytes:
            return 1;
        case TileLayout::words:
            return 2;
        case TileLayout::floats:
            return 4;
    }
    unreachable_enum();
}

// A brick in the form that vectors address: with 32-bit indices, x fastest.
struct TileBrick {
    TileLayout layout = TileLayout::bytes;
    const void* samples = nullptr;
    std::int32_t row = 0, slice = 0;  // elements to the next y and z; 0 on an axis with one sample
    std::int32_t last_word = 0;  // for bytes and words: offset of the last whole 32 bits, in bytes
    std::uint32_t flip = 0;      // bits to invert, which turn int16 into uint16 from 0 on
    std::array<float, 3> last_sample{};  // size minus one
    // Normalised scalar = interpolated code * scale + offset. Textures interpolate code * unit
    // instead; then it is interpolated value * unit_scale + offset.
    float scale = 1, offset = 0, unit = 1, unit_scale = 1;
    const StoredGradient* gradients = nullptr;  // for lit volumes (slicing/gradient_map.h)
    // Set if the samples, and the gradients, are not all in memory: then indices are those of
    // pages, and the pointers above are null.
    const TilePages* pages = nullptr;
};

// The bricks of a plan. They may refer to the volume's own samples, which are kept alive. Those of
// a volume that stays in its files are pages.
class TileVolume {
  public:
    // `range`: the scalars that become [0, 1]; lo < hi.
    TileVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

    // Tells whether it equals what the constructor would make from these arguments.
    bool serves(const Volume& volume, const ValueRange& range, const SlicePlan& plan) const;

    const std::vector<TileBrick>& bricks() const { return bricks_; }
    // Returns the pages of a volume that is not in memory, or null.
    BrickCache* pages() const { return cache_; }
    // Announces pages that are read soon, ascending (SampleSource::will_read()); each is announced
    // to the source once.
    void will_read(std::span<const std::uint32_t> pages) const;
    // Returns the sample of the volume, on each axis, with which the first page begins: -1 if
    // bricks have a border.
    const std::array<std::int64_t, 3>& first_of_pages() const { return parts_.front().first; }
    // Throws Error if the files of a volume that stays in them have changed.
    void check_unchanged() const { lamina::check_unchanged(volume_); }
    std::int64_t byte_count() const;  // memory beside the volume's own

  private:
    void copy_brick(const TextureBrick& part, TileBrick& brick);
    void refer_to_volume(TileBrick& brick);
    void page();
    void make_own_pages();
    void fill_own_pages(std::span<const BrickCache::Wanted> wanted) const;
    template <typename Sample>
    void set_page_samples(const SampleWindow<Sample>& window,
                          const std::array<std::int64_t, 3>& first, std::byte* to) const;
    TilePages pages_of(const TextureBrick& part) const;
    void share_memory(BrickCache& cache) const;
    void normalise(const ValueRange& range, TileBrick& brick) const;

    Volume volume_;
    ValueRange range_;
    std::vector<TextureBrick> parts_;
    bool float_texture_;
    bool lit_;
    std::vector<std::shared_ptr<void>> copies_;
    std::int64_t copied_bytes_ = 0;
    std::vector<std::vector<StoredGradient>> gradients_;  // if the plan is lit
    std::vector<TileBrick> bricks_;
    // The pages of a volume that is not in memory: the store's own bricks if they have the right
    // form.
    std::unique_ptr<BrickCache> own_cache_;
    BrickCache* cache_ = nullptr;
    std::vector<TilePages> pages_;
    mutable std::vector<std::uint8_t> told_;  // 1: pages that will_read() has announced
};

}  // namespace lamina
