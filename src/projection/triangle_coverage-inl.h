// SPDX-License-Identifier: Apache-2.0
// The pixel centres that a triangle covers, and the interpolated values there, as a rasteriser
// computes them.
#if defined(LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_
#undef LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_
#else
#define LAMINA_PROJECTION_TRIANGLE_COVERAGE_INL_H_
#endif

#include "projection/triangle_record.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// The barycentric weight of each corner at some pixels; 0 for pixels that are not covered.
struct CornerWeights {
    Float corner[3];
    bool any = false;
};

// `column`, `row`: window coordinates of pixel centres.
LAMINA_INLINE CornerWeights corner_weights_at(const TriangleRecord& triangle, Float column,
                                              Float row) {
    const Float64 columns(column), rows(row);
    const auto linear = [&](const auto& function) LAMINA_LAMBDA {
        return function.per_column * (columns - function.column) +
               function.per_row * (rows - function.row);
    };
    Float64Mask inside = columns == columns;
    for (const TriangleRecord::Edge& edge : triangle.edges) {
        const Float64 area = linear(edge);
        inside = inside & (edge.has_zeros ? area >= 0 : area > 0);
    }
    CornerWeights weights;
    Float sum(0);
    for (std::size_t i = 0; i < 3; ++i) {
        weights.corner[i] = to_float(zero_unless(inside, linear(triangle.shares[i])));
        sum += weights.corner[i];
    }
    weights.any = !all_of(sum == 0);
    return weights;
}

LAMINA_INLINE Float interpolate(const CornerWeights& weights, float a, float b, float c) {
    return weights.corner[0] * a + (weights.corner[1] * b + weights.corner[2] * c);
}

LAMINA_SIMD_END

#endif
