// SPDX-License-Identifier: Apache-2.0
// What light adds to parts of rays in one cell (docs/numerics.md, section 10).
#if defined(LAMINA_SLICING_TILE_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_TILE_LIGHT_INL_H_
#undef LAMINA_SLICING_TILE_LIGHT_INL_H_
#else
#define LAMINA_SLICING_TILE_LIGHT_INL_H_
#endif

#include <cstring>

#include "executors/tile_light-inl.h"
#include "slicing/tile_cell_optics-inl.h"
#include "slicing/tile_cell_parts-inl.h"
#include "slicing/tile_gradients-inl.h"

LAMINA_SIMD_BEGIN

// The gradient along a part of a ray, the square of the smallest gradient in the same unit, and the
// direction to the eye; along the grid's axes.
struct GradientLanes {
    CubicLanes along[3];
    Float smallest_square;
    Float to_eye[3];
};

// Sets the gradients of the `members` of a vector of parts from part i on. The others have any.
// `rows`: kept from vector to vector.
LAMINA_INLINE GradientLanes set_gradients(const TileBrick& brick, FloatMask members, std::size_t i,
                                          const TileLight& light, const CellParts& parts,
                                          GradientRows& rows) {
    Corners corners[3];
    const Int largest = gradient_corners(brick, parts.index + i, bits_of(members), rows, corners);
    const Float place[3] = {load<Float>(parts.place[0] + i), load<Float>(parts.place[1] + i),
                            load<Float>(parts.place[2] + i)};
    const Float change[3] = {load<Float>(parts.change[0] + i), load<Float>(parts.change[1] + i),
                             load<Float>(parts.change[2] + i)};
    leave_out_lower(place, change, corners);
    GradientLanes lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes.along[axis] = cubic_along(corners[axis], Float(0), place, change);
        lanes.to_eye[axis] = load<Float>(parts.to_eye[axis] + i);
    }
    lanes.smallest_square = smallest_square_of(light, largest);
    return lanes;
}

// The gradient at the nodes of a piece.
struct GradientNodes {
    Float g[3][3];  // by node and axis
};

// Returns what the nodes of a piece of `extent` from `at` on may not see.
LAMINA_INLINE Float hidden_bend(const TileLight& light, const GradientLanes& gradient,
                                const GradientNodes& nodes, Float at, Float extent) {
    const Float half = 0.5f * extent, middle = at + half;
    Float reach(0);
    for (const CubicLanes& along : gradient.along) {
        const Float bend = along.c[2] + 3 * along.c[3] * middle;
        const Float slope = abs(along.c[1] + middle * (along.c[2] + bend));
        const Float rest = abs(bend) + half * abs(along.c[3]);
        const Float most = half * (slope + half * rest);
        reach += most * most;
    }
    const Float square = dot(nodes.g[1], nodes.g[1]);
    return hidden_effect(light, square, reach, gradient.smallest_square);
}

// The component of the gradient along a direction.
LAMINA_INLINE CubicLanes component_along(const GradientLanes& gradient,
                                         const Float (&direction)[3]) {
    CubicLanes component;
    for (std::size_t power = 0; power < 4; ++power)
        component.c[power] = gradient.along[0].c[power] * direction[0] +
                             gradient.along[1].c[power] * direction[1] +
                             gradient.along[2].c[power] * direction[2];
    return component;
}

// What the rule of three nodes misses of kinks, where the gradient is perpendicular to a light, as
// a bend. A kink at k of the piece's length from an end, up to .5, costs up to .113 of what the
// cosine is at that end: k of it where k < .113, which no node sees, and less beyond.
LAMINA_INLINE Float hidden_kinks(const TileLight& light, const GradientLanes& gradient, Float at,
                                 Float extent) {
    const Float ends[2] = {at, at + extent};
    Float beyond[2] = {Float(0), Float(0)};
    for (const TileLight::Direction& direction : light.directions) {
        const Float to_light[3] = {Float(direction.to_light[0]), Float(direction.to_light[1]),
                                   Float(direction.to_light[2])};
        const CubicLanes cosine =
            component_along(gradient, direction.to_eye ? gradient.to_eye : to_light);
        const Float middle = cosine.at(at + 0.5f * extent);
        for (std::size_t end = 0; end < 2; ++end) {
            const Float there = cosine.at(ends[end]);
            const Float amount = direction.largest_color * abs(there);
            beyond[end] += zero_unless(0 > there * middle, amount);
        }
    }
    const Float both = beyond[0] + beyond[1];
    if (none_of(both > 0)) return both;
    Float most(0);
    for (std::size_t end = 0; end < 2; ++end) {
        const Float g[3] = {gradient.along[0].at(ends[end]), gradient.along[1].at(ends[end]),
                            gradient.along[2].at(ends[end])};
        const Float square = dot(g, g);
        const Float root = sqrt(max(square, 1e-37f));
        const Float weight = square / (square + gradient.smallest_square);
        most = max(most, weight * beyond[end] / root);
    }
    constexpr float missed = 0.113f / 0.045f;
    return missed * light.diffuse * most;
}

// A part of a ray, or a piece of one: of `extent` from `at` on.
template <bool curved>
struct LitPart {
    const RayPart<curved>& part;
    const IntervalLanes<curved>& interval;
    Float at, extent, depth, opacity;
};

// Adds light to the part's colour by Gauss' rule with three nodes. Returns by how much it bends.
template <std::size_t channels, bool curved>
LAMINA_INLINE Float add_light_of(const TileLight& light, const GradientLanes& gradient,
                                 const LitPart<curved>& lit, Float (&color)[3]) {
    const RayPart<curved>& part = lit.part;
    const CubicLanes mean_depth = part.mean_depth();
    const FloatMask deep = lit.depth > largest_part_depth;
    GradientNodes gradients;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float place = lit.at + GaussRule<3>::nodes[i] * lit.extent;
        for (std::size_t axis = 0; axis < 3; ++axis)
            gradients.g[i][axis] = gradient.along[axis].at(place);
    }
    EffectLanes<channels> effects[3];
    set_effects(light, gradients.g, gradient.smallest_square, gradient.to_eye, effects);
    LitNodes<channels> nodes;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float t(GaussRule<3>::nodes[i]);
        const Float there = part.share.at(t);
        nodes.add(i, effects[i], part.extinction_at(t, there), t * mean_depth.at(t), deep, there);
    }
    const Float scale = lit.opacity / nodes.total;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        const Float light_there = lit.interval.left[c] * nodes.change[k] +
                                  lit.interval.change[c] * nodes.shared[k] + nodes.highlight[k];
        color[c] = max(color[c] + scale * light_there, 0);
    }
    const Float hidden = max(hidden_bend(light, gradient, gradients, lit.at, lit.extent),
                             hidden_kinks(light, gradient, lit.at, lit.extent));
    return max(nodes.largest_bend(), hidden);
}

template <bool curved>
LAMINA_INLINE Float add_light(const TileLight& light, const GradientLanes& gradient,
                              const LitPart<curved>& lit, Float (&color)[3]) {
    return light.gray ? add_light_of<1>(light, gradient, lit, color)
                      : add_light_of<3>(light, gradient, lit, color);
}

LAMINA_SIMD_END

#endif
