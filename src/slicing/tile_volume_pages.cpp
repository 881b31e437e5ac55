// SPDX-License-Identifier: Apache-2.0
// The part of TileVolume for volumes that stay in their files.
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "facts/drawn_range.h"
#include "slicing/tile_volume.h"
#include "volume/brick_cache.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

// Bytes kept free for pictures and their results once the volume is drawn.
constexpr std::uint64_t kept_free = 50'000'000;

constexpr std::size_t page_samples = static_cast<std::size_t>(BrickCache::sample_count);

// Returns the offset of the gradients, which begin on a boundary of words of 8 bytes.
std::size_t gradients_after(std::size_t sample_bytes) {
    return (page_samples * sample_bytes + 7) / 8 * 8;
}

}  // namespace

void TileVolume::page() {
    if (float_texture_ || lit_) {
        make_own_pages();
    } else {
        cache_ = &volume_.store().bricks();
        share_memory(volume_.store().bricks());
    }
    pages_.reserve(parts_.size());
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        pages_.push_back(pages_of(parts_[i]));
        bricks_[i].pages = &pages_.back();
    }
}

// Floats are normalised, and gradients lie behind the samples, so the store's own bricks cannot be
// used.
void TileVolume::make_own_pages() {
    BrickCache& of_store = volume_.store().bricks();
    of_store.clear();
    of_store.set_capacity(0);
    std::array<std::int64_t, 3> size = volume_.grid().size;
    for (std::size_t axis = 0; axis < 3; ++axis) size[axis] -= 2 * first_of_pages()[axis];
    const std::size_t sample_bytes = bytes_of_sample(bricks_[0].layout);
    const std::size_t bytes =
        lit_ ? gradients_after(sample_bytes) + page_samples * sizeof(StoredGradient)
             : page_samples * sample_bytes;
    own_cache_ = std::make_unique<BrickCache>(
        size, bytes,
        [this](std::span<const BrickCache::Wanted> wanted) { fill_own_pages(wanted); });
    share_memory(*own_cache_);
    cache_ = own_cache_.get();
}

// Pages may take the memory that the limit leaves.
void TileVolume::share_memory(BrickCache& cache) const {
    const std::uint64_t left = memory_left() + cache.resident_bytes();
    const std::uint64_t kept = kept_free + volume_.store().source().memory();
    const std::uint64_t usable = left - std::min(left, kept);
    if (usable < cache.fewest_bytes()) {
        fail(
            "memory: {} bytes are left of the {} that may be taken, expected at least {}, for what "
            "all threads draw at the same time",
            usable, memory_limit(), cache.fewest_bytes());
    }
    cache.set_capacity(std::min(usable, memory_limit()));
}

TilePages TileVolume::pages_of(const TextureBrick& part) const {
    TilePages pages;
    pages.cache = cache_;
    std::array<std::int64_t, 3> first{}, count{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t begin = part.first[axis] - first_of_pages()[axis];
        const std::int64_t last_cell = begin + std::max<std::int64_t>(part.size[axis] - 2, 0);
        first[axis] = begin / BrickCache::edge;
        count[axis] = last_cell / BrickCache::edge - first[axis] + 1;
        pages.offset[axis] = static_cast<std::int32_t>(begin % BrickCache::edge);
    }
    pages.row = static_cast<std::int32_t>(count[0]);
    pages.slice = static_cast<std::int32_t>(count[0] * count[1]);
    for (std::int64_t z = first[2]; z < first[2] + count[2]; ++z) {
        for (std::int64_t y = first[1]; y < first[1] + count[1]; ++y) {
            for (std::int64_t x = first[0]; x < first[0] + count[0]; ++x)
                pages.numbers.push_back(cache_->number(x, y, z));
        }
    }
    if (lit_) pages.gradients_at = gradients_after(bytes_of_sample(bricks_[0].layout));
    return pages;
}

// The pages of a row along x are one box.
void TileVolume::will_read(std::span<const std::uint32_t> pages) const {
    told_.resize(cache_->brick_count());
    std::vector<std::uint32_t> news;
    for (const std::uint32_t page : pages)
        if (std::exchange(told_[page], std::uint8_t{1}) == 0) news.push_back(page);
    const BrickPlaces places{volume_.grid().size, cache_->count(), first_of_pages()};
    const std::int64_t margin = lit_ ? 1 : 0, row = places.count[0];
    std::vector<SampleBox> boxes;
    for (std::size_t begin = 0, end = 0; begin < news.size(); begin = end) {
        while (end < news.size() && news[end] / row == news[begin] / row) ++end;
        boxes.push_back(places.box_of(news[begin], news[end - 1], margin));
    }
    if (!boxes.empty()) volume_.store().source().will_read(boxes);
}

void TileVolume::fill_own_pages(std::span<const BrickCache::Wanted> wanted) const {
    const BrickPlaces places{volume_.grid().size, own_cache_->count(), first_of_pages()};
    with_sample_type(volume_.type(), [&](auto zero) {
        using Sample = decltype(zero);
        read_brick_runs<Sample>(
            volume_.store().source(), places, wanted, lit_ ? 1 : 0,
            [&](const BrickCache::Wanted& page, const std::array<std::int64_t, 3>& first,
                const SampleWindow<Sample>& window) {
                set_page_samples(window, first, page.to);
                if (!lit_) return;
                const std::size_t at = gradients_after(bytes_of_sample(bricks_[0].layout));
                set_page_gradients(volume_.grid(), window, first,
                                   reinterpret_cast<StoredGradient*>(page.to + at));
            });
    });
}

template <typename Sample>
void TileVolume::set_page_samples(const SampleWindow<Sample>& window,
                                  const std::array<std::int64_t, 3>& first, std::byte* to) const {
    std::array<Sample, BrickCache::samples> row;
    for (std::int64_t z = 0; z < BrickCache::samples; ++z) {
        for (std::int64_t y = 0; y < BrickCache::samples; ++y) {
            window.copy_row(first[0], first[1] + y, first[2] + z, BrickCache::samples, row.data());
            for (const Sample sample : row) {
                if (float_texture_) {
                    const float value = normalised_sample(sample, range_);
                    std::memcpy(to, &value, sizeof value);
                    to += sizeof value;
                } else {
                    std::memcpy(to, &sample, sizeof sample);
                    to += sizeof sample;
                }
            }
        }
    }
}

}  // namespace lamina
