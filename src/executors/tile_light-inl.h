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

// Makes each x, 0 to 1, x^half_power. Side by side, because each power waits for the one before.
template <std::size_t count>
HWY_INLINE void set_shine(const TileLight& light, Number (&x)[count]) {
    if (light.whole_half_power == 0) {
        const FloatTag d;
        for (Number& each : x) {
            const Number log = log_of(d, max(each, Number(1e-37f)).v);
            each = exp_of(d, (Number(light.half_power) * log).v);
        }
        return;
    }
    Number power[count];
    for (Number& each : power) each = Number(1);
    for (int rest = light.whole_half_power; rest != 0; rest >>= 1) {
        for (std::size_t i = 0; i < count; ++i) {
            if ((rest & 1) != 0) power[i] = power[i] * x[i];
            x[i] = x[i] * x[i];
        }
    }
    for (std::size_t i = 0; i < count; ++i) x[i] = power[i];
}

// What light does to a colour c at a place: it adds c * change + highlight. Of one channel where
// light is grey.
template <std::size_t channels>
struct EffectLanes {
    Number change[channels], highlight[channels];
};

// At some places of a ray, with the gradients g. `smallest_square`: of the smallest gradient, in
// the unit of g.
template <std::size_t channels, std::size_t count>
HWY_INLINE void set_effects(const TileLight& light, const Number (&g)[count][3],
                            Number smallest_square, const Number (&to_eye_unit)[3],
                            EffectLanes<channels> (&effects)[count]) {
    Number inverse_root[count], to_eye[count];
    for (std::size_t i = 0; i < count; ++i) {
        const Number square = dot(g[i], g[i]);
        inverse_root[i] = Number(1) / Number(hn::Sqrt(max(square, Number(1e-37f)).v));
        to_eye[i] = dot(g[i], to_eye_unit) * inverse_root[i];
        for (std::size_t c = 0; c < channels; ++c) {
            effects[i].change[c] = Number(light.ambient - 1);
            effects[i].highlight[c] = Number(0);
        }
    }
    for (const TileLight::Direction& direction : light.directions) {
        const Number to_light[3] = {Number(direction.to_light[0]), Number(direction.to_light[1]),
                                    Number(direction.to_light[2])};
        // |l + v|^2; where it is 0 there is no highlight.
        const Number sum = Number(2) + Number(2) * dot(to_light, to_eye_unit);
        Number along[count], shine[count];
        for (std::size_t i = 0; i < count; ++i) {
            along[i] = to_eye[i];
            shine[i] = to_eye[i] * to_eye[i];
            if (!direction.to_eye) {
                along[i] = dot(g[i], to_light) * inverse_root[i];
                const Number both = along[i] + to_eye[i];
                const Number halfway = both * both / max(sum, Number(1e-12f));
                shine[i] = zero_unless(sum > Number(1e-6f), halfway);
            }
            shine[i] = min(shine[i], Number(1));
        }
        if (light.specular > 0) set_shine(light, shine);
        for (std::size_t i = 0; i < count; ++i) {
            const Number cosine = hn::Abs(along[i].v);
            const Number bright = Number(light.specular) * shine[i];
            for (std::size_t c = 0; c < channels; ++c) {
                const Number color(direction.color[c]);
                effects[i].change[c] =
                    effects[i].change[c] + Number(light.diffuse) * cosine * color;
                effects[i].highlight[c] = effects[i].highlight[c] + bright * color;
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Number square = dot(g[i], g[i]);
        const Number weight = square / (square + smallest_square);
        for (std::size_t c = 0; c < channels; ++c) {
            effects[i].change[c] = weight * effects[i].change[c];
            effects[i].highlight[c] = weight * effects[i].highlight[c];
        }
    }
}

template <std::size_t channels>
HWY_INLINE EffectLanes<channels> effect_of(const TileLight& light, const Number (&g)[3],
                                           Number smallest_square, const Number (&to_eye_unit)[3]) {
    const Number there[1][3] = {{g[0], g[1], g[2]}};
    EffectLanes<channels> effects[1];
    set_effects(light, there, smallest_square, to_eye_unit, effects);
    return effects[0];
}

// What light may do between the nodes of a piece, whose gradient has this square in the middle and
// goes as far from that as the root of `reach`: nothing where it stays near. Beyond, a highlight
// may lie between the nodes; what else light does changes without peaks, and by as much as light
// can only where the gradient goes three times as far.
HWY_INLINE Number hidden_effect(const TileLight& light, Number square, Number reach,
                                Number smallest_square) {
    const FloatMask peaks = reach > Number(light.most_turn * light.most_turn) * square;
    const Number near = Number(light.most_plain_turn * light.most_plain_turn) * square;
    const Number beyond = (reach - near) / max(Number(8) * near, Number(1e-37f));
    const Number share = min(max(beyond, Number(0)), Number(1));
    const Number effect =
        Number(light.plain_effect) * share + zero_unless(peaks, Number(light.highlight_effect));
    // |a + b|^2 <= 2 |a|^2 + 2 |b|^2.
    const Number steepest = Number(2) * (square + reach);
    const Number weight = steepest / (steepest + smallest_square);
    return effect * weight;
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
// that. Half as long again, since most parts bend by less than may be hidden in them.
HWY_INLINE Number longest_piece(const TileLight& light, Number bend) {
    const Number least(1.0f / 8), longer(1.5f);
    const Number share = Number(light.most_bend) / max(bend, Number(1e-30f));
    return max(min(longer * Number(hn::Sqrt(share.v)), Number(1)), least);
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
