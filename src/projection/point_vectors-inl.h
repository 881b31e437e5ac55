// SPDX-License-Identifier: Apache-2.0
// Vectors of points, one for each of several tets.
#if defined(LAMINA_PROJECTION_POINT_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_POINT_VECTORS_INL_H_
#undef LAMINA_PROJECTION_POINT_VECTORS_INL_H_
#else
#define LAMINA_PROJECTION_POINT_VECTORS_INL_H_
#endif

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

struct Point {
    Double x, y, z;
};

LAMINA_INLINE Point operator-(const Point& a, const Point& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LAMINA_INLINE Double dot(const Point& a, const Point& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LAMINA_INLINE Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
LAMINA_INLINE Point scaled(const Point& a, Double factor) {
    return {a.x * factor, a.y * factor, a.z * factor};
}
LAMINA_INLINE Double largest_of(const Point& a) {
    return max(abs(a.x), max(abs(a.y), abs(a.z)));
}
LAMINA_SIMD_END

#endif
