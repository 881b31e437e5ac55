// SPDX-License-Identifier: Apache-2.0
// Rows that vectors hold side by side, in memory as columns: values of one row are loaded and
// packed together.
#if defined(LAMINA_SIMD_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_COLUMNS_INL_H_
#undef LAMINA_SIMD_COLUMNS_INL_H_
#else
#define LAMINA_SIMD_COLUMNS_INL_H_
#endif

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN

// `Row`: a struct of Floats and Ints alone, each of which has a column. Lane i of the vectors that
// load(first) returns is row first + i.
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
            std::memcpy(bytes(row) + i * sizeof(Float), &column, sizeof(Float));
        }
        return row;
    }

    // Stores the members of a vector of rows one after the other from row `to` on. It writes whole
    // vectors.
    LAMINA_INLINE void store_members(const Row& row, FloatMask members, std::size_t to) {
#pragma GCC unroll 64
        for (std::size_t i = 0; i < count; ++i) {
            Float column;
            std::memcpy(&column, bytes(row) + i * sizeof(Float), sizeof(Float));
            store_unaligned(members_first(column, members), columns_[i] + to);
        }
    }

  private:
    static LAMINA_INLINE std::byte* bytes(Row& row) {
        return reinterpret_cast<std::byte*>(&row);
    }
    static LAMINA_INLINE const std::byte* bytes(const Row& row) {
        return reinterpret_cast<const std::byte*>(&row);
    }

    alignas(64) float columns_[count][capacity];
};

LAMINA_SIMD_END

#endif
