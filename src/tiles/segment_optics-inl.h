// SPDX-License-Identifier: Apache-2.0
// Computes opacity and colour of segments of rays, in vector forms of shaders:
//   opacity of an optical depth (shaders/optics/opacity.glsl);
//   weight of the front's colour on linear segments and pieces (shaders/optics/linear_segment.glsl,
//       piece_weights.glsl), and Gauss rules for curved pieces;
//   segments by look-up in a UniformTable (shaders/preintegration/uniform_table.glsl).
#if defined(LAMINA_TILES_SEGMENT_OPTICS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_SEGMENT_OPTICS_INL_H_
#undef LAMINA_TILES_SEGMENT_OPTICS_INL_H_
#else
#define LAMINA_TILES_SEGMENT_OPTICS_INL_H_
#endif

#include <glm/vec3.hpp>

#include "optics/segment_integral.h"
#include "preintegration/preintegration_table.h"
#include "simd/math-inl.h"
#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN

// Returns the opacity of an optical depth >= 0, with a relative error of 3e-7 at every depth,
// infinity included. shaders/optics/opacity.glsl gives the reasons for each step.
LAMINA_INLINE Float opacity_from_depth(Float depth) {
    const Float octaves = min(depth * 1.4426950408889634f, 126.0f);
    const Int n = to_int(octaves + 0.5f);
    const Float f = to_float(n) - octaves;
    const Float power = bits_as<Float>(0x3f800000 - shift_left<23>(n));
    constexpr float slope[] = {0.693147187926693f,     0.24022649794962264f,
                               0.0555035743364266f,    0.009618237494907015f,
                               0.0013390735477607873f, 0.00015403512367553545f};
    return (1 - power) - power * (f * polynomial(f, slope));
}

// Returns the opacity in double precision, to 1e-13, as shaders/optics/opacity.glsl does.
template <class V>
requires(std::is_same_v<typename V::Scalar, double>) LAMINA_INLINE V opacity_from_depth(V depth) {
    const V x = min(depth, 40.0) * (-1.0 / 256);
    V sum = x * (1.0 / 10) + 1.0;
    for (int i = 9; i >= 2; --i) sum = x * (1.0 / i) * sum + 1.0;
    V result = x * sum;
    for (int i = 0; i < 8; ++i) result = result * (2.0 + result);
    return -result;
}

// Front weights. On a linear segment colour and extinction are linear. With p and q the extinction
// at its front and back times its length, the optical depth is (p + q) / 2, and the associated
// colour is weight * front colour + (opacity - weight) * back colour (optics/segment_integral.h).
// Each range of depths has its approximation (shaders/optics/linear_segment.glsl).

// Returns the opacity of a depth up to faint_depth, with a relative error of 1.1e-7.
LAMINA_INLINE Float faint_opacity(Float depth) {
    return depth * polynomial(depth, {0.9999999f, -0.4999845f, 0.16627573f, -0.03848669f});
}
// Returns the front weight for optical depths up to faint_depth.
LAMINA_INLINE Float faint_front_weight(Float p, Float q) {
    const Float pq = -0.07483143f + p * 0.01593537f + q * 0.01098378f;
    const Float of_p = 0.33332185f + p * (-0.06649057f + p * 0.00875053f) + q * pq;
    const Float of_q = 0.166663f + q * (-0.02493882f + q * 0.00273092f);
    return p * of_p + q * of_q;
}

// Returns the front weight for optical depths up to thin_depth.
LAMINA_INLINE Float thin_front_weight(Float p, Float q) {
    const Float c0 = q * polynomial(q, {0.166777794f, -0.025093103f, 0.002890381f, -0.000196459f});
    const Float c1 = polynomial(q, {0.333037217f, -0.074477034f, 0.011162302f, -0.000919007f});
    const Float c2 = polynomial(q, {-0.065656503f, 0.015676728f, -0.001696676f});
    const Float c3 = polynomial(q, {0.008428908f, -0.001502640f});
    constexpr float c4 = -0.000561545f;
    return p * (p * (p * (p * c4 + c3) + c2) + c1) + c0;
}

// Returns the front weight for any depth from FrontWeightTable: nodes x nodes, a row for each q.
LAMINA_INLINE Float front_weight(const float* table, int nodes, Float p, Float q) {
    constexpr float finite = 1e30f;
    const auto last = static_cast<float>(nodes - 1);
    p = min(p, finite);
    q = min(q, finite);
    // 1 - 1 / (1 + p) and 1 - 1 / sqrt(1 + q), without a difference: faint segments keep digits.
    const Float root = sqrt(1 + q);
    const Float x = last * (p / (1 + p));
    const Float y = last * (q / root / (1 + root));
    const Int column = min(to_int(x), nodes - 2), row = min(to_int(y), nodes - 2);
    const Float share_x = x - to_float(column), share_y = y - to_float(row);
    const Int place = row * nodes + column;
    const auto [near_left, near_right] = gather_pairs(table, place);
    const auto [far_left, far_right] = gather_pairs(table + nodes, place);
    return mix(mix(near_left, near_right, share_x), mix(far_left, far_right, share_x), share_y);
}

// Returns the front weight for any optical depth by nine-point Gauss-Legendre quadrature over the
// optical depths below 12 (shaders/optics/piece_weights.glsl gives the reasons).
LAMINA_INLINE Float piece_front_weight(Float p, Float q) {
    constexpr float nodes[] = {
        0.015919880246187f, 0.0819844463366821f, 0.193314283649705f,  0.337873288298096f, 0.5f,
        0.662126711701904f, 0.806685716350295f,  0.9180155536633179f, 0.984080119753813f};
    constexpr float weights[] = {0.0406371941807872f, 0.0903240803474287f, 0.130305348201468f,
                                 0.156173538520001f,  0.16511967750063f,   0.156173538520001f,
                                 0.130305348201468f,  0.0903240803474287f, 0.0406371941807872f};
    constexpr float most_depth = 12;
    const Float depth = 0.5f * p + 0.5f * q;
    // Up to `place` the depth is most_depth: the root of a quadratic in p and q over `depth`.
    const Float slope = p / depth, share = most_depth / depth;
    const Float twice = share + share;
    const Float square = slope * slope + twice * (q / depth - slope);
    const Float root = sqrt(max(square, 0));
    const Float place = twice / max(slope + root, 1e-18f);
    const Float seen = select(depth > most_depth, min(place, 1), 1);
    Float sum(0);
    for (std::size_t i = 0; i < std::size(nodes); ++i) {
        const Float x = seen * nodes[i], half_x = 0.5f * x;
        const Float before = p * (1 - half_x) + q * half_x;
        sum += weights[i] * opacity_from_depth(x * before);
    }
    return 1 - seen + seen * sum;
}

// Optical depth above which pieces of exact segments are split. Up to it, the error of each
// GaussRule is at most .01 / 255.
inline constexpr float largest_piece_depth = 0.75f;

// Returns 1 - exp(-depth) for depths up to largest_piece_depth, with a relative error of 2e-5:
// interpolated at Chebyshev's nodes.
LAMINA_INLINE Float shallow_opacity(Float depth) {
    return depth * polynomial(depth, {0.99998385f, -0.49930894f, 0.16195904f, -0.031068699f});
}

// Gauss' rule on 0 .. 1.
template <std::size_t points>
struct GaussRule;
template <>
struct GaussRule<3> {
    static constexpr float nodes[] = {0.11270167f, 0.5f, 0.88729833f};
    static constexpr float weights[] = {0.27777778f, 0.44444444f, 0.27777778f};
};
template <>
struct GaussRule<4> {
    static constexpr float nodes[] = {0.069431844f, 0.33000948f, 0.66999052f, 0.93056816f};
    static constexpr float weights[] = {0.17392742f, 0.32607258f, 0.32607258f, 0.17392742f};
};

// Returns the layer coordinate of a length that is given in units of layer 1's length. Whole
// numbers are layers. It is not clamped to the last layer.
LAMINA_INLINE Float length_layer(const UniformTable& table, Float v) {
    if (table.layers == 2 || table.request.mapping == LengthMapping::linear) return v;
    if (table.request.mapping == LengthMapping::log2) {
        const Float octaves = log_of(max(v, 1)) * 1.44269504f;
        return octaves + min(v, 1);  // Kraus 2004, Equation 1
    }
    // As a whole number, the bits of a float grow linearly within each octave
    // (shaders/preintegration/uniform_table.glsl).
    const Int from_half = bits_as<Int>(v) - 0x3f000000;
    const Float octaves = to_float(from_half) * (1.0f / 8388608);
    return max(octaves, min(v, 1));
}

// A table entry for each segment. plain_entry() and colored_entry() return what the table stores,
// divided by table.scale: mean extinction or opacity and, with colour, the matching mean emission
// or associated colour. integrate_segment() returns associated colour and opacity in it.
struct SegmentEntry {
    Float color[3];
    Float value;  // mean extinction or opacity
};

// The place of each segment in the table: the number of the texel at the lower front node, lower
// back node and lower layer, and the shares of the steps from there to the upper ones.
struct SegmentPlace {
    Int texel;
    Float front, back, layer;
};

// Returns the places of segments. Scalars must be normalised so that the table covers [0, 1].
LAMINA_INLINE SegmentPlace segment_place(const UniformTable& table, float inverse_first_length,
                                         Float front, Float back, Float world_length) {
    const int nodes = table.request.scalar_nodes;
    const auto last = static_cast<float>(nodes - 1);
    const Float x = clamp01(front) * last, y = clamp01(back) * last;
    const Int column = min(to_int(x), nodes - 2), row = min(to_int(y), nodes - 2);
    Int number = row;
    Float beyond(0);
    if (table.layers > 1) {
        const Float v = world_length * inverse_first_length;
        const Float layer = min(length_layer(table, v), static_cast<float>(table.layers - 1));
        const Int below = min(to_int(layer), table.layers - 2);
        beyond = layer - to_float(below);
        number += below * nodes;
    }
    return {column + number * nodes, x - to_float(column), y - to_float(row), beyond};
}

// Interpolates in a table with one number a texel, mean extinction or opacity.
LAMINA_INLINE Float plain_entry(const UniformTable& table, const SegmentPlace& place) {
    const std::ptrdiff_t nodes = table.request.scalar_nodes;
    const auto layer_from = [&](const float* texels) LAMINA_LAMBDA {
        const auto texel = [&](std::ptrdiff_t step)
                               LAMINA_LAMBDA { return gather(texels + step, place.texel); };
        return mix(mix(texel(0), texel(1), place.front),
                   mix(texel(nodes), texel(nodes + 1), place.front), place.back);
    };
    const Float below = layer_from(table.texels.data());
    if (table.layers == 1) return below;
    return mix(below, layer_from(table.texels.data() + nodes * nodes), place.layer);
}

// Interpolates in a table with four numbers a texel, lane by lane, as these lie side by side.
LAMINA_INLINE SegmentEntry colored_entry(const UniformTable& table, const SegmentPlace& place) {
    constexpr std::size_t lanes = Float::lanes;
    alignas(64) std::int32_t numbers[lanes];
    alignas(64) float fronts[lanes], backs[lanes], layers[lanes], entries[4 * lanes];
    store(place.texel, numbers);
    store(place.front, fronts);
    store(place.back, backs);
    store(place.layer, layers);
    const std::ptrdiff_t row = std::ptrdiff_t{4} * table.request.scalar_nodes;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const Float4 front(fronts[lane]), back(backs[lane]);
        const auto layer_from = [&](const float* texels) LAMINA_LAMBDA {
            return mix(
                mix(load_unaligned<Float4>(texels), load_unaligned<Float4>(texels + 4), front),
                mix(load_unaligned<Float4>(texels + row), load_unaligned<Float4>(texels + row + 4),
                    front),
                back);
        };
        const float* const texels =
            table.texels.data() + std::ptrdiff_t{4} * static_cast<std::ptrdiff_t>(numbers[lane]);
        Float4 entry = layer_from(texels);
        if (table.layers > 1) {
            entry = mix(entry, layer_from(texels + row * table.request.scalar_nodes),
                        Float4(layers[lane]));
        }
        store(entry, entries + 4 * lane);
    }
    SegmentEntry entry;
    load_interleaved(entries, entry.color[0], entry.color[1], entry.color[2], entry.value);
    return entry;
}

// Returns associated colour and opacity of segments on which the scalar is linear from `front` to
// `back`. `single_color`: the colour for tables without colour.
LAMINA_INLINE SegmentEntry integrate_segment(const UniformTable& table, float inverse_first_length,
                                             const glm::vec3& single_color, Float front, Float back,
                                             Float world_length) {
    const SegmentPlace place =
        segment_place(table, inverse_first_length, front, back, world_length);
    const Float scale(table.scale);
    const bool opacities = table.request.store == TableStore::opacity;
    const bool colored = table.channels == 4;
    SegmentEntry entry;
    if (colored) {
        entry = colored_entry(table, place);
    } else {
        entry.value = plain_entry(table, place);
    }
    const Float opacity =
        opacities ? entry.value * scale : opacity_from_depth(entry.value * (scale * world_length));
    // In tables of extinction, colour is emission / extinction * opacity, from which the scale
    // cancels; both are 0 if the optical depth is 0.
    const Float weight = opacities ? scale : opacity / max(entry.value, 1e-37f);
    for (int channel = 0; channel < 3; ++channel) {
        entry.color[channel] =
            colored ? entry.color[channel] * weight : single_color[channel] * opacity;
    }
    entry.value = opacity;
    return entry;
}

LAMINA_SIMD_END

#endif
