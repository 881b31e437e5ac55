// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slicing/gradient_map.h"
#include "volume/brick_cache.h"

namespace lamina {

// A brick of a plan whose samples are the bricks of a cache that are in memory. Here "page" is a
// brick of the cache: BrickCache::edge^3 cells.
struct TilePages {
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

}  // namespace lamina
