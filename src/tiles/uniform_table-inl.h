// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/preintegration/uniform_table.glsl: UniformTable::lookup in float.
#if defined(LAMINA_TILES_UNIFORM_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_UNIFORM_TABLE_INL_H_
#undef LAMINA_TILES_UNIFORM_TABLE_INL_H_
#else
#define LAMINA_TILES_UNIFORM_TABLE_INL_H_
#endif

#include <algorithm>
#include <glm/vec3.hpp>

#include "preintegration/preintegration_table.h"
#include "simd/math-inl.h"
#include "tiles/opacity-inl.h"

LAMINA_SIMD_BEGIN

// Returns the layer coordinate of a length that is given in units of layer 1's length. Whole
// numbers are layers. It is not clamped to the last layer.
LAMINA_INLINE Float length_layer(const UniformTable& table, Float v) {
    if (table.layers == 2 || table.request.mapping == LengthMapping::linear) return v;
    if (table.request.mapping == LengthMapping::log2) {
        const Float octaves = log_of(max(v, 1)) * 1.44269504f;
        return octaves + min(v, 1);  // Kraus 2004, Equation 1
    }
    // The bits of a float are linear within each octave: see the shader.
    const Int from_half = bits_as<Int>(v) - 0x3f000000;
    const Float octaves = to_float(from_half) * (1.0f / 8388608);
    return max(octaves, min(v, 1));
}

// The table's entries for a vector of segments, before they are multiplied by its scale. `color` is
// set for coloured tables.
struct SegmentEntry {
    Float color[3];
    Float value;  // mean extinction or opacity
};

// Positions of segments in the table: the number of the texel at the lower front node, back node
// and layer, and the distances beyond them.
struct SegmentPlace {
    Int texel;
    Float front, back, layer;
};

// Scalars must be normalised so that the table covers [0, 1].
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

// For tables with one number a texel.
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

// For tables with four numbers a texel. Lanes are read one by one, because the four numbers lie
// side by side.
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
    // If the optical depth is 0, so is the emission. The scale cancels.
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
