// SPDX-License-Identifier: Apache-2.0
// What light adds to parts of rays in one cell (docs/numerics.md, section 10).
#if defined(LAMINA_SLICING_TILE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_LIGHT_INL_H_
#undef LAMINA_SLICING_TILE_LIGHT_INL_H_
#else
#define LAMINA_SLICING_TILE_LIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstring>

#include "slicing/tile_cell_optics-inl.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_gradients-inl.h"
#include "slicing/tile_light.h"
#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// The gradient along a part of a ray, the square of the smallest gradient in the same unit, and the
// direction to the eye; along the grid's axes.
struct GradientLanes {
    CubicLanes along[3];
    Number smallest_square;
    Number to_eye[3];
};

// Sets the gradients of a vector of parts from part i on, of which the first `count` are there.
HWY_INLINE GradientLanes set_gradients(const TileBrick& brick, const TileLight& light,
                                       std::size_t i, std::size_t count, CellParts& parts) {
    alignas(64) std::int32_t index[most_lanes] = {};
    std::memcpy(index, parts.index + i,
                std::min(count, hn::Lanes(FloatTag())) * sizeof(std::int32_t));
    Corners corners[3];
    const Ints largest = gradient_corners(brick, index, corners);
    const Number place[3] = {load_number(parts.place[0] + i), load_number(parts.place[1] + i),
                             load_number(parts.place[2] + i)};
    const Number change[3] = {load_number(parts.change[0] + i), load_number(parts.change[1] + i),
                              load_number(parts.change[2] + i)};
    leave_out_lower(place, change, corners);
    GradientLanes lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes.along[axis] = cubic_along(corners[axis], Number(0), place, change);
        lanes.to_eye[axis] = load_number(parts.to_eye[axis] + i);
        for (std::size_t power = 0; power < 4; ++power)
            store_number(lanes.along[axis].c[power], parts.gradient[axis][power] + i);
    }
    lanes.smallest_square = smallest_square_of(light, largest);
    store_number(lanes.smallest_square, parts.smallest_square + i);
    return lanes;
}

// Those of any parts.
HWY_INLINE GradientLanes gather_gradients(const CellParts& parts, Ints part) {
    const FloatTag d;
    GradientLanes lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t power = 0; power < 4; ++power)
            lanes.along[axis].c[power] = hn::GatherIndex(d, parts.gradient[axis][power], part);
        lanes.to_eye[axis] = hn::GatherIndex(d, parts.to_eye[axis], part);
    }
    lanes.smallest_square = hn::GatherIndex(d, parts.smallest_square, part);
    return lanes;
}

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

template <std::size_t channels>
HWY_INLINE EffectLanes<channels> effect_at(const TileLight& light, const GradientLanes& gradient,
                                           Number t) {
    const Number g[3] = {gradient.along[0].at(t), gradient.along[1].at(t), gradient.along[2].at(t)};
    return effect_of<channels>(light, g, gradient.smallest_square, gradient.to_eye);
}

// What may lie between nodes, of a piece of `extent` from `at` on: nothing where the gradient stays
// near what it is in the middle, else as much as light can do at all.
HWY_INLINE Number hidden_bend(const TileLight& light, const GradientLanes& gradient, Number at,
                              Number extent) {
    const Number half = Number(0.5f) * extent, middle = at + half;
    Number square(0), reach(0);
    for (const CubicLanes& along : gradient.along) {
        const Number center = along.at(middle);
        const Number bend = along.c[2] + Number(3) * along.c[3] * middle;
        const Number slope = hn::Abs(along.slope(middle).v);
        const Number rest = Number(hn::Abs(bend.v)) + half * Number(hn::Abs(along.c[3].v));
        const Number most = half * (slope + half * rest);
        square = square + center * center;
        reach = reach + most * most;
    }
    const FloatMask turns = reach > Number(light.most_turn * light.most_turn) * square;
    // |a + b|^2 <= 2 |a|^2 + 2 |b|^2.
    const Number steepest = Number(2) * (square + reach);
    const Number weight = steepest / (steepest + gradient.smallest_square);
    return zero_unless(turns, Number(light.largest_effect) * weight);
}

// What the rule of three nodes misses of kinks, where the gradient is perpendicular to a light, as
// a bend. A kink at k of the piece's length from an end, up to .5, costs up to .113 of what the
// cosine is at that end: k of it where k < .113, which no node sees, and less beyond.
HWY_INLINE Number hidden_kinks(const TileLight& light, const GradientLanes& gradient, Number at,
                               Number extent) {
    const Number places[3] = {at, at + Number(0.5f) * extent, at + extent};
    Number g[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            g[i][axis] = gradient.along[axis].at(places[i]);
    }
    Number beyond[2] = {Number(0), Number(0)};
    for (const TileLight::Direction& direction : light.directions) {
        const Number to_light[3] = {Number(direction.to_light[0]), Number(direction.to_light[1]),
                                    Number(direction.to_light[2])};
        const auto along = [&](std::size_t i) HWY_ATTR {
            return direction.to_eye ? dot(g[i], gradient.to_eye) : dot(g[i], to_light);
        };
        const Number middle = along(1);
        for (std::size_t end = 0; end < 2; ++end) {
            const Number there = along(2 * end);
            const Number amount = Number(direction.largest_color) * Number(hn::Abs(there.v));
            beyond[end] = beyond[end] + zero_unless(Number(0) > there * middle, amount);
        }
    }
    const Number both = beyond[0] + beyond[1];
    if (hn::AllFalse(FloatTag(), both > Number(0))) return both;
    Number most(0);
    for (std::size_t end = 0; end < 2; ++end) {
        const Number square = dot(g[2 * end], g[2 * end]);
        const Number root(hn::Sqrt(max(square, Number(1e-37f)).v));
        const Number weight = square / (square + gradient.smallest_square);
        most = max(most, weight * beyond[end] / root);
    }
    constexpr float missed = 0.113f / 0.045f;
    return Number(missed * light.diffuse) * most;
}

// A part of a ray, or a piece of one: of `extent` from `at` on.
struct LitPart {
    const LinearPart& part;
    const IntervalLanes& interval;
    Number at, extent, depth, opacity;
};

// Adds light to the part's colour by Gauss' rule with three nodes, whose weights add up to the
// part's opacity. Returns by how much light bends from node to node to node: what the rule misses
// of a kink is .045 times that.
template <std::size_t channels>
HWY_INLINE Number add_light_of(const TileLight& light, const GradientLanes& gradient,
                               const LitPart& lit, Number (&color)[3]) {
    using Rule = GaussRule<3>;
    const LinearPart& part = lit.part;
    const CubicLanes& share = part.share;
    const Number d[4] = {part.extinction + part.change * share.c[0],
                         part.change * (Number(1 / 2.0f) * share.c[1]),
                         part.change * (Number(1 / 3.0f) * share.c[2]),
                         part.change * (Number(1 / 4.0f) * share.c[3])};
    const FloatMask deep = lit.depth > Number(largest_part_depth);
    Number total(1e-37f), change[channels], shared[channels], highlight[channels], bend[channels];
    for (std::size_t c = 0; c < channels; ++c)
        change[c] = shared[c] = highlight[c] = bend[c] = Number(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const Number t(Rule::nodes[i]);
        const Number there = share.at(t);
        const Number before = t * (d[0] + t * (d[1] + t * (d[2] + t * d[3])));
        const Number extinction = max(part.extinction + part.change * there, Number(0));
        const Number seen =
            Number(Rule::weights[i]) * extinction * (Number(1) - shallow_opacity(before));
        const Number amount = select(deep, Number(i == 0 ? 1.0f : 0.0f), seen);
        const EffectLanes<channels> effect =
            effect_at<channels>(light, gradient, lit.at + t * lit.extent);
        total = total + amount;
        for (std::size_t c = 0; c < channels; ++c) {
            const Number changed = amount * effect.change[c];
            change[c] = change[c] + changed;
            shared[c] = shared[c] + there * changed;
            highlight[c] = highlight[c] + amount * effect.highlight[c];
            const Number both = effect.change[c] + effect.highlight[c];
            bend[c] = bend[c] + (i == 1 ? Number(-2) * both : both);
        }
    }
    const Number scale = lit.opacity / total;
    Number most = max(hidden_bend(light, gradient, lit.at, lit.extent),
                      hidden_kinks(light, gradient, lit.at, lit.extent));
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        const Number light_there =
            lit.interval.left[c] * change[k] + lit.interval.change[c] * shared[k] + highlight[k];
        color[c] = max(color[c] + scale * light_there, Number(0));
        most = max(most, Number(hn::Abs(bend[k].v)));
    }
    return most;
}

HWY_INLINE Number add_light(const TileLight& light, const GradientLanes& gradient,
                            const LitPart& lit, Number (&color)[3]) {
    return light.gray ? add_light_of<1>(light, gradient, lit, color)
                      : add_light_of<3>(light, gradient, lit, color);
}

// How long the first piece of a part may be: what is missed of a kink falls with the square of
// that. The next ones are as long as their light allows.
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
