// SPDX-License-Identifier: Apache-2.0
// The planes of the faces of several tets.
#if defined(LAMINA_PROJECTION_FACE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FACE_PLANES_INL_H_
#undef LAMINA_PROJECTION_FACE_PLANES_INL_H_
#else
#define LAMINA_PROJECTION_FACE_PLANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "projection/point_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Puts the planes of front faces first, and those of others from the last place on.
struct FacePlanes {
    VD depth[4], per_column[4], per_row[4];
    VD fronts;  // the number of front faces so far

    HWY_INLINE explicit FacePlanes(DD d) : fronts(hn::Zero(d)), place_of_back_(hn::Set(d, 3)) {
        for (std::size_t place = 0; place < 4; ++place)
            depth[place] = per_column[place] = per_row[place] = hn::Zero(d);
    }

    HWY_INLINE void add(MD front, VD face_depth, VD face_per_column, VD face_per_row) {
        const DD d;
        const VD place = hn::IfThenElse(front, fronts, place_of_back_);
        for (std::size_t i = 0; i < 4; ++i) {
            const MD here = hn::Eq(place, hn::Set(d, static_cast<double>(i)));
            depth[i] = hn::IfThenElse(here, face_depth, depth[i]);
            per_column[i] = hn::IfThenElse(here, face_per_column, per_column[i]);
            per_row[i] = hn::IfThenElse(here, face_per_row, per_row[i]);
        }
        const VD one = hn::Set(d, 1);
        fronts = hn::Add(fronts, hn::IfThenElseZero(front, one));
        place_of_back_ = hn::Sub(place_of_back_, hn::IfThenZeroElse(front, one));
    }

  private:
    VD place_of_back_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
