// SPDX-License-Identifier: Apache-2.0
// Packs the members of a set of lanes side by side in memory, and unpacks them into their lanes.
// Loops thus fill vectors anew with the lanes that still have work.
#if defined(LAMINA_SIMD_MEMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_MEMBERS_INL_H_
#undef LAMINA_SIMD_MEMBERS_INL_H_
#else
#define LAMINA_SIMD_MEMBERS_INL_H_
#endif

#include <cstring>

#include "simd/lane_set.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

static_assert(Double::lanes <= longest_vector);

template <class Body>
LAMINA_INLINE void for_each_lane(LaneSet set, const Body& body) {
    for (; set != 0; set &= set - 1) body(static_cast<std::size_t>(std::countr_zero(set)));
}

// Moves the members of a set to the first lanes, in order. For vectors of up to eight lanes it
// replaces hn::Compress(); members_of in simd/lane_set.h gives the reason.
LAMINA_INLINE Float members_first(Float v, FloatMask members) {
    if constexpr (Float::lanes > 8) {
        return hn::Compress(v.v, members.m);
    } else {
        const auto* const from =
            reinterpret_cast<const std::uint8_t*>(&members_of[bits_of(members)]);
        return permute(v, load_bytes(from));
    }
}

// Stores a vector's members from `to` on; overwrites a whole vector's length there.
LAMINA_INLINE void store_members(Float v, FloatMask members, float* to) {
    store_unaligned(members_first(v, members), to);
}
LAMINA_INLINE void store_members(Int v, FloatMask members, std::int32_t* to) {
    store_unaligned(bits_as<Int>(members_first(bits_as<Float>(v), members)), to);
}

// A set of lanes, and for each member the place at which store_members() stores it, counted from
// the first. The places of other lanes have no meaning.
struct StoredLanes {
    LaneSet set;
    std::uint8_t places[most_lanes];
};

LAMINA_INLINE StoredLanes stored_lanes(FloatMask members) {
    StoredLanes lanes{bits_of(members), {}};
    const LaneSet first = lanes.set & 255;
    const std::uint64_t low = members_before[first], high = members_before[lanes.set >> 8];
    const auto in_low = static_cast<std::uint64_t>(std::popcount(first));
    const std::uint64_t shifted = high + in_low * 0x0101010101010101u;
    std::memcpy(lanes.places, &low, 8);
    std::memcpy(lanes.places + 8, &shifted, 8);
    return lanes;
}

// Loads the members that store_members() stored, each into its own lane; the other lanes become 0.
LAMINA_INLINE Float load_members(const float* from, const StoredLanes& lanes) {
    const Float moved = permute(load_unaligned<Float>(from), load_bytes(lanes.places));
    return zero_unless(mask_of_bits<FloatMask>(lanes.set), moved);
}

// True if the instruction set packs and unpacks members with one instruction.
inline constexpr bool packs_quickly = HWY_TARGET <= HWY_AVX3;

// Does what load_members() does, for a set of lanes without places.
LAMINA_INLINE Float expand_members(LaneSet set, const float* from) {
#if HWY_TARGET <= HWY_AVX3
    return hn::Vec<Float::Tag>{_mm512_maskz_expandloadu_ps(static_cast<__mmask16>(set), from)};
#else
    return load_members(from, stored_lanes(mask_of_bits<FloatMask>(set)));
#endif
}

// Stores the same members (`kept`) of several vectors of doubles, as store_members() does.
class KeptLanes {
  public:
    LAMINA_INLINE explicit KeptLanes(DoubleMask kept)
        : kept_(places(kept)), count_(count_of(kept)) {}

    LAMINA_INLINE std::size_t count() const { return count_; }
    LAMINA_INLINE void store(Double values, double* to) const {
        store_unaligned(permute(values, kept_), to);
    }
    LAMINA_INLINE void store(Long values, std::int64_t* to) const {
        store_unaligned(bits_as<Long>(permute(bits_as<Double>(values), kept_)), to);
    }

  private:
    static LAMINA_INLINE Long places(DoubleMask kept) {
        const hn::RebindToUnsigned<Long::Tag> d;
        const auto shift = hn::ShiftLeft<3>(hn::Iota(d, 0));
        const auto bytes = hn::Shr(hn::Set(d, members_of[bits_of(kept)]), shift);
        return hn::BitCast(Long::Tag(), hn::And(bytes, hn::Set(d, 7)));
    }

    Long kept_;
    std::size_t count_;
};

// A table of rows, stored column by column. `Row`: a struct of nothing but Floats and Ints, each of
// which has a column. The vectors that load(first) returns hold row first + i in lane i.
template <class Row, std::size_t capacity>
class Columns {
    static_assert(std::is_trivially_copyable_v<Row> && sizeof(Row) % sizeof(Float) == 0);
    static constexpr std::size_t count = sizeof(Row) / sizeof(Float);

  public:
    LAMINA_INLINE Row load(std::size_t first) const {
        Row row;
#pragma GCC unroll 64
        for (std::size_t i = 0; i < count; ++i) {
            const Float column = load_unaligned<Float>(columns_[i] + first);
            std::memcpy(reinterpret_cast<std::byte*>(&row) + i * sizeof(Float), &column,
                        sizeof(Float));
        }
        return row;
    }

    // Stores the members of a vector of rows from row `to` on; overwrites up to a vector's length.
    LAMINA_INLINE void store_members(const Row& row, FloatMask members, std::size_t to) {
#pragma GCC unroll 64
        for (std::size_t i = 0; i < count; ++i) {
            Float column;
            std::memcpy(&column, reinterpret_cast<const std::byte*>(&row) + i * sizeof(Float),
                        sizeof(Float));
            store_unaligned(members_first(column, members), columns_[i] + to);
        }
    }

  private:
    alignas(64) float columns_[count][capacity];
};

LAMINA_SIMD_END

#endif
