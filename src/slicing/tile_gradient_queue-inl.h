// SPDX-License-Identifier: Apache-2.0
// The gradients of parts that wait to be cut, stored densely like these.
#if defined(LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_
#undef LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_
#else
#define LAMINA_SLICING_TILE_GRADIENT_QUEUE_INL_H_
#endif

#include <hwy/highway.h>

#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

class GradientQueue {
  public:
    // Stores the members of a vector one after the other from `to` on. It writes whole vectors.
    HWY_INLINE void store(const GradientLanes& lanes, FloatMask members, std::size_t to) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t power = 0; power < 4; ++power)
                store_members(lanes.along[axis].c[power].v, members, along_[axis][power] + to);
            store_members(lanes.to_eye[axis].v, members, to_eye_[axis] + to);
        }
        store_members(lanes.smallest_square.v, members, smallest_square_ + to);
    }

    HWY_INLINE GradientLanes load(std::size_t from) const {
        const FloatTag d;
        GradientLanes lanes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t power = 0; power < 4; ++power)
                lanes.along[axis].c[power] = hn::LoadU(d, along_[axis][power] + from);
            lanes.to_eye[axis] = hn::LoadU(d, to_eye_[axis] + from);
        }
        lanes.smallest_square = hn::LoadU(d, smallest_square_ + from);
        return lanes;
    }

  private:
    alignas(64) float along_[3][4][CellParts::capacity];
    alignas(64) float to_eye_[3][CellParts::capacity];
    alignas(64) float smallest_square_[CellParts::capacity];
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
