// SPDX-License-Identifier: Apache-2.0
// The planes of the faces of several tets.
#if defined(LAMINA_PROJECTION_FACE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FACE_PLANES_INL_H_
#undef LAMINA_PROJECTION_FACE_PLANES_INL_H_
#else
#define LAMINA_PROJECTION_FACE_PLANES_INL_H_
#endif

#include <cstddef>

#include "projection/point_vectors-inl.h"

LAMINA_SIMD_BEGIN

// Puts the planes of front faces first, and those of others from the last place on.
struct FacePlanes {
    Double depth[4], per_column[4], per_row[4];
    Double fronts;  // the number of front faces so far

    LAMINA_INLINE FacePlanes() : fronts(0), place_of_back_(3) {
        for (std::size_t place = 0; place < 4; ++place)
            depth[place] = per_column[place] = per_row[place] = 0;
    }

    LAMINA_INLINE void add(DoubleMask front, Double face_depth, Double face_per_column,
                           Double face_per_row) {
        const Double place = select(front, fronts, place_of_back_);
        for (std::size_t i = 0; i < 4; ++i) {
            const DoubleMask here = place == static_cast<double>(i);
            depth[i] = select(here, face_depth, depth[i]);
            per_column[i] = select(here, face_per_column, per_column[i]);
            per_row[i] = select(here, face_per_row, per_row[i]);
        }
        fronts += zero_unless(front, Double(1));
        place_of_back_ -= zero_if(front, Double(1));
    }

  private:
    Double place_of_back_;
};

LAMINA_SIMD_END

#endif
