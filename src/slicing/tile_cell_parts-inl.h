// SPDX-License-Identifier: Apache-2.0
// The parts of rays that lie in one cell each, stored densely: a vector of parts is computed at a
// time, whatever rays they belong to.
#if defined(LAMINA_SLICING_TILE_CELL_PARTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_CELL_PARTS_INL_H_
#undef LAMINA_SLICING_TILE_CELL_PARTS_INL_H_
#else
#define LAMINA_SLICING_TILE_CELL_PARTS_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstring>

#include "base/set_members.h"
#include "executors/tile_number-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// For each set of eight lanes the number of its members before each lane.
inline constexpr std::array<std::uint64_t, 256> members_before = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned set = 0; set < 256; ++set) {
        for (unsigned lane = 0; lane < 8; ++lane) {
            const auto before = static_cast<unsigned>(std::popcount(set & ((1u << lane) - 1)));
            table[set] |= std::uint64_t{before} << (8 * lane);
        }
    }
    return table;
}();

// The set of lanes as bits, the first lane lowest.
HWY_INLINE std::uint32_t bits_of(FloatMask lanes) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(FloatTag(), lanes, bits);
    return bits[0] | static_cast<std::uint32_t>(bits[1]) << 8;
}

// Calls body(lane) for each lane of a set.
template <class Body>
HWY_INLINE void for_each_lane(std::uint32_t set, const Body& body) {
    for (; set != 0; set &= set - 1) body(static_cast<std::size_t>(std::countr_zero(set)));
}

// The members of a set in its first lanes. Up to eight lanes this is hn::Compress() with the table
// of base/set_members.h, which gives the reason.
HWY_INLINE Floats members_first(Floats v, FloatMask members) {
    if constexpr (hn::MaxLanes(FloatTag()) > 8) {
        return hn::Compress(v, members);
    } else {
        const hn::Rebind<std::uint8_t, IntTag> bytes;
        const auto* const from =
            reinterpret_cast<const std::uint8_t*>(&members_of[bits_of(members)]);
        const Ints lanes = hn::PromoteTo(IntTag(), hn::LoadU(bytes, from));
        return hn::TableLookupLanes(v, hn::IndicesFromVec(FloatTag(), lanes));
    }
}

// A set of lanes, and where the parts of its members are stored. Lanes outside the set have
// any place.
struct StoredLanes {
    std::uint32_t set;
    std::uint8_t places[most_lanes];
};

HWY_INLINE StoredLanes stored_lanes(FloatMask members) {
    StoredLanes lanes{bits_of(members), {}};
    const std::uint32_t first = lanes.set & 255;
    const std::uint64_t low = members_before[first], high = members_before[lanes.set >> 8];
    const auto in_low = static_cast<std::uint64_t>(std::popcount(first));
    const std::uint64_t shifted = high + in_low * 0x0101010101010101u;
    std::memcpy(lanes.places, &low, 8);
    std::memcpy(lanes.places + 8, &shifted, 8);
    return lanes;
}

// Some steps of the rays of a few packets. In each step a ray crosses one cell, or several that
// show nothing or are constant.
struct CellParts {
    // Packets side by side: each waits for its own results.
    static constexpr std::size_t most_packets = 2;
    static constexpr int most_steps = 32;
    static constexpr std::size_t capacity = (most_steps * most_packets + 1) * most_lanes;

    // Where the ray enters the cell, from 0 to 1, and how far it goes in it.
    alignas(64) float place[3][capacity];
    alignas(64) float change[3][capacity];
    alignas(64) float length[capacity];        // world units
    alignas(64) std::int32_t index[capacity];  // of the cell's lowest corner
    // The normalised scalar from entry to exit: cubic[0] + t (cubic[1] + ...), t from 0 to 1.
    alignas(64) float cubic[4][capacity];
    // Of parts that are lit: the direction to the eye.
    alignas(64) float to_eye[3][capacity];
    // Associated colour, opacity and optical depth that the part adds to its ray.
    alignas(64) float color[3][capacity];
    alignas(64) float opacity[capacity];
    alignas(64) float depth[capacity];

    StoredLanes lanes[most_steps][most_packets];  // rays that have a part in this step
    int steps;
    std::size_t count;

    void clear() {
        steps = 0;
        count = 0;
    }
};

// Stores the members of a vector one after the other from `to` on. It writes a whole vector.
HWY_INLINE void store_members(Floats v, FloatMask members, float* to) {
    hn::StoreU(members_first(v, members), FloatTag(), to);
}
HWY_INLINE void store_members(Ints v, FloatMask members, std::int32_t* to) {
    const Floats moved = members_first(hn::BitCast(FloatTag(), v), members);
    hn::StoreU(hn::BitCast(IntTag(), moved), IntTag(), to);
}

// Takes what store_members() stored back to its lanes; the others become 0.
HWY_INLINE Floats load_members(const float* from, const StoredLanes& lanes) {
    const FloatTag d;
    const hn::Rebind<std::uint8_t, IntTag> bytes;
    const Ints places = hn::PromoteTo(IntTag(), hn::LoadU(bytes, lanes.places));
    const Floats moved = hn::TableLookupLanes(hn::LoadU(d, from), hn::IndicesFromVec(d, places));
    std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes.set),
                            static_cast<std::uint8_t>(lanes.set >> 8)};
    return hn::IfThenElseZero(hn::LoadMaskBits(d, bits), moved);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
