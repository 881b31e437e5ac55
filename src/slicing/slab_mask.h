// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "lamina/scene.h"
#include "simd/attributes.h"
#include "slicing/tile_slabs.h"

namespace lamina {

// A set of slabs of a block. Bit i stands for slab i; slab 0 is the nearest.
using BlockMask = std::uint32_t;
static_assert(tile_block_slabs == 32);

// Returns the set of slabs first .. end - 1.
inline BlockMask block_mask(int first, int end) {
    if (first >= end) return 0;
    return ~BlockMask{0} >> (tile_block_slabs - (end - first)) << first;
}

// Calls body(first, end) for each run of bits; the first function begins with the lowest run, the
// second with the highest.
template <class Body>
LAMINA_INLINE void for_each_run(BlockMask mask, const Body& body) {
    while (mask != 0) {
        const int first = std::countr_zero(mask);
        const int end = first + std::countr_one(mask >> first);
        body(first, end);
        mask &= ~block_mask(first, end);
    }
}

template <class Body>
LAMINA_INLINE void for_each_run_backwards(BlockMask mask, const Body& body) {
    while (mask != 0) {
        const int end = tile_block_slabs - std::countl_zero(mask);
        const int first = end - std::countl_one(mask << (tile_block_slabs - end));
        body(first, end);
        mask &= ~block_mask(first, end);
    }
}

// A set of slabs, of up to max_slabs, stored in blocks.
class SlabMask {
  public:
    void clear(int slabs) {
        assert(slabs <= max_slabs);
        std::fill_n(blocks_.begin(), (slabs + tile_block_slabs - 1) / tile_block_slabs,
                    BlockMask{0});
    }
    void set(int first, int end) {
        while (first < end) {
            const int block = first / tile_block_slabs, begin = block * tile_block_slabs;
            const int block_end = std::min(end, begin + tile_block_slabs);
            blocks_[static_cast<std::size_t>(block)] |=
                block_mask(first - begin, block_end - begin);
            first = block_end;
        }
    }
    BlockMask block(int number) const { return blocks_[static_cast<std::size_t>(number)]; }

  private:
    // Only the blocks that were cleared are defined.
    std::array<BlockMask, max_slabs / tile_block_slabs> blocks_;
};

}  // namespace lamina
