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

// The gradient along a part of a ray, the square of the smallest gradient in the same unit, and the
// direction to the eye; along the grid's axes.
struct GradientLanes {
    CubicLanes along[3];
    Number smallest_square;
    Number to_eye[3];
};

// Two words of 32 bits for each lane, of the lower and the upper of two neighbours along x, and for
// each of a cell's four rows along x, in the order of Corners.
using GradientRows = std::uint32_t[4][4 * most_lanes];

// Loads pairs one by one, which is faster than gathers. Where samples have no neighbour along x,
// they are their own.
inline HWY_NOINLINE void fetch_gradients(const TileBrick& brick, const std::int32_t* index,
                                         GradientRows& rows) {
    const std::size_t steps[4] = {0, static_cast<std::size_t>(brick.row),
                                  static_cast<std::size_t>(brick.slice),
                                  static_cast<std::size_t>(brick.row + brick.slice)};
    constexpr std::size_t size = sizeof(StoredGradient);
    const bool pairs = brick.last_sample[0] > 0;
    for (std::size_t lane = 0; lane < hn::Lanes(FloatTag()); ++lane) {
        const StoredGradient* const from = brick.gradients + static_cast<std::size_t>(index[lane]);
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

// Stored gradients (slicing/gradient_map.h): x below y, and z below the exponent.
struct GradientWords {
    Ints xy, z;
    HWY_INLINE Ints exponent() const { return hn::ShiftRight<16>(z); }
};

HWY_INLINE Floats low_component(Ints words) {
    return hn::ConvertTo(FloatTag(), hn::ShiftRight<16>(hn::ShiftLeft<16>(words)));
}
HWY_INLINE Floats high_component(Ints words) {
    return hn::ConvertTo(FloatTag(), hn::ShiftRight<16>(words));
}

// The gradients of a cell's corners, `lower` and `upper` on x, have the unit 2^(largest -
// unit_octaves) together, where `largest` is their largest exponent. So the largest component is
// 2^46 up to 2^47, and squares of gradients 1e31 times as small are numbers, too.
constexpr int unit_octaves = 32;

// 2^exponent, 0 where that is too small.
HWY_INLINE Floats power_of_two(Ints exponent) {
    const IntTag di;
    const Ints biased = hn::Max(hn::Add(exponent, hn::Set(di, 127)), hn::Zero(di));
    return hn::BitCast(FloatTag(), hn::ShiftLeft<23>(biased));
}

// The square of the smallest gradient, in the unit of gradients with this largest exponent. It is
// kept to what float32 can square: outside, all or nothing is lit.
HWY_INLINE Number smallest_square_of(const TileLight& light, Ints largest) {
    constexpr int most = 62;
    const IntTag di;
    const Ints exponent = hn::Sub(hn::Set(di, light.smallest.exponent + unit_octaves), largest);
    const Ints kept = hn::Min(hn::Max(exponent, hn::Set(di, -most)), hn::Set(di, most));
    const Number smallest = Number(light.smallest.mantissa) * Number(power_of_two(kept));
    return smallest * smallest;
}

HWY_INLINE void set_corner(const GradientWords& words, Ints largest, std::size_t row, bool upper,
                           Corners (&corners)[3]) {
    const Ints octaves = hn::Sub(words.exponent(), largest);
    const Floats scale = power_of_two(hn::Add(octaves, hn::Set(IntTag(), unit_octaves)));
    const Floats components[3] = {low_component(words.xy), high_component(words.xy),
                                  low_component(words.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Floats& to = upper ? corners[axis].upper[row] : corners[axis].lower[row];
        to = hn::Mul(components[axis], scale);
    }
}

// Returns the largest exponent.
HWY_INLINE Ints unpack_gradients(const GradientRows& rows, Corners (&corners)[3]) {
    GradientWords lower[4], upper[4];
    Ints largest = hn::Set(IntTag(), StoredGradient::no_exponent);
    for (std::size_t row = 0; row < 4; ++row) {
        Words words[4];
        hn::LoadInterleaved4(WordTag(), rows[row], words[0], words[1], words[2], words[3]);
        lower[row] = {hn::BitCast(IntTag(), words[0]), hn::BitCast(IntTag(), words[1])};
        upper[row] = {hn::BitCast(IntTag(), words[2]), hn::BitCast(IntTag(), words[3])};
        largest = hn::Max(largest, hn::Max(lower[row].exponent(), upper[row].exponent()));
    }
    for (std::size_t row = 0; row < 4; ++row) {
        set_corner(lower[row], largest, row, false, corners);
        set_corner(upper[row], largest, row, true, corners);
    }
    return largest;
}

// Replaces the lower corners on an axis by the upper ones.
HWY_INLINE void take_upper(std::size_t axis, FloatMask lanes, Corners& corners) {
    const auto take = [&](Floats& lower, Floats upper)
                          HWY_ATTR { lower = hn::IfThenElse(lanes, upper, lower); };
    const std::size_t rows[2][4] = {{0, 2, 1, 3},
                                    {0, 1, 2, 3}};  // of y and z: two lower, two upper
    for (std::size_t i = 0; axis == 0 && i < 4; ++i) take(corners.lower[i], corners.upper[i]);
    for (std::size_t i = 0; axis > 0 && i < 2; ++i) {
        const std::size_t lower = rows[axis - 1][i], upper = rows[axis - 1][i + 2];
        take(corners.lower[lower], corners.lower[upper]);
        take(corners.upper[lower], corners.upper[upper]);
    }
}

// Where rays run beyond the last samples (`cell` axes), or along a face, only the upper corners
// count: the lower ones may be too long to be subtracted again.
HWY_INLINE void leave_out_lower(const Number (&place)[3], const Number (&change)[3],
                                Corners (&corners)[3]) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const FloatMask beyond = hn::And(place[axis] >= Number(1), change[axis] == Number(0));
        if (hn::AllFalse(FloatTag(), beyond)) continue;
        for (Corners& component : corners) take_upper(axis, beyond, component);
    }
}

// Of the cells with the lowest corners `index`. Returns the largest exponent.
HWY_INLINE Ints gradient_corners(const TileBrick& brick, const std::int32_t* index,
                                 Corners (&corners)[3]) {
    alignas(64) GradientRows rows;
    fetch_gradients(brick, index, rows);
    return unpack_gradients(rows, corners);
}

// The gradient at a point of a cell, and the square of the smallest gradient in the same unit.
struct PointGradient {
    Number along[3];
    Number smallest_square;
};
HWY_INLINE PointGradient gradient_at(const TileBrick& brick, const TileLight& light,
                                     const std::int32_t* index, const Floats (&share)[3]) {
    Corners corners[3];
    const Ints largest = gradient_corners(brick, index, corners);
    leave_out_lower({share[0], share[1], share[2]}, {Number(0), Number(0), Number(0)}, corners);
    PointGradient gradient;
    for (std::size_t axis = 0; axis < 3; ++axis)
        gradient.along[axis] = interpolate(corners[axis], share[0], share[1], share[2]);
    gradient.smallest_square = smallest_square_of(light, largest);
    return gradient;
}

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
