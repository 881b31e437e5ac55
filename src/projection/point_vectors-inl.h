// SPDX-License-Identifier: Apache-2.0
// Vectors of points, one for each of several tets.
#if defined(LAMINA_PROJECTION_POINT_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_POINT_VECTORS_INL_H_
#undef LAMINA_PROJECTION_POINT_VECTORS_INL_H_
#else
#define LAMINA_PROJECTION_POINT_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/tet_setup.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::CappedTag<double, TetSetup::most_parts>;
using VD = hn::Vec<DD>;
using MD = hn::Mask<DD>;

struct Point {
    VD x, y, z;
};

HWY_INLINE Point operator-(const Point& a, const Point& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE VD dot(const Point& a, const Point& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Point cross(const Point& a, const Point& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
HWY_INLINE Point scaled(const Point& a, VD factor) {
    return {hn::Mul(a.x, factor), hn::Mul(a.y, factor), hn::Mul(a.z, factor)};
}
HWY_INLINE VD largest_of(const Point& a) {
    return hn::Max(hn::Abs(a.x), hn::Max(hn::Abs(a.y), hn::Abs(a.z)));
}
HWY_INLINE VD to_float_and_back(VD v) {
    const DD d;
    return hn::PromoteTo(d, hn::DemoteTo(hn::Rebind<float, DD>(), v));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
