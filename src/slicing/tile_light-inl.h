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
#include "tiles/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// The gradient along a part of a ray, and the direction to the eye, along the grid's axes.
struct GradientLanes {
    CubicLanes along[3];
    Number to_eye[3];
};

// Two neighbours along x of the gradient map, for each lane.
struct GradientPair {
    Floats lower[3], upper[3];
};

HWY_INLINE Floats low_half(Words v) {
    const hn::Rebind<std::uint16_t, WordTag> halves;
    const hn::Rebind<hwy::float16_t, FloatTag> numbers;
    return hn::PromoteTo(FloatTag(), hn::BitCast(numbers, hn::TruncateTo(halves, v)));
}

// Four words of 32 bits for each lane and each of a cell's four rows along x, in the order of
// Corners.
using GradientRows = std::uint32_t[4][4 * most_lanes];

// Loads pairs one by one, which is faster than gathers. Where samples have no neighbour along x,
// they are their own.
inline HWY_NOINLINE void fetch_gradients(const TileBrick& brick, const std::int32_t* index,
                                         GradientRows& rows) {
    const std::size_t steps[4] = {0, static_cast<std::size_t>(brick.row),
                                  static_cast<std::size_t>(brick.slice),
                                  static_cast<std::size_t>(brick.row + brick.slice)};
    constexpr std::size_t size = sizeof(std::uint64_t);
    const bool pairs = brick.last_sample[0] > 0;
    for (std::size_t lane = 0; lane < hn::Lanes(FloatTag()); ++lane) {
        const std::uint64_t* const from = brick.gradients + static_cast<std::size_t>(index[lane]);
        for (std::size_t row = 0; row < 4; ++row) {
            std::uint32_t* const to = rows[row] + 4 * lane;
            if (pairs) {
                std::memcpy(to, from + steps[row], 2 * size);
            } else {
                std::memcpy(to, from + steps[row], size);
                std::memcpy(to + 2, from + steps[row], size);
            }
        }
    }
}

HWY_INLINE GradientPair unpack_gradients(const std::uint32_t* row) {
    Words lower_xy, lower_z, upper_xy, upper_z;
    hn::LoadInterleaved4(WordTag(), row, lower_xy, lower_z, upper_xy, upper_z);
    return {{low_half(lower_xy), low_half(hn::ShiftRight<16>(lower_xy)), low_half(lower_z)},
            {low_half(upper_xy), low_half(hn::ShiftRight<16>(upper_xy)), low_half(upper_z)}};
}

// Sets the gradients of a vector of parts from part i on, of which the first `count` are there.
HWY_INLINE GradientLanes set_gradients(const TileBrick& brick, std::size_t i, std::size_t count,
                                       CellParts& parts) {
    alignas(64) std::int32_t index[most_lanes] = {};
    std::memcpy(index, parts.index + i,
                std::min(count, hn::Lanes(FloatTag())) * sizeof(std::int32_t));
    alignas(64) GradientRows rows;
    fetch_gradients(brick, index, rows);
    Corners corners[3];
    for (std::size_t row = 0; row < 4; ++row) {
        const GradientPair pair = unpack_gradients(rows[row]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corners[axis].lower[row] = pair.lower[axis];
            corners[axis].upper[row] = pair.upper[axis];
        }
    }
    const Number place[3] = {load_number(parts.place[0] + i), load_number(parts.place[1] + i),
                             load_number(parts.place[2] + i)};
    const Number change[3] = {load_number(parts.change[0] + i), load_number(parts.change[1] + i),
                              load_number(parts.change[2] + i)};
    GradientLanes lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes.along[axis] = cubic_along(corners[axis], Number(0), place, change);
        lanes.to_eye[axis] = load_number(parts.to_eye[axis] + i);
        for (std::size_t power = 0; power < 4; ++power)
            store_number(lanes.along[axis].c[power], parts.gradient[axis][power] + i);
    }
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
    return lanes;
}

template <std::size_t channels>
HWY_INLINE EffectLanes<channels> effect_at(const TileLight& light, const GradientLanes& gradient,
                                           Number t) {
    const Number there[3] = {gradient.along[0].at(t), gradient.along[1].at(t),
                             gradient.along[2].at(t)};
    return effect_of<channels>(light, there, gradient.to_eye);
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
    const Number weight = steepest / (steepest + Number(light.smallest_square));
    return zero_unless(turns, Number(light.largest_effect) * weight);
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
    Number most = hidden_bend(light, gradient, lit.at, lit.extent);
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
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
