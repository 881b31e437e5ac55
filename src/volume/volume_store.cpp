// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_store.h"

#include "base/memory.h"
#include "volume/brick_runs.h"
#include "volume/with_sample_type.h"

namespace lamina {
namespace {

// Before it is known what drawing takes.
constexpr double first_share = 0.25;

}  // namespace

VolumeStore::VolumeStore(const Grid& grid, SampleType type,
                         std::unique_ptr<const SampleSource> source)
    : size_(grid.size),
      type_(type),
      source_(std::move(source)),
      bricks_(grid.size, static_cast<std::size_t>(BrickCache::sample_count) * bytes_of(type),
              [this](std::span<const BrickCache::Wanted> wanted) { fill(wanted); }) {
    bricks_.set_capacity(
        static_cast<std::uint64_t>(first_share * static_cast<double>(memory_limit())));
}

void VolumeStore::fill(std::span<const BrickCache::Wanted> wanted) const {
    with_sample_type(type_, [&](auto zero) {
        using T = decltype(zero);
        const BrickPlaces places{size_, bricks_.count(), {0, 0, 0}};
        read_brick_runs<T>(
            *source_, places, wanted, 0,
            [](const BrickCache::Wanted& brick, const auto& first, const SampleWindow<T>& window) {
                T* to = reinterpret_cast<T*>(brick.to);
                for (std::int64_t z = 0; z < BrickCache::samples; ++z) {
                    for (std::int64_t y = 0; y < BrickCache::samples; ++y) {
                        window.copy_row(first[0], first[1] + y, first[2] + z, BrickCache::samples,
                                        to);
                        to += BrickCache::row;
                    }
                }
            });
    });
}

}  // namespace lamina
