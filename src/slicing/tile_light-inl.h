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

#include "executors/tile_light-inl.h"
#include "slicing/tile_cell_optics-inl.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_gradients-inl.h"
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
                                       std::size_t i, std::size_t count, const CellParts& parts) {
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
    }
    lanes.smallest_square = smallest_square_of(light, largest);
    return lanes;
}

template <std::size_t channels>
HWY_INLINE EffectLanes<channels> effect_at(const TileLight& light, const GradientLanes& gradient,
                                           Number t) {
    const Number there[3] = {gradient.along[0].at(t), gradient.along[1].at(t),
                             gradient.along[2].at(t)};
    return effect_of<channels>(light, there, gradient.smallest_square, gradient.to_eye);
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
template <bool curved>
struct LitPart {
    const RayPart<curved>& part;
    const IntervalLanes<curved>& interval;
    Number at, extent, depth, opacity;
};

// Adds light to the part's colour by Gauss' rule with three nodes, whose weights add up to the
// part's opacity. Returns by how much light bends from node to node to node: what the rule misses
// of a kink is .045 times that.
template <std::size_t channels, bool curved>
HWY_INLINE Number add_light_of(const TileLight& light, const GradientLanes& gradient,
                               const LitPart<curved>& lit, Number (&color)[3]) {
    using Rule = GaussRule<3>;
    const RayPart<curved>& part = lit.part;
    const CubicLanes& share = part.share;
    const CubicLanes mean_depth = part.mean_depth();
    const FloatMask deep = lit.depth > Number(largest_part_depth);
    Number total(1e-37f), change[channels], shared[channels], highlight[channels], bend[channels];
    for (std::size_t c = 0; c < channels; ++c)
        change[c] = shared[c] = highlight[c] = bend[c] = Number(0);
    for (std::size_t i = 0; i < 3; ++i) {
        const Number t(Rule::nodes[i]);
        const Number there = share.at(t);
        const Number seen = Number(Rule::weights[i]) * part.extinction_at(t, there) *
                            (Number(1) - shallow_opacity(t * mean_depth.at(t)));
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

template <bool curved>
HWY_INLINE Number add_light(const TileLight& light, const GradientLanes& gradient,
                            const LitPart<curved>& lit, Number (&color)[3]) {
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
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
