// SPDX-License-Identifier: Apache-2.0
// Vector form of shaders/optics/segment_table.glsl: SegmentTable::lookup in float.
#if defined(LAMINA_TILES_SEGMENT_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_SEGMENT_TABLE_INL_H_
#undef LAMINA_TILES_SEGMENT_TABLE_INL_H_
#else
#define LAMINA_TILES_SEGMENT_TABLE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <glm/vec3.hpp>

#include "optics/segment_table.h"
#include "tiles/arithmetic-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The layer coordinate of a length that is given in units of layer 1's length. Whole numbers are
// layers. It is not clamped to the last layer.
template <class D>
HWY_INLINE hn::Vec<D> length_layer(D d, const SegmentTable& table, hn::Vec<D> v) {
    const hn::RebindToSigned<D> di;
    const auto one = hn::Set(d, 1.0f);
    if (table.layers == 2 || table.request.mapping == LengthMapping::linear) return v;
    if (table.request.mapping == LengthMapping::log2) {
        const auto octaves = hn::Mul(log_of(d, hn::Max(v, one)), hn::Set(d, 1.44269504f));
        return hn::Add(octaves, hn::Min(v, one));  // Kraus 2004, Equation 1
    }
    // The bits of a float are linear within each octave: see the shader.
    const auto from_half = hn::Sub(hn::BitCast(di, v), hn::Set(di, 0x3f000000));
    const auto octaves = hn::Mul(hn::ConvertTo(d, from_half), hn::Set(d, 1.0f / 8388608));
    return hn::Max(octaves, hn::Min(v, one));
}

// The table's entries for some segments, before they are multiplied by its scale. `color` is used
// for coloured tables.
template <class V>
struct SegmentEntry {
    V color[3];
    V value;  // mean extinction or opacity
};

// The positions of segments in the table: the number of the texel at the lower front node, back
// node and layer, and the distances beyond them.
template <class D>
struct SegmentPlace {
    hn::Vec<hn::RebindToSigned<D>> texel;
    hn::Vec<D> front, back, layer;
};

// Scalars must be normalised so that the table covers [0, 1].
template <class D>
HWY_INLINE SegmentPlace<D> segment_place(D d, const SegmentTable& table, float inverse_first_length,
                                         hn::Vec<D> front, hn::Vec<D> back,
                                         hn::Vec<D> world_length) {
    const hn::RebindToSigned<D> di;
    const int nodes = table.request.scalar_nodes;
    const auto last = hn::Set(d, static_cast<float>(nodes - 1));
    const auto most = hn::Set(di, nodes - 2);
    const auto x = hn::Mul(clamp01(d, front), last), y = hn::Mul(clamp01(d, back), last);
    const auto column = hn::Min(hn::ConvertTo(di, x), most),
               row = hn::Min(hn::ConvertTo(di, y), most);
    auto number = row;
    auto beyond = hn::Zero(d);
    if (table.layers > 1) {
        const auto v = hn::Mul(world_length, hn::Set(d, inverse_first_length));
        const auto layer =
            hn::Min(length_layer(d, table, v), hn::Set(d, static_cast<float>(table.layers - 1)));
        const auto below = hn::Min(hn::ConvertTo(di, layer), hn::Set(di, table.layers - 2));
        beyond = hn::Sub(layer, hn::ConvertTo(d, below));
        number = hn::Add(number, hn::Mul(below, hn::Set(di, nodes)));
    }
    return {hn::Add(column, hn::Mul(number, hn::Set(di, nodes))),
            hn::Sub(x, hn::ConvertTo(d, column)), hn::Sub(y, hn::ConvertTo(d, row)), beyond};
}

// For tables with one number a texel.
template <class D>
HWY_INLINE hn::Vec<D> plain_entry(D d, const SegmentTable& table, const SegmentPlace<D>& place) {
    const std::ptrdiff_t nodes = table.request.scalar_nodes;
    const auto layer_from = [&](const float* texels) HWY_ATTR {
        const auto texel = [&](std::ptrdiff_t step)
                               HWY_ATTR { return hn::GatherIndex(d, texels + step, place.texel); };
        return mix(mix(texel(0), texel(1), place.front),
                   mix(texel(nodes), texel(nodes + 1), place.front), place.back);
    };
    const auto below = layer_from(table.texels.data());
    if (table.layers == 1) return below;
    return mix(below, layer_from(table.texels.data() + nodes * nodes), place.layer);
}

// For tables with four numbers a texel. It goes lane by lane, because these lie side by side.
template <class D>
HWY_INLINE SegmentEntry<hn::Vec<D>> colored_entry(D d, const SegmentTable& table,
                                                  const SegmentPlace<D>& place) {
    const hn::FixedTag<float, 4> d4;
    const hn::RebindToSigned<D> di;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    HWY_ALIGN std::int32_t numbers[lanes];
    HWY_ALIGN float fronts[lanes], backs[lanes], layers[lanes], entries[4 * lanes];
    hn::Store(place.texel, di, numbers);
    hn::Store(place.front, d, fronts);
    hn::Store(place.back, d, backs);
    hn::Store(place.layer, d, layers);
    const std::ptrdiff_t row = std::ptrdiff_t{4} * table.request.scalar_nodes;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const auto front = hn::Set(d4, fronts[lane]), back = hn::Set(d4, backs[lane]);
        const auto layer_from = [&](const float* texels) HWY_ATTR {
            return mix(mix(hn::LoadU(d4, texels), hn::LoadU(d4, texels + 4), front),
                       mix(hn::LoadU(d4, texels + row), hn::LoadU(d4, texels + row + 4), front),
                       back);
        };
        const float* const texels =
            table.texels.data() + std::ptrdiff_t{4} * static_cast<std::ptrdiff_t>(numbers[lane]);
        auto entry = layer_from(texels);
        if (table.layers > 1) {
            entry = mix(entry, layer_from(texels + row * table.request.scalar_nodes),
                        hn::Set(d4, layers[lane]));
        }
        hn::Store(entry, d4, entries + 4 * lane);
    }
    SegmentEntry<hn::Vec<D>> entry;
    hn::LoadInterleaved4(d, entries, entry.color[0], entry.color[1], entry.color[2], entry.value);
    return entry;
}

// Associated colour and opacity of segments on which the scalar is linear from `front` to `back`.
// `single_color`: the colour for tables without colour.
template <class D>
HWY_INLINE SegmentEntry<hn::Vec<D>> integrate_segment(D d, const SegmentTable& table,
                                                      float inverse_first_length,
                                                      const glm::vec3& single_color,
                                                      hn::Vec<D> front, hn::Vec<D> back,
                                                      hn::Vec<D> world_length) {
    using V = hn::Vec<D>;
    const SegmentPlace<D> place =
        segment_place(d, table, inverse_first_length, front, back, world_length);
    const V scale = hn::Set(d, table.scale);
    const bool opacities = table.request.store == TableStore::opacity;
    const bool colored = table.channels == 4;
    SegmentEntry<V> entry;
    if (colored) {
        entry = colored_entry(d, table, place);
    } else {
        entry.value = plain_entry(d, table, place);
    }
    const V opacity =
        opacities ? hn::Mul(entry.value, scale)
                  : opacity_from_depth(d, hn::Mul(entry.value, hn::Mul(scale, world_length)));
    // Where the optical depth is 0, so is the emission. The scale cancels.
    const V weight = opacities ? scale : hn::Div(opacity, hn::Max(entry.value, hn::Set(d, 1e-37f)));
    for (int channel = 0; channel < 3; ++channel) {
        entry.color[channel] = colored ? hn::Mul(entry.color[channel], weight)
                                       : hn::Mul(hn::Set(d, single_color[channel]), opacity);
    }
    entry.value = opacity;
    return entry;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
