// SPDX-License-Identifier: Apache-2.0
// Which pixel centres a triangle covers, and the interpolated values there, as a rasteriser
// computes them.
#if defined(LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_
#undef LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_
#else
#define LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/triangle_record.h"
#include "tiles/doubles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The barycentric weight of each corner at some pixels; 0 where they are not covered.
template <class V>
struct CornerWeights {
    V corner[3];
    bool any = false;
};

// For half of the pixels, in double precision.
template <class DD>
HWY_INLINE void corner_weights(DD dd, const TriangleRecord& triangle, hn::Vec<DD> column,
                               hn::Vec<DD> row, hn::Vec<DD> (&weights)[3]) {
    const auto linear = [&](const auto& function) HWY_ATTR {
        const auto across = hn::Mul(hn::Set(dd, function.per_column),
                                    hn::Sub(column, hn::Set(dd, function.column)));
        return hn::Add(across, hn::Mul(hn::Set(dd, function.per_row),
                                       hn::Sub(row, hn::Set(dd, function.row))));
    };
    auto inside = hn::Ge(column, column);
    for (const TriangleRecord::Edge& edge : triangle.edges) {
        const auto area = linear(edge), zero = hn::Zero(dd);
        inside = hn::And(inside, edge.has_zeros ? hn::Ge(area, zero) : hn::Gt(area, zero));
    }
    for (std::size_t i = 0; i < 3; ++i)
        weights[i] = hn::IfThenElseZero(inside, linear(triangle.shares[i]));
}

// `column`, `row`: window coordinates of pixel centres.
template <class D>
HWY_INLINE CornerWeights<hn::Vec<D>> corner_weights_at(D d, const TriangleRecord& triangle,
                                                       hn::Vec<D> column, hn::Vec<D> row) {
    const typename Doubles<D>::Tag dd;
    const Doubles<D> columns = to_doubles(d, column), rows = to_doubles(d, row);
    hn::Vec<decltype(dd)> low[3], high[3];
    corner_weights(dd, triangle, columns.low, rows.low, low);
    corner_weights(dd, triangle, columns.high, rows.high, high);
    CornerWeights<hn::Vec<D>> weights;
    auto sum = hn::Zero(d);
    for (std::size_t i = 0; i < 3; ++i) {
        weights.corner[i] = to_floats(d, Doubles<D>{low[i], high[i]});
        sum = hn::Add(sum, weights.corner[i]);
    }
    weights.any = !hn::AllTrue(d, hn::Eq(sum, hn::Zero(d)));
    return weights;
}

template <class D>
HWY_INLINE hn::Vec<D> interpolate(D d, const CornerWeights<hn::Vec<D>>& weights, float a, float b,
                                  float c) {
    return hn::Add(hn::Mul(weights.corner[0], hn::Set(d, a)),
                   hn::Add(hn::Mul(weights.corner[1], hn::Set(d, b)),
                           hn::Mul(weights.corner[2], hn::Set(d, c))));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
