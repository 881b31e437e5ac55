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

// Three kinds of bricks meet here. TextureBrick, a brick of the plan, is a part of the volume that
// is addressed as one array; CpuBrick is the form that vector code reads. A page is a brick of
// BrickCache, edge^3 cells of a volume on disk. A min/max brick (MinMaxBricks, 4^3 cells) is a
// block whose range of values, and so visibility, is known.
namespace lamina {

// How samples of a CpuBrick on disk are found: in pages of a BrickCache. A cell's index then holds
// the number of its page among those of this brick, and the cell's place in the page.
struct CpuPages {
    // Bits of a cell's index, from the highest on: page, z, y and x in the page.
    static constexpr int place_bits = static_cast<int>(BrickCache::shift);
    static constexpr int page_bits = 3 * place_bits;  // number of bits below those of the page
    // Mask of one coordinate of a place.
    static constexpr std::uint32_t places = (1u << place_bits) - 1;

    const BrickCache* cache = nullptr;
    std::array<std::int32_t, 3> offset{};  // place of the brick's first sample in its page
    std::int32_t row = 1, slice = 1;       // how many pages on the next one along y and z is
    std::vector<std::uint32_t> numbers;    // numbers in the cache of the brick's pages, x fastest
    std::size_t gradients_at = 0;          // bytes from the beginning of a page to its gradients

    // Returns the number in the cache of the page that holds a cell.
    std::uint32_t number_of(std::int32_t index) const {
        return numbers[static_cast<std::uint32_t>(index) >> page_bits];
    }
    // Returns how many samples behind the beginning of its page a cell's lowest corner lies.
    static std::size_t place_of(std::int32_t index) {
        const auto bits = static_cast<std::uint32_t>(index);
        constexpr auto row_step = static_cast<std::uint32_t>(BrickCache::row);
        constexpr auto slice_step = static_cast<std::uint32_t>(BrickCache::slice);
        return (bits >> 2 * place_bits & places) * slice_step +
               (bits >> place_bits & places) * row_step + (bits & places);
    }
};

// Forms in which the samples of a brick are stored. The value is the number of bytes of a sample.
enum class CpuLayout {
    bytes = 1,   // uint8 as in the volume
    words = 2,   // int16 or uint16 as in the volume
    floats = 4,  // normalised to the volume's range; NaN if not finite
};

constexpr std::size_t bytes_of_sample(CpuLayout layout) {
    return static_cast<std::size_t>(layout);
}

// A brick of the plan in the form that vector code reads: samples with 32-bit indices, x fastest.
struct CpuBrick {
    CpuLayout layout = CpuLayout::bytes;
    const void* samples = nullptr;
    std::int32_t row = 0, slice = 0;  // samples to the next y and z; 0 if the axis has one sample
    std::int32_t last_word = 0;  // for bytes and words: offset of the last whole 32 bits, in bytes
    std::uint32_t flip = 0;      // bits to invert, which turn int16 into uint16 from 0 on
    std::array<float, 3> last_sample{};  // size minus one
    bool nearest = false;                // VolumeLookup::nearest: cells are voxels
    // The normalised scalar is interpolated code * scale + offset. Texture units interpolate code *
    // unit instead; from that value it is value * unit_scale + offset.
    float scale = 1, offset = 0, unit = 1, unit_scale = 1;
    const StoredGradient* gradients = nullptr;  // for lit volumes (slicing/gradient_map.h)
    // Set if the volume stays on disk. Then indices are CpuPages', and the pointers above null.
    const CpuPages* pages = nullptr;
};

// The bricks of a plan as CpuBricks. They may point to the volume's samples, which are kept alive.
class CpuVolume {
  public:
    // `range`: the scalars that are normalised to [0, 1]; lo < hi.
    CpuVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan);

    // Tells whether this object can be used in place of a new one made from these arguments.
    bool can_replace(const Volume& volume, const ValueRange& range, const SlicePlan& plan) const;

    const std::vector<CpuBrick>& bricks() const { return bricks_; }
    // Returns the cache that holds the pages of a volume on disk; null if the volume is in memory.
    BrickCache* pages() const { return cache_; }
    // Announces pages (ascending), each only once, to the source: SampleSource::will_read().
    void will_read(std::span<const std::uint32_t> pages) const;
    // Returns the first page's first sample: -1 on each axis if bricks have a border, else 0.
    const std::array<std::int64_t, 3>& first_of_pages() const { return parts_.front().first; }
    // Throws Error if the files of a volume that stays on disk have changed.
    void check_unchanged() const { lamina::check_unchanged(volume_); }
    std::int64_t byte_count() const;  // memory that this object takes in addition to the volume

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
    // The pages' cache: own_cache_, or the store's if that holds samples in the layout needed.
    std::unique_ptr<BrickCache> own_cache_;
    BrickCache* cache_ = nullptr;
    std::vector<CpuPages> pages_;
    mutable std::vector<std::uint8_t> announced_;  // 1: pages that will_read() has announced
};

// Returns the pages, ascending, with cells in visible min/max bricks that touch `share`, if any.
std::vector<std::uint32_t> pages_shown(const CpuVolume& volume, const OccupiedBricks& occupied,
                                       const std::optional<IndexBox>& share);

// Returns `pages` that may be in the view. `count`: pages on each axis; `first`: first_of_pages().
std::vector<std::uint32_t> pages_seen(const std::vector<std::uint32_t>& pages,
                                      const std::array<std::int64_t, 3>& count,
                                      const std::array<std::int64_t, 3>& first, const Grid& grid,
                                      const View& view);

}  // namespace lamina
