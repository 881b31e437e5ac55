// SPDX-License-Identifier: Apache-2.0
// Adds light to segments (docs/numerics.md, section 10.4; numbers in brackets are equations there).
//
//   g(t) = the gradient along the segment: on each axis a cubic (9.1) of the corners' gradients
//   for each of the three nodes of Gauss' rule: the change of colour and the highlight there (10.2)
//   add both to the colour, weighted by the visible opacity at the node
//   return the bend: the second difference of light over the nodes, or more if kinks or highlights
//       may lie between the nodes; the caller cuts pieces that bend too much
#if defined(LAMINA_SLICING_CPU_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_LIGHT_INL_H_
#undef LAMINA_SLICING_CPU_LIGHT_INL_H_
#else
#define LAMINA_SLICING_CPU_LIGHT_INL_H_
#endif

#include "executors/cpu_light-inl.h"
#include "slicing/cpu_optics-inl.h"
#include "slicing/cpu_walk-inl.h"

LAMINA_SIMD_BEGIN

// The gradients at the corners of cells: for each of a cell's four rows along x, in the order of
// Corners, four words a lane, two for the gradient at the lower x and two for that at the upper x.
using GradientRows = std::uint32_t[4][4 * most_lanes];

// Does what fetch_gradients() does, from pages, whose samples always have a neighbour along x.
inline LAMINA_NOINLINE void fetch_paged_gradients(const CpuPages& pages, const std::int32_t* index,
                                                  std::uint32_t lanes, GradientRows& rows) {
    constexpr std::size_t steps[4] = {0, BrickCache::row, BrickCache::slice,
                                      BrickCache::slice + BrickCache::row};
    constexpr std::size_t size = sizeof(StoredGradient);
    std::int32_t wanted[most_lanes];
    std::size_t lane_of[most_lanes], count = 0;
    for_each_lane(lanes, [&](std::size_t lane) {
        wanted[count] = index[lane];
        lane_of[count++] = lane;
    });
    visit_pages(pages, wanted, count, [&](std::size_t i, const std::byte* page, std::size_t place) {
        const std::byte* const from = page + pages.gradients_at + size * place;
        for (std::size_t row = 0; row < 4; ++row)
            std::memcpy(rows[row] + 4 * lane_of[i], from + size * steps[row], 2 * size);
    });
}

// Fetches the gradients at cells' corners for a set of lanes; others keep their values. Copying
// pairs is faster than gathers. A sample without a neighbour along x is its own neighbour.
inline LAMINA_NOINLINE void fetch_gradients(const CpuBrick& brick, const std::int32_t* index,
                                            std::uint32_t lanes, GradientRows& rows) {
    const std::size_t steps[4] = {0, static_cast<std::size_t>(brick.row),
                                  static_cast<std::size_t>(brick.slice),
                                  static_cast<std::size_t>(brick.row + brick.slice)};
    constexpr std::size_t size = sizeof(StoredGradient);
    if (brick.pages != nullptr) return fetch_paged_gradients(*brick.pages, index, lanes, rows);
    const bool pairs = brick.last_sample[0] > 0;
    for_each_lane(lanes, [&](std::size_t lane) {
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
    });
}

// The two words of a StoredGradient (slicing/gradient_map.h), each of two 16-bit numbers: x in the
// low half and y in the high one; z in the low half and the exponent in the high one.
struct GradientWords {
    Int xy, z;
    LAMINA_INLINE Int exponent() const { return shift_right<16>(z); }
};

// Gradients at a cell's corners get a common unit, 2^(largest exponent - unit_octaves). So their
// largest component is 2^46 to 2^47, and squares of gradients 1e31 times as small fit a float.
constexpr int unit_octaves = 32;

// Returns 2^(exponent - 127), or 0 if that is too small.
LAMINA_INLINE Float power_of_biased(Int exponent) {
    return bits_as<Float>(shift_left<23>(max(exponent, 0)));
}

// Returns the square of Lighting::smallest_gradient in the unit that belongs to `largest`, limited
// to numbers that float32 can square: beyond these, everything or nothing is lit.
LAMINA_INLINE Float smallest_square_of(const CpuLight& light, Int largest) {
    constexpr int most = 62;
    const Int exponent = light.smallest.exponent + unit_octaves - largest;
    const Int kept = clamp(exponent, -most, most);
    const Float smallest = light.smallest.mantissa * power_of_biased(kept + 127);
    return smallest * smallest;
}

// Converts the gradients at one corner of each cell to the cell's unit. `unit` + a gradient's
// exponent is the biased exponent of the factor.
LAMINA_INLINE void set_corner(const GradientWords& words, Int unit, std::size_t row, bool upper,
                              Corners (&corners)[3]) {
    const Float scale = power_of_biased(words.exponent() + unit);
    // Each component times 2^16: its 16 bits are moved to the upper half of a word.
    const Float components[3] = {to_float(shift_left<16>(words.xy)),
                                 to_float(without(words.xy, Int(0xffff))),
                                 to_float(shift_left<16>(words.z))};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Float& to = upper ? corners[axis].upper[row] : corners[axis].lower[row];
        to = components[axis] * scale;
    }
}

// Sets the gradients at corners, by axis, in each cell's unit. Returns the largest exponent.
LAMINA_INLINE Int unpack_gradients(const GradientRows& rows, Corners (&corners)[3]) {
    GradientWords lower[4], upper[4];
    Int largest(StoredGradient::no_exponent);
    for (std::size_t row = 0; row < 4; ++row) {
        Word words[4];
        load_interleaved(rows[row], words[0], words[1], words[2], words[3]);
        lower[row] = {bits_as<Int>(words[0]), bits_as<Int>(words[1])};
        upper[row] = {bits_as<Int>(words[2]), bits_as<Int>(words[3])};
        largest = max(largest, max(lower[row].exponent(), upper[row].exponent()));
    }
    const Int unit = 127 - 16 + unit_octaves - largest;
    for (std::size_t row = 0; row < 4; ++row) {
        set_corner(lower[row], unit, row, false, corners);
        set_corner(upper[row], unit, row, true, corners);
    }
    return largest;
}

// Replaces the lower corners on an axis by the upper ones.
LAMINA_INLINE void take_upper(std::size_t axis, FloatMask lanes, Corners& corners) {
    const auto take = [&](Float& lower, Float upper)
                          LAMINA_LAMBDA { lower = select(lanes, upper, lower); };
    // For y and for z: the two lower corners, then the two upper ones.
    const std::size_t rows[2][4] = {{0, 2, 1, 3}, {0, 1, 2, 3}};
    for (std::size_t i = 0; axis == 0 && i < 4; ++i) take(corners.lower[i], corners.upper[i]);
    for (std::size_t i = 0; axis > 0 && i < 2; ++i) {
        const std::size_t lower = rows[axis - 1][i], upper = rows[axis - 1][i + 2];
        take(corners.lower[lower], corners.lower[upper]);
        take(corners.upper[lower], corners.upper[upper]);
    }
}

// Replaces lower corners by upper ones on axes on which a ray stays at place 1, in a face or beyond
// the last samples. Their weight is 0, but a long gradient there would cost the others' digits.
LAMINA_INLINE void leave_out_lower(const Float (&place)[3], const Float (&change)[3],
                                   Corners (&corners)[3]) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const FloatMask beyond = (place[axis] >= 1) & (change[axis] == 0);
        if (none_of(beyond)) continue;
        for (Corners& component : corners) take_upper(axis, beyond, component);
    }
}

// The gradient at a point of a cell, and the square of Lighting::smallest_gradient in its unit.
struct PointGradient {
    Float along[3];
    Float smallest_square;
};
LAMINA_INLINE PointGradient gradient_at(const CpuBrick& brick, const CpuLight& light,
                                        const std::int32_t* index, const Float (&share)[3]) {
    Corners corners[3];
    alignas(64) GradientRows rows;
    const std::uint32_t all_lanes = (1u << Float::lanes) - 1;
    fetch_gradients(brick, index, all_lanes, rows);
    const Int largest = unpack_gradients(rows, corners);
    leave_out_lower({share[0], share[1], share[2]}, {Float(0), Float(0), Float(0)}, corners);
    PointGradient gradient;
    for (std::size_t axis = 0; axis < 3; ++axis)
        gradient.along[axis] = interpolate(corners[axis], share[0], share[1], share[2]);
    gradient.smallest_square = smallest_square_of(light, largest);
    return gradient;
}

// The gradient along a segment, the square of Lighting::smallest_gradient in the same unit, and the
// direction to the eye, all along the grid's axes.
struct GradientLanes {
    CubicLanes along[3];
    Float smallest_square;
    Float to_eye[3];
};

// Returns the gradients along the `members` of the segments from i on; other lanes are undefined.
// `rows`: memory to work in, whose lanes outside `members` must have been set once.
LAMINA_INLINE GradientLanes set_gradients(const CpuBrick& brick, FloatMask members, std::size_t i,
                                          const CpuLight& light, const CellSegments& segments,
                                          GradientRows& rows) {
    Corners corners[3];
    fetch_gradients(brick, segments.index + i, bits_of(members), rows);
    const Int largest = unpack_gradients(rows, corners);
    const auto [place, change] = segments.paths_from(i);
    leave_out_lower(place, change, corners);
    GradientLanes lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lanes.along[axis] = cubic_along(corners[axis], Float(0), place, change);
        lanes.to_eye[axis] = load<Float>(segments.to_eye[axis] + i);
    }
    lanes.smallest_square = smallest_square_of(light, largest);
    return lanes;
}

// Returns a bound on light that Gauss' rule may miss between its nodes, expressed as a bend. The
// piece reaches from t = at to at + extent; `middle_gradient` is the gradient at its middle node.
LAMINA_INLINE Float hidden_bend(const CpuLight& light, const GradientLanes& gradient,
                                const Float (&middle_gradient)[3], Float at, Float extent) {
    const Float half = 0.5f * extent, middle = at + half;
    Float reach(0);
    for (const CubicLanes& along : gradient.along) {
        const Float bend = along.c[2] + 3 * along.c[3] * middle;
        const Float slope = abs(along.c[1] + middle * (along.c[2] + bend));
        const Float rest = abs(bend) + half * abs(along.c[3]);
        const Float most = half * (slope + half * rest);
        reach += most * most;
    }
    const Float square = dot(middle_gradient, middle_gradient);
    return hidden_effect(light, square, reach, gradient.smallest_square);
}

// Returns the scalar product of the gradient and a direction, along a segment.
LAMINA_INLINE CubicLanes component_along(const GradientLanes& gradient,
                                         const Float (&direction)[3]) {
    CubicLanes component;
    for (std::size_t power = 0; power < 4; ++power)
        component.c[power] = gradient.along[0].c[power] * direction[0] +
                             gradient.along[1].c[power] * direction[1] +
                             gradient.along[2].c[power] * direction[2];
    return component;
}

// Returns a bound, as a bend, on the error of the rule with three nodes at kinks. Light has a kink
// if the gradient becomes perpendicular to its direction. A kink in the middle of a piece causes an
// error of .045 of the bend. A kink near an end causes up to .113 of the cosine at that end,
// because no node lies within .113 of the piece's length from it.
LAMINA_INLINE Float hidden_kinks(const CpuLight& light, const GradientLanes& gradient, Float at,
                                 Float extent) {
    const Float ends[2] = {at, at + extent};
    Float beyond[2] = {Float(0), Float(0)};
    for (const CpuLight::Direction& direction : light.directions) {
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

// The piece of a segment from t = at to at + extent, with its optical depth and opacity.
template <bool curved>
struct LitPiece {
    const PieceOptics<curved>& piece;
    const IntervalLanes<curved>& interval;
    Float at, extent, depth, opacity;
};

// Adds light to the piece's colour by Gauss' rule with three nodes. Returns the bend, which bends()
// compares with its limits.
template <std::size_t channels, bool curved>
LAMINA_INLINE Float add_light_of(const CpuLight& light, const GradientLanes& gradient,
                                 const LitPiece<curved>& lit, Float (&color)[3]) {
    const PieceOptics<curved>& piece = lit.piece;
    const CubicLanes mean_depth = piece.mean_depth();
    const FloatMask deep = lit.depth > largest_piece_depth;
    Float gradients[3][3];  // by node and axis
    for (std::size_t i = 0; i < 3; ++i) {
        const Float place = lit.at + GaussRule<3>::nodes[i] * lit.extent;
        for (std::size_t axis = 0; axis < 3; ++axis)
            gradients[i][axis] = gradient.along[axis].at(place);
    }
    EffectLanes<channels> effects[3];
    set_effects(light, gradients, gradient.smallest_square, gradient.to_eye, effects);
    LitNodes<channels> nodes;
    for (std::size_t i = 0; i < 3; ++i) {
        const Float t(GaussRule<3>::nodes[i]);
        const Float there = piece.share.at(t);
        nodes.add(i, effects[i], piece.extinction_at(t, there), t * mean_depth.at(t), deep, there);
    }
    const Float scale = lit.opacity / nodes.total;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = channels == 1 ? 0 : c;
        const Float light_there = lit.interval.left[c] * nodes.change[k] +
                                  lit.interval.change[c] * nodes.shared[k] + nodes.highlight[k];
        color[c] = max(color[c] + scale * light_there, 0);
    }
    const Float hidden = max(hidden_bend(light, gradient, gradients[1], lit.at, lit.extent),
                             hidden_kinks(light, gradient, lit.at, lit.extent));
    return max(nodes.largest_bend(), hidden);
}

template <bool curved>
LAMINA_INLINE Float add_light(const CpuLight& light, const GradientLanes& gradient,
                              const LitPiece<curved>& lit, Float (&color)[3]) {
    return light.gray ? add_light_of<1>(light, gradient, lit, color)
                      : add_light_of<3>(light, gradient, lit, color);
}

LAMINA_SIMD_END

#endif
