// SPDX-License-Identifier: Apache-2.0
// Codes of the optical depths of a compositing tree's nodes: vector forms of encode_depth() and
// decode_depth() of compositing/codes.h in floats, as shaders/compositing/node_code.glsl computes
// them. `share` is always a node's share of its ray's samples.
#if defined(LAMINA_TILES_NODE_CODE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_NODE_CODE_INL_H_
#undef LAMINA_TILES_NODE_CODE_INL_H_
#else
#define LAMINA_TILES_NODE_CODE_INL_H_
#endif

#include <cmath>
#include <numbers>

#include "base/enum_words.h"
#include "compositing/codes.h"
#include "simd/math-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

inline constexpr float inverse_e = static_cast<float>(1 / std::numbers::e);

// Returns log(1 / share) / e, for NodeCode::minimax.
LAMINA_INLINE float log_part_of(float share) {
    return static_cast<float>(-std::log(static_cast<double>(share)) / std::numbers::e);
}

// Returns -log(1 - value) for 0 <= value < 1. Below 1/4 it is 2 artanh(value / (2 - value)),
// because 1 - value loses digits of small values. The first omitted term is 2e-8 of the result.
LAMINA_INLINE Float depth_from_opacity(Float value) {
    const Float z = value / (2 - value);
    constexpr float series[] = {2.0f, 2.0f / 3, 2.0f / 5, 2.0f / 7};
    const Float small = z * polynomial(z * z, series);
    const Float large = -log_of(1 - value);
    return select(value < 0.25f, small, large);
}

// Returns the code NodeCode::minimax of a depth (docs/numerics.md, section 4).
LAMINA_INLINE Float encode_minimax(Float depth, float share) {
    const Float sigma = depth / share;
    const float log_part = log_part_of(share);
    const Float middle = log_of(sigma) * inverse_e + (1.0f - inverse_e);
    const Float last = 1.0f + log_part - exp_of(-depth);
    Float scaled = select(sigma > 1, middle, opacity_from_depth(sigma));
    scaled = select(depth > 1, last, scaled);
    return min(scaled / (1.0f + log_part), 1);
}

// Returns the depth of a code; value < 1.
LAMINA_INLINE Float decode_minimax(Float value, float share) {
    const float log_part = log_part_of(share);
    const Float u = value * (1.0f + log_part);
    const Float low = share * depth_from_opacity(u);
    const Float exponent = (u - 1) * std::numbers::e_v<float> + 1;
    const Float middle = share * exp_of(exponent);
    const Float rest = 1.0f + log_part - u;  // exp(-depth)
    const Float high = select(rest > 0, -log_of(rest), static_cast<float>(opaque_node_depth));
    const Float depth = select(u <= 1.0f - inverse_e + log_part, middle, high);
    return select(u <= 1.0f - inverse_e, low, depth);
}

LAMINA_INLINE Float encode_depth(NodeCode code, Float depth, float share) {
    switch (code) {
        case NodeCode::phi:
            return opacity_from_depth(depth / share);
        case NodeCode::alpha:
            return opacity_from_depth(depth);
        case NodeCode::minimax:
            return encode_minimax(depth, share);
    }
    unreachable_enum();
}

LAMINA_INLINE Float decode_depth(NodeCode code, Float value, float share) {
    constexpr auto opaque = static_cast<float>(opaque_node_depth);
    Float depth = opaque;
    switch (code) {
        case NodeCode::phi:
            depth = share * depth_from_opacity(value);
            break;
        case NodeCode::alpha:
            depth = depth_from_opacity(value);
            break;
        case NodeCode::minimax:
            depth = decode_minimax(value, share);
            break;
    }
    return select(value >= 1.0f, opaque, min(depth, opaque));
}

LAMINA_SIMD_END

#endif
