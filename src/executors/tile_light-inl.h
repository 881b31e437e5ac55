// SPDX-License-Identifier: Apache-2.0
// What light does to colours (docs/numerics.md, section 10): vector form of optics/ray_lights.h.
#if defined(LAMINA_EXECUTORS_TILE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_LIGHT_INL_H_
#undef LAMINA_EXECUTORS_TILE_LIGHT_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_LIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_light.h"
#include "executors/tile_number-inl.h"
#include "executors/tile_shallow-inl.h"
#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

HWY_INLINE Number dot(const Number (&a)[3], const Number (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// x^half_power, 0 <= x <= 1.
HWY_INLINE Number shine_of(const TileLight& light, Number x) {
    if (light.whole_half_power == 0) {
        const FloatTag d;
        const Number log = log_of(d, max(x, Number(1e-37f)).v);
        return exp_of(d, (Number(light.half_power) * log).v);
    }
    Number power(1);
    for (int rest = light.whole_half_power; true; x = x * x) {
        if ((rest & 1) != 0) power = power * x;
        rest >>= 1;
        if (rest == 0) return power;
    }
}

// What light does to a colour c at a place: it adds c * change + highlight. Of one channel where
// light is grey.
template <std::size_t channels>
struct EffectLanes {
    Number change[channels], highlight[channels];
};

// `smallest_square`: of the smallest gradient, in the unit of g.
template <std::size_t channels>
HWY_INLINE EffectLanes<channels> effect_of(const TileLight& light, const Number (&g)[3],
                                           Number smallest_square, const Number (&to_eye_unit)[3]) {
    const Number square = dot(g, g);
    const Number weight = square / (square + smallest_square);
    const Number inverse_root = Number(1) / Number(hn::Sqrt(max(square, Number(1e-37f)).v));
    EffectLanes<channels> effect;
    const Number to_eye = dot(g, to_eye_unit) * inverse_root;
    for (std::size_t c = 0; c < channels; ++c) {
        effect.change[c] = Number(light.ambient - 1);
        effect.highlight[c] = Number(0);
    }
    for (const TileLight::Direction& direction : light.directions) {
        Number along = to_eye, halfway_square = to_eye * to_eye;
        if (!direction.to_eye) {
            const Number to_light[3] = {Number(direction.to_light[0]),
                                        Number(direction.to_light[1]),
                                        Number(direction.to_light[2])};
            along = dot(g, to_light) * inverse_root;
            // |l + v|^2; where it is 0 there is no highlight.
            const Number sum = Number(2) + Number(2) * dot(to_light, to_eye_unit);
            const Number both = along + to_eye;
            const Number halfway = both * both / max(sum, Number(1e-12f));
            halfway_square = zero_unless(sum > Number(1e-6f), halfway);
        }
        const Number cosine = hn::Abs(along.v);
        Number shine(0);
        if (light.specular > 0)
            shine = Number(light.specular) * shine_of(light, min(halfway_square, Number(1)));
        for (std::size_t c = 0; c < channels; ++c) {
            const Number color(direction.color[c]);
            effect.change[c] = effect.change[c] + Number(light.diffuse) * cosine * color;
            effect.highlight[c] = effect.highlight[c] + shine * color;
        }
    }
    for (std::size_t c = 0; c < channels; ++c) {
        effect.change[c] = weight * effect.change[c];
        effect.highlight[c] = weight * effect.highlight[c];
    }
    return effect;
}

// What light may do between the nodes of a piece, whose gradient has this square in the middle and
// goes as far from that as the root of `reach`: nothing where it stays near, else as much as light
// can do at all.
HWY_INLINE Number hidden_effect(const TileLight& light, Number square, Number reach,
                                Number smallest_square) {
    const FloatMask turns = reach > Number(light.most_turn * light.most_turn) * square;
    // |a + b|^2 <= 2 |a|^2 + 2 |b|^2.
    const Number steepest = Number(2) * (square + reach);
    const Number weight = steepest / (steepest + smallest_square);
    return zero_unless(turns, Number(light.largest_effect) * weight);
}

// Light at the nodes of Gauss' rule with three nodes, whose amounts add up to a piece's opacity.
// `share`: where a node lies for colours that change along the piece.
template <std::size_t channels>
struct LitNodes {
    Number total, change[channels], shared[channels], highlight[channels], bend[channels];

    HWY_INLINE LitNodes() : total(1e-37f) {
        for (std::size_t c = 0; c < channels; ++c)
            change[c] = shared[c] = highlight[c] = bend[c] = Number(0);
    }

    // `extinction` and the optical depth `before` the node are those of the piece, whose length is
    // in the extinction. A `deep` piece shows its front alone.
    HWY_INLINE void add(std::size_t node, const EffectLanes<channels>& effect, Number extinction,
                        Number before, FloatMask deep, Number share) {
        const Number seen = Number(GaussRule<3>::weights[node]) * extinction *
                            (Number(1) - shallow_opacity(before));
        const Number amount = select(deep, Number(node == 0 ? 1.0f : 0.0f), seen);
        total = total + amount;
        for (std::size_t c = 0; c < channels; ++c) {
            const Number changed = amount * effect.change[c];
            change[c] = change[c] + changed;
            shared[c] = shared[c] + share * changed;
            highlight[c] = highlight[c] + amount * effect.highlight[c];
            const Number both = effect.change[c] + effect.highlight[c];
            bend[c] = bend[c] + (node == 1 ? Number(-2) * both : both);
        }
    }

    // By how much light bends from node to node to node: what the rule misses of a kink is .045
    // times that.
    HWY_INLINE Number largest_bend() const {
        Number most(0);
        for (const Number& each : bend) most = max(most, Number(hn::Abs(each.v)));
        return most;
    }
};

// How long the first piece of a part may be: what is missed of a kink falls with the square of
// that.
HWY_INLINE Number longest_piece(const TileLight& light, Number bend) {
    const Number least(1.0f / 8);
    const Number share = Number(light.most_bend) / max(bend, Number(1e-30f));
    return max(min(hn::Sqrt(share.v), Number(1)), least);
}

// Light is not looked at more closely than that.
inline constexpr float shortest_lit_piece = 1.0f / 256;

// Parts whose light bends too much for one rule.
HWY_INLINE FloatMask bends(const TileLight& light, Number bend, Number opacity) {
    return hn::And(bend > Number(light.most_bend), bend * opacity > Number(light.faint_bend));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
