// SPDX-License-Identifier: Apache-2.0
#include "slicing/cpu_volume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "facts/drawn_range.h"
#include "slicing/slab_geometry.h"
#include "volume/sample_source.h"

namespace lamina {
namespace {

// Bytes of the memory limit that pages leave free for pictures.
constexpr std::uint64_t kept_free = 50'000'000;

constexpr std::size_t page_samples = static_cast<std::size_t>(BrickCache::sample_count);

// Returns the offset in a page of its gradients, which follow the samples, aligned to 8 bytes.
std::size_t gradients_after(std::size_t sample_bytes) {
    return (page_samples * sample_bytes + 7) / 8 * 8;
}

// A range of min/max bricks on one axis: first .. end - 1.
struct BrickSpan {
    std::int64_t first, end;
};
// Returns the min/max bricks on an axis that touch the share; all if there is no share.
BrickSpan bricks_of(const std::optional<IndexBox>& share, int axis,
                    const OccupiedBricks& occupied) {
    const std::int64_t count = occupied.count[static_cast<std::size_t>(axis)];
    if (!share) return {0, count};
    const auto brick_at = [&](double place) {
        const double brick = std::floor(place / double{MinMaxBricks::edge});
        return static_cast<std::int64_t>(std::clamp(brick, 0.0, static_cast<double>(count)));
    };
    return {std::min(brick_at(share->min[axis]), count - 1),
            std::min(brick_at(share->max[axis]) + 1, count)};
}

// Returns for each page on an axis the bricks of `span` that touch it; first = end = 0 if none.
std::vector<BrickSpan> bricks_of_pages(const BrickSpan& span, std::int64_t first_sample,
                                       std::int64_t pages) {
    std::vector<BrickSpan> bricks(static_cast<std::size_t>(pages), {0, 0});
    for (std::int64_t brick = span.first; brick < span.end; ++brick) {
        const std::int64_t begin = brick * MinMaxBricks::edge - first_sample;
        // The outermost bricks also stand for the volume beyond its first and last sample.
        const std::int64_t from = brick == 0 ? 0 : begin / BrickCache::edge;
        const std::int64_t to = (begin + MinMaxBricks::edge) / BrickCache::edge;
        for (auto page = std::min(from, pages - 1); page <= std::min(to, pages - 1); ++page) {
            BrickSpan& of_page = bricks[static_cast<std::size_t>(page)];
            if (of_page.end == 0) of_page.first = brick;
            of_page.end = brick + 1;
        }
    }
    return bricks;
}

// Returns how far a point lies outside each of five planes that bound the view: the plane of the
// eye, and the four sides of the picture, widened by a pixel. Negative: inside.
std::array<double, 5> outside_of(const View& view, const glm::dvec3& point) {
    const glm::dvec3 from_eye = point - view.eye;
    const double depth = glm::dot(from_eye, view.forward);
    const double across = glm::dot(from_eye, view.right), up = glm::dot(from_eye, view.up);
    const double scale = view.projection == Projection::perspective ? depth : 1;
    const double half_width = (0.5 * view.width + 1) * view.pixel * scale;
    const double half_height = (0.5 * view.height + 1) * view.pixel * scale;
    return {-depth, across - half_width, -across - half_width, up - half_height, -up - half_height};
}

}  // namespace

CpuVolume::CpuVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan)
    : volume_(volume),
      range_(range),
      parts_(plan.bricks),
      float_texture_(plan.float_texture),
      lit_(plan.lighting.has_value()) {
    const bool whole = plan.bricks.size() == 1;
    for (const TextureBrick& part : plan.bricks) {
        CpuBrick brick;
        brick.layout = plan.float_texture                   ? CpuLayout::floats
                       : volume.type() != SampleType::uint8 ? CpuLayout::words
                                                            : CpuLayout::bytes;
        for (std::size_t axis = 0; axis < 3; ++axis)
            brick.last_sample[axis] = static_cast<float>(part.size[axis] - 1);
        brick.row = part.size[1] > 1 ? static_cast<std::int32_t>(part.size[0]) : 0;
        brick.slice = part.size[2] > 1 ? static_cast<std::int32_t>(part.size[0] * part.size[1]) : 0;
        brick.nearest = plan.nearest;
        normalise(range, brick);
        if (!volume.in_memory()) {
            bricks_.push_back(brick);
            continue;
        }
        if (whole && brick.layout != CpuLayout::floats && volume.byte_count() >= 4) {
            brick.samples = volume_.data();
            brick.last_word = static_cast<std::int32_t>(volume_.byte_count() - 4);
        } else {
            copy_brick(part, brick);
        }
        if (lit_) {
            gradients_.push_back(make_gradient_map(volume, part));
            brick.gradients = gradients_.back().data();
        }
        bricks_.push_back(brick);
    }
    if (!volume.in_memory()) page();
}

// Sets the factors that normalise codes. As in OpenGL, codes of int16 are shifted to begin at 0.
void CpuVolume::normalise(const ValueRange& range, CpuBrick& brick) const {
    if (brick.layout == CpuLayout::floats) return;
    const double largest = volume_.type() == SampleType::uint8 ? 255 : 65535;
    const double shift = volume_.type() == SampleType::int16 ? 32768 : 0;
    const double scale = 1 / (range.hi - range.lo);
    brick.flip = volume_.type() == SampleType::int16 ? 0x80008000u : 0u;
    brick.scale = static_cast<float>(scale);
    brick.offset = static_cast<float>(-(range.lo + shift) * scale);
    brick.unit = static_cast<float>(1 / largest);
    brick.unit_scale = static_cast<float>(largest * scale);
}

void CpuVolume::copy_brick(const TextureBrick& part, CpuBrick& brick) {
    const Grid& grid = volume_.grid();
    const std::int64_t count = part.size[0] * part.size[1] * part.size[2];
    const auto bytes = static_cast<std::int64_t>(bytes_of_sample(brick.layout)) * count;
    const std::int64_t words = (bytes + 3) / 4;
    auto* const copy = static_cast<std::uint32_t*>(
        copies_.emplace_back(filled_memory(4 * static_cast<std::size_t>(words))).get());
    copy[words - 1] = 0;  // the samples may not fill the last word
    copied_bytes_ += 4 * words;
    brick.samples = copy;
    brick.last_word = static_cast<std::int32_t>(
        std::min<std::int64_t>(4 * words - 4, std::numeric_limits<std::int32_t>::max()));
    volume_.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        parallel_for(part.size[1] * part.size[2], 64, [&](std::int64_t number) {
            const BrickRow own = row_of(part, grid, number % part.size[1], number / part.size[1]);
            const Sample* const row = samples + own.first;
            const std::int64_t place = number * part.size[0];
            if (brick.layout != CpuLayout::floats) {
                std::memcpy(reinterpret_cast<std::byte*>(copy) +
                                static_cast<std::size_t>(place) * sizeof(Sample),
                            row, static_cast<std::size_t>(part.size[0]) * sizeof(Sample));
                return;
            }
            for (std::int64_t x = own.begin; x < own.end; ++x) {
                copy[place + x] =
                    std::bit_cast<std::uint32_t>(normalised_sample(row[x - own.begin], range_));
            }
            own.repeat_ends(copy + place, part.size[0]);
        });
    });
}

bool CpuVolume::can_replace(const Volume& volume, const ValueRange& range,
                            const SlicePlan& plan) const {
    return volume.shares_samples(volume_) && range == range_ && plan.bricks == parts_ &&
           plan.float_texture == float_texture_ && plan.lighting.has_value() == lit_ &&
           plan.nearest == bricks_.front().nearest;
}

std::int64_t CpuVolume::byte_count() const {
    std::int64_t bytes = copied_bytes_;
    for (const auto& map : gradients_)
        bytes += static_cast<std::int64_t>(sizeof(StoredGradient) * map.size());
    if (cache_ != nullptr) bytes += static_cast<std::int64_t>(cache_->resident_bytes());
    return bytes;
}

void CpuVolume::page() {
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

// Makes a cache of own pages: the store's hold neither normalised floats nor gradients.
void CpuVolume::make_own_pages() {
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

// Lets the cache's pages take the memory that the limit leaves.
void CpuVolume::share_memory(BrickCache& cache) const {
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

CpuPages CpuVolume::pages_of(const TextureBrick& part) const {
    CpuPages pages;
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

// Announces neighbouring pages of a row along x as one box.
void CpuVolume::will_read(std::span<const std::uint32_t> pages) const {
    announced_.resize(cache_->brick_count());
    std::vector<std::uint32_t> news;
    for (const std::uint32_t page : pages)
        if (std::exchange(announced_[page], std::uint8_t{1}) == 0) news.push_back(page);
    const BrickPlaces places{volume_.grid().size, cache_->count(), first_of_pages()};
    const std::int64_t margin = lit_ ? 1 : 0, row = places.count[0];
    std::vector<SampleBox> boxes;
    for (std::size_t begin = 0, end = 0; begin < news.size(); begin = end) {
        while (end < news.size() && news[end] / row == news[begin] / row) ++end;
        boxes.push_back(places.box_of(news[begin], news[end - 1], margin));
    }
    if (!boxes.empty()) volume_.store().source().will_read(boxes);
}

void CpuVolume::fill_own_pages(std::span<const BrickCache::Wanted> wanted) const {
    const BrickPlaces places{volume_.grid().size, own_cache_->count(), first_of_pages()};
    with_sample_type(volume_.type(), [&](auto zero) {
        using Sample = decltype(zero);
        read_adjacent_bricks<Sample>(
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
void CpuVolume::set_page_samples(const SampleWindow<Sample>& window,
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

std::vector<std::uint32_t> pages_shown(const CpuVolume& volume, const OccupiedBricks& occupied,
                                       const std::optional<IndexBox>& share) {
    const BrickCache& cache = *volume.pages();
    const auto& count = cache.count();
    std::array<std::vector<BrickSpan>, 3> bricks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bricks[axis] = bricks_of_pages(bricks_of(share, static_cast<int>(axis), occupied),
                                       volume.first_of_pages()[axis], count[axis]);
    }
    std::vector<std::uint8_t> shown(cache.brick_count());
    parallel_for(std::ssize(bricks[2]), 1, [&](std::int64_t z) {
        const BrickSpan deep = bricks[2][static_cast<std::size_t>(z)];
        for (std::size_t y = 0; y < bricks[1].size(); ++y) {
            for (std::size_t x = 0; x < bricks[0].size(); ++x) {
                const BrickSpan across = bricks[0][x], along = bricks[1][y];
                shown[cache.number(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), z)] =
                    occupied.any_of({across.first, along.first, deep.first},
                                    {across.end - 1, along.end - 1, deep.end - 1});
            }
        }
    });
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t page = 0; page < shown.size(); ++page)
        if (shown[page] != 0) numbers.push_back(page);
    return numbers;
}

std::vector<std::uint32_t> pages_seen(const std::vector<std::uint32_t>& pages,
                                      const std::array<std::int64_t, 3>& count,
                                      const std::array<std::int64_t, 3>& first, const Grid& grid,
                                      const View& view) {
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t page : pages) {
        const glm::dvec3 place{page % count[0], page / count[0] % count[1],
                               page / (count[0] * count[1])};
        const glm::dvec3 begin =
            glm::dvec3(first[0], first[1], first[2]) + place * double{BrickCache::edge};
        std::array<double, 5> least;
        least.fill(1);
        for (int corner = 0; corner < 8; ++corner) {
            // A margin of one sample covers the volume beyond its first and last sample.
            const glm::dvec3 step{corner & 1, corner >> 1 & 1, corner >> 2};
            const glm::dvec3 at = begin - 1.0 + step * double(BrickCache::edge + 2);
            const auto outside = outside_of(view, grid.to_world(at));
            for (std::size_t i = 0; i < least.size(); ++i)
                least[i] = corner == 0 ? outside[i] : std::min(least[i], outside[i]);
        }
        if (std::ranges::all_of(least, [](double by) { return by <= 0; })) seen.push_back(page);
    }
    return seen;
}

}  // namespace lamina
