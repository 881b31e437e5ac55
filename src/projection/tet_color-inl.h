// SPDX-License-Identifier: Apache-2.0
// Associated colour and opacity of a run through a tet: the vector form of
// shaders/projection/tet_color.glsl.
#if defined(LAMINA_PROJECTION_TET_COLOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_COLOR_INL_H_
#undef LAMINA_PROJECTION_TET_COLOR_INL_H_
#else
#define LAMINA_PROJECTION_TET_COLOR_INL_H_
#endif

#include <hwy/highway.h>

#include "optics/front_weights.h"
#include "projection/tet_run-inl.h"
#include "tiles/linear_segment-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE Fragment<hn::Vec<D>> with_color(D d, const glm::vec3& color, hn::Vec<D> opacity) {
    return {hn::Mul(hn::Set(d, color.r), opacity), hn::Mul(hn::Set(d, color.g), opacity),
            hn::Mul(hn::Set(d, color.b), opacity), opacity};
}

template <class D>
HWY_INLINE Fragment<hn::Vec<D>> constant_color(D d, const TetFragments& fragments,
                                               const TetRun<hn::Vec<D>>& run) {
    const glm::vec4& optics = fragments.constant_optics;
    return with_color(d, glm::vec3(optics),
                      opacity_from_depth(d, hn::Mul(hn::Set(d, optics.a), run.world_length)));
}

// `colored`: otherwise the colour is fragments.single_color. `most_depth`: a bound on the optical
// depth of the cell fragment.
template <class D>
HWY_INLINE Fragment<hn::Vec<D>> part_color(D d, bool colored, PartDepth most_depth,
                                           const TetFragments& fragments, const TetRecord& record,
                                           const TetRun<hn::Vec<D>>& run) {
    using V = hn::Vec<D>;
    const auto optics = [&](std::size_t i, V place) HWY_ATTR {
        return mix(hn::Set(d, record.low[i]), hn::Set(d, record.high[i]), place);
    };
    const V half = hn::Set(d, 0.5f), front = optics(3, run.front), back = optics(3, run.back);
    if (!colored) {
        const V mean = hn::Add(hn::Mul(half, front), hn::Mul(half, back));
        return with_color(d, fragments.single_color,
                          opacity_from_depth(d, hn::Mul(mean, run.world_length)));
    }
    const V p = hn::Mul(front, run.world_length), q = hn::Mul(back, run.world_length);
    const V depth = hn::Add(hn::Mul(half, p), hn::Mul(half, q));
    V opacity, most;
    if (most_depth == PartDepth::faint) {
        opacity = faint_opacity(d, depth);
        most = faint_front_weight(d, p, q);
    } else {
        opacity = opacity_from_depth(d, depth);
        most = most_depth == PartDepth::thin
                   ? thin_front_weight(d, p, q)
                   : front_weight(d, fragments.front_weights, FrontWeightTable::nodes, p, q);
    }
    const V weight = hn::Min(most, opacity);
    // This is opacity * back + weight * (front - back), written with the colours at the cell
    // fragment's ends so that no term is negative.
    const V of_high =
        hn::Add(hn::Mul(hn::Sub(opacity, weight), run.back), hn::Mul(weight, run.front));
    const V of_low = hn::Sub(opacity, of_high);
    const auto channel = [&](std::size_t i) HWY_ATTR {
        return hn::Add(hn::Mul(of_low, hn::Set(d, record.low[i])),
                       hn::Mul(of_high, hn::Set(d, record.high[i])));
    };
    return {channel(0), channel(1), channel(2), opacity};
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
