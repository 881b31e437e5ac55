// SPDX-License-Identifier: Apache-2.0
// Which pixel centres a triangle covers, and what is interpolated there: as rasterisers do it.
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

// Of pixels: how much of each corner they have, 0 where they are not covered.
template <class V>
struct CornerWeights {
    V corner[3];
    bool any = false;
};

// Of a half of the pixels, in double; what is not covered is negative.
template <class DD>
HWY_INLINE hn::Vec<DD> edge_weight(DD dd, const TriangleRecord::Edge& edge, hn::Vec<DD> column,
                                   hn::Vec<DD> row) {
    const auto zero = hn::Zero(dd), none = hn::Set(dd, -1.0);
    const auto across =
        hn::Mul(hn::Set(dd, edge.per_column), hn::Sub(column, hn::Set(dd, edge.column)));
    const auto up = hn::Mul(hn::Set(dd, edge.per_row), hn::Sub(row, hn::Set(dd, edge.row)));
    const auto weight = hn::Add(across, up);
    if (edge.has_zeros) return weight;
    return hn::IfThenElse(hn::Gt(weight, zero), weight, none);
}

template <class DD>
HWY_INLINE void corner_weights(DD dd, const TriangleRecord& triangle, hn::Vec<DD> column,
                               hn::Vec<DD> row, hn::Vec<DD> (&weights)[3]) {
    const auto zero = hn::Zero(dd), scale = hn::Set(dd, triangle.inverse_area);
    for (std::size_t i = 0; i < 3; ++i)
        weights[i] = edge_weight(dd, triangle.edges[i], column, row);
    const auto covered = hn::Ge(hn::Min(weights[0], hn::Min(weights[1], weights[2])), zero);
    for (auto& weight : weights) weight = hn::IfThenElseZero(covered, hn::Mul(weight, scale));
}

// Window coordinates of pixel centres.
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
