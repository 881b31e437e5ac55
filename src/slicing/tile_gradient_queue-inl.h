// SPDX-License-Identifier: Apache-2.0
// The gradients of parts that wait to be cut, stored densely like these.
#if defined(LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_
#undef LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_
#else
#define LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_
#endif

#include "simd/members-inl.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_light-inl.h"

LAMINA_SIMD_BEGIN

class GradientQueue {
  public:
    // Stores the members of a vector one after the other from `to` on. It writes whole vectors.
    LAMINA_INLINE void keep(const GradientLanes& lanes, FloatMask members, std::size_t to) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t power = 0; power < 4; ++power)
                store_members(lanes.along[axis].c[power], members, along_[axis][power] + to);
            store_members(lanes.to_eye[axis], members, to_eye_[axis] + to);
        }
        store_members(lanes.smallest_square, members, smallest_square_ + to);
    }

    LAMINA_INLINE GradientLanes kept(std::size_t from) const {
        GradientLanes lanes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t power = 0; power < 4; ++power)
                lanes.along[axis].c[power] = load_unaligned<Float>(along_[axis][power] + from);
            lanes.to_eye[axis] = load_unaligned<Float>(to_eye_[axis] + from);
        }
        lanes.smallest_square = load_unaligned<Float>(smallest_square_ + from);
        return lanes;
    }

  private:
    alignas(64) float along_[3][4][CellParts::capacity];
    alignas(64) float to_eye_[3][CellParts::capacity];
    alignas(64) float smallest_square_[CellParts::capacity];
};

LAMINA_SIMD_END

#endif
