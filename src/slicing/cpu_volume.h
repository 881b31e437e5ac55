// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "base/enum_words.h"
#include "facts/volume_facts.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "slicing/gradient_map.h"
#include "volume/brick_cache.h"
#include "volume/min_max_bricks.h"
#include "volume/volume_store.h"

namespace lamina {

// A brick of a plan whose samples are the bricks of a cache that are in memory. Here "page" is a
// brick of the cache: BrickCache::edge^3 cells.
struct CpuPages {
    // Bits of a cell's index: the number of its page in the plan's brick, and its place in the
    // page. From the highest bits on: page, z, y, x.
    static constexpr int place_bits = static_cast<int>(BrickCache::shift);
    static constexpr int page_bits = 3 * place_bits;  // bits below the page's number
    static constexpr std::uint32_t places = (1u << place_bits) - 1;

    const BrickCache* cache = nullptr;
    std::array<std::int32_t, 3> offset{};  // place of the first sample in its page
    std::int32_t row = 1, slice = 1;       // pages to the next y and z
    std::vector<std::uint32_t> numbers;    // of the pages in the cache, x fastest
    std::size_t gradients_at = 0;          // bytes from a page's begin to its gradients

    std::uint32_t number_of(std::int32_t index) const {
        return numbers[static_cast<std::uint32_t>(index) >> page_bits];
    }
    // Returns the cell's lowest corner in its page, in samples.
    static std::size_t place_of(std::int32_t index) {
        const auto bits = static_cast<std::uint32_t>(index);
        constexpr auto row_step = static_cast<std::uint32_t>(BrickCache::row);
        constexpr auto slice_step = static_cast<std::uint32_t>(BrickCache::slice);
        return (bits >> 2 * place_bits & places) * slice_step +
               (bits >> place_bits & places) * row_step + (bits & places);
    }
};

// Ways in which the samples of a brick are stored, and the bytes from one to the next.
enum class CpuLayout {
    bytes = 1,   // uint8 as in the volume
    words = 2,   // int16 or uint16 as in the volume
    floats = 4,  // normalised to the volume's range; NaN if not finite
};

constexpr std::size_t bytes_of_sample(CpuLayout layout) {
    return static_cast<std::size_t>(layout);
}

// A brick in the form that vectors address: with 32-bit indices, x fastest.
struct CpuBrick {
    CpuLayout layout = CpuLayout::bytes;
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
    const CpuPages* pages = nullptr;
};

// The bricks of a plan. They may refer to the volume's own samples, which are kept alive. Those of
// a volume that stays in its files are pages.
class CpuVolume {
  public:
    // `range`: the scalars that become [0, 1]; lo < hi.
    CpuVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

    // Tells whether it equals what the constructor would make from these arguments.
    bool serves(const Volume& volume, const ValueRange& range, const SlicePlan& plan) const;

    const std::vector<CpuBrick>& bricks() const { return bricks_; }
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
    void copy_brick(const TextureBrick& part, CpuBrick& brick);
    void page();
    void make_own_pages();
    void fill_own_pages(std::span<const BrickCache::Wanted> wanted) const;
    template <typename Sample>
    void set_page_samples(const SampleWindow<Sample>& window,
                          const std::array<std::int64_t, 3>& first, std::byte* to) const;
    CpuPages pages_of(const TextureBrick& part) const;
    void share_memory(BrickCache& cache) const;
    void normalise(const ValueRange& range, CpuBrick& brick) const;

    Volume volume_;
    ValueRange range_;
    std::vector<TextureBrick> parts_;
    bool float_texture_;
    bool lit_;
    std::vector<std::shared_ptr<void>> copies_;
    std::int64_t copied_bytes_ = 0;
    std::vector<std::vector<StoredGradient>> gradients_;  // if the plan is lit
    std::vector<CpuBrick> bricks_;
    // The pages of a volume that is not in memory: the store's own bricks if they have the right
    // form.
    std::unique_ptr<BrickCache> own_cache_;
    BrickCache* cache_ = nullptr;
    std::vector<CpuPages> pages_;
    mutable std::vector<std::uint8_t> told_;  // 1: pages that will_read() has announced
};

// Returns the numbers of the pages of a volume with cells in visible bricks, ascending. `share`:
// only bricks that touch this box count (SlicePlan::share).
std::vector<std::uint32_t> pages_shown(const CpuVolume& volume, const OccupiedBricks& occupied,
                                       const std::optional<IndexBox>& share);

// Returns those of `pages` that may be in the view. `count`: pages along each axis; `first`: the
// volume's sample with which the first begins.
std::vector<std::uint32_t> pages_seen(const std::vector<std::uint32_t>& pages,
                                      const std::array<std::int64_t, 3>& count,
                                      const std::array<std::int64_t, 3>& first, const Grid& grid,
                                      const View& view);

}  // namespace lamina
