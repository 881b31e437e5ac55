// SPDX-License-Identifier: Apache-2.0
// Computes how light changes colours (docs/numerics.md, section 10.1), as optics/ray_lights.h does.
#if defined(LAMINA_EXECUTORS_CPU_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_CPU_LIGHT_INL_H_
#undef LAMINA_EXECUTORS_CPU_LIGHT_INL_H_
#else
#define LAMINA_EXECUTORS_CPU_LIGHT_INL_H_
#endif

#include "executors/lights.h"
#include "simd/math-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE Float dot(const Float (&a)[3], const Float (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Replaces each x, 0 to 1, by x^light.half_power. All x are multiplied side by side, because each
// product of one x waits for the product before.
template <std::size_t count>
LAMINA_INLINE void set_shine(const CpuLight& light, Float (&x)[count]) {
    if (light.whole_half_power == 0) {
        for (Float& each : x) {
            const Float log = log_of(max(each, 1e-37f));
            each = exp_of((light.half_power * log));
        }
        return;
    }
    Float power[count];
    for (Float& each : power) each = Float(1);
    for (int rest = light.whole_half_power; rest != 0; rest >>= 1) {
        for (std::size_t i = 0; i < count; ++i) {
            if ((rest & 1) != 0) power[i] = power[i] * x[i];
            x[i] *= x[i];
        }
    }
    for (std::size_t i = 0; i < count; ++i) x[i] = power[i];
}

// The effect of light on a colour c at a place: light adds c * change + highlight to c. If all
// lights are grey, one channel stands for all three.
template <std::size_t channels>
struct EffectLanes {
    Float change[channels], highlight[channels];
};

// Computes the effects at some places of a ray. g: the gradients there; `smallest_square`: square
// of Lighting::smallest_gradient, in the unit of g; `to_eye_unit`: unit vector to the eye.
template <std::size_t channels, std::size_t count>
LAMINA_INLINE void set_effects(const CpuLight& light, const Float (&g)[count][3],
                               Float smallest_square, const Float (&to_eye_unit)[3],
                               EffectLanes<channels> (&effects)[count]) {
    Float inverse_root[count], to_eye[count];
    for (std::size_t i = 0; i < count; ++i) {
        const Float square = dot(g[i], g[i]);
        inverse_root[i] = 1 / sqrt(max(square, 1e-37f));
        to_eye[i] = dot(g[i], to_eye_unit) * inverse_root[i];
        for (std::size_t c = 0; c < channels; ++c) {
            effects[i].change[c] = Float(light.ambient - 1);
            effects[i].highlight[c] = Float(0);
        }
    }
    for (const CpuLight::Direction& direction : light.directions) {
        const Float to_light[3] = {Float(direction.to_light[0]), Float(direction.to_light[1]),
                                   Float(direction.to_light[2])};
        // |l + v|^2 for unit vectors l to the light and v to the eye; 0: there is no highlight.
        const Float sum = 2 + 2 * dot(to_light, to_eye_unit);
        Float along[count], shine[count];
        for (std::size_t i = 0; i < count; ++i) {
            along[i] = to_eye[i];
            shine[i] = to_eye[i] * to_eye[i];
            if (!direction.to_eye) {
                along[i] = dot(g[i], to_light) * inverse_root[i];
                const Float both = along[i] + to_eye[i];
                const Float halfway = both * both / max(sum, 1e-12f);
                shine[i] = zero_unless(sum > 1e-6f, halfway);
            }
            shine[i] = min(shine[i], 1);
        }
        if (light.specular > 0) set_shine(light, shine);
        for (std::size_t i = 0; i < count; ++i) {
            const Float cosine = abs(along[i]);
            const Float bright = light.specular * shine[i];
            for (std::size_t c = 0; c < channels; ++c) {
                const Float color(direction.color[c]);
                effects[i].change[c] += light.diffuse * cosine * color;
                effects[i].highlight[c] += bright * color;
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Float square = dot(g[i], g[i]);
        const Float weight = square / (square + smallest_square);
        for (std::size_t c = 0; c < channels; ++c) {
            effects[i].change[c] = weight * effects[i].change[c];
            effects[i].highlight[c] = weight * effects[i].highlight[c];
        }
    }
}

template <std::size_t channels>
LAMINA_INLINE EffectLanes<channels> effect_of(const CpuLight& light, const Float (&g)[3],
                                              Float smallest_square,
                                              const Float (&to_eye_unit)[3]) {
    const Float there[1][3] = {{g[0], g[1], g[2]}};
    EffectLanes<channels> effects[1];
    set_effects(light, there, smallest_square, to_eye_unit, effects);
    return effects[0];
}

// Returns a bound on the effect of light that the nodes of a piece may miss (section 10.4).
// `square`: squared length of the gradient in the piece's middle; `reach`: largest squared distance
// of its other gradients from that one. A highlight may be missed if reach > most_turn^2 square.
// Other light has no peaks: its bound grows from 0 at most_plain_turn to all at three times that.
LAMINA_INLINE Float hidden_effect(const CpuLight& light, Float square, Float reach,
                                  Float smallest_square) {
    const FloatMask peaks = reach > light.most_turn * light.most_turn * square;
    const Float near = light.most_plain_turn * light.most_plain_turn * square;
    const Float beyond = (reach - near) / max(8 * near, 1e-37f);
    const Float share = clamp(beyond, 0, 1);
    const Float effect =
        light.plain_effect * share + zero_unless(peaks, Float(light.highlight_effect));
    // |a + b|^2 <= 2 |a|^2 + 2 |b|^2.
    const Float steepest = 2 * (square + reach);
    const Float weight = steepest / (steepest + smallest_square);
    return effect * weight;
}

// Sums of light over the three nodes of Gauss' rule, weighted by the visible opacity at each node.
// `total`: sum of the weights; `shared`: sum of changes times the nodes' shares of the interval,
// for colours that vary along the piece; `bend`: second difference of light over the nodes.
template <std::size_t channels>
struct LitNodes {
    Float total, change[channels], shared[channels], highlight[channels], bend[channels];

    LAMINA_INLINE LitNodes() : total(1e-37f) {
        for (std::size_t c = 0; c < channels; ++c)
            change[c] = shared[c] = highlight[c] = bend[c] = Float(0);
    }

    // Adds a node. `extinction`: extinction there times the piece's length; `before`: the piece's
    // optical depth in front of the node. If the piece is `deep`, only the first node counts.
    LAMINA_INLINE void add(std::size_t node, const EffectLanes<channels>& effect, Float extinction,
                           Float before, FloatMask deep, Float share) {
        const Float seen = GaussRule<3>::weights[node] * extinction * (1 - shallow_opacity(before));
        const Float amount = select(deep, Float(node == 0 ? 1.0f : 0.0f), seen);
        total += amount;
        for (std::size_t c = 0; c < channels; ++c) {
            const Float changed = amount * effect.change[c];
            change[c] += changed;
            shared[c] += share * changed;
            highlight[c] += amount * effect.highlight[c];
            const Float both = effect.change[c] + effect.highlight[c];
            bend[c] += (node == 1 ? -2 * both : both);
        }
    }

    // Returns the channels' largest bend (second difference); the rule misses .045 of it at kinks.
    LAMINA_INLINE Float largest_bend() const {
        Float most(0);
        for (const Float& each : bend) most = max(most, abs(each));
        return most;
    }
};

// Returns the share of a piece, 1/8 to 1, to which it is cut first. The error at a kink falls with
// the square of the length. The factor 1.5: most pieces hide less than their bound.
LAMINA_INLINE Float longest_piece(const CpuLight& light, Float bend) {
    const Float least(1.0f / 8), longer(1.5f);
    const Float share = light.most_bend / max(bend, 1e-30f);
    return max(min(longer * sqrt(share), 1), least);
}

// Length, as a share of a piece, below which it is not cut further.
inline constexpr float shortest_lit_piece = 1.0f / 256;

// Returns the lanes whose light bends too much for one piece, unless the piece is faint.
LAMINA_INLINE FloatMask bends(const CpuLight& light, Float bend, Float opacity) {
    return (bend > light.most_bend) & (bend * opacity > light.faint_bend);
}

LAMINA_SIMD_END

#endif
