// SPDX-License-Identifier: Apache-2.0
// Associated colour and opacity of a segment through a tet: the vector form of
// shaders/projection/tet_color.glsl.
#if defined(LAMINA_PROJECTION_TET_COLOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_COLOR_INL_H_
#undef LAMINA_PROJECTION_TET_COLOR_INL_H_
#else
#define LAMINA_PROJECTION_TET_COLOR_INL_H_
#endif

#include "optics/segment_integral.h"
#include "projection/tet_run-inl.h"
#include "tiles/segment_optics-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE Fragment with_color(const glm::vec3& color, Float opacity) {
    return {color.r * opacity, color.g * opacity, color.b * opacity, opacity};
}

LAMINA_INLINE Fragment constant_color(const TetFragments& fragments, const TetRun& run) {
    const glm::vec4& optics = fragments.constant_optics;
    return with_color(glm::vec3(optics), opacity_from_depth(optics.a * run.world_length));
}

// `colored`: otherwise the colour is fragments.single_color. `most_depth`: a bound on the optical
// depth of the cell fragment.
LAMINA_INLINE Fragment part_color(bool colored, PartDepth most_depth, const TetFragments& fragments,
                                  const FragmentRecord& record, const TetRun& run) {
    const auto optics = [&](std::size_t i, Float place) LAMINA_LAMBDA {
        return mix(Float(record.low[i]), Float(record.high[i]), place);
    };
    const Float front = optics(3, run.front), back = optics(3, run.back);
    if (!colored) {
        const Float mean = 0.5f * front + 0.5f * back;
        return with_color(fragments.single_color, opacity_from_depth(mean * run.world_length));
    }
    const Float p = front * run.world_length, q = back * run.world_length;
    const Float depth = 0.5f * p + 0.5f * q;
    Float opacity, most;
    if (most_depth == PartDepth::faint) {
        opacity = faint_opacity(depth);
        most = faint_front_weight(p, q);
    } else {
        opacity = opacity_from_depth(depth);
        most = most_depth == PartDepth::thin
                   ? thin_front_weight(p, q)
                   : front_weight(fragments.front_weights, FrontWeightTable::nodes, p, q);
    }
    const Float weight = min(most, opacity);
    // This is opacity * back + weight * (front - back), written with the colours at the cell
    // fragment's ends so that no term is negative.
    const Float of_high = (opacity - weight) * run.back + weight * run.front;
    const Float of_low = opacity - of_high;
    const auto channel = [&](std::size_t i) LAMINA_LAMBDA {
        return of_low * record.low[i] + of_high * record.high[i];
    };
    return {channel(0), channel(1), channel(2), opacity};
}

LAMINA_SIMD_END

#endif
