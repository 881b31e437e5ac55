// SPDX-License-Identifier: Apache-2.0
// Draws lit fragments: adds light along segments (docs/numerics.md, section 10) to their colours.
#include "projection/cpu_fragments.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "projection/cpu_lit_fragments.cpp"
#include "simd/foreach_target.h"

#include "executors/cpu_light-inl.h"
#include "projection/general_shading-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

// A segment, or the piece of one on which the transfer function is linear.
struct LitSegment {
    Float front_depth, back_depth;  // extinction at both ends, times the length
    Float gradient[3], turn[3];     // gradient at the front; its change to the back
    Float to_eye[3];                // unit vector
};

// The contribution of light: with the colour f at the front of a segment and b at its back, light
// adds f * change + (b - f) * farther + highlight. One channel is enough if light is grey.
template <std::size_t channels>
struct LightSums {
    Float change[channels], farther[channels], highlight[channels];

    LAMINA_INLINE Float added(std::size_t channel, Float front, Float back) const {
        const std::size_t c = channels == 1 ? 0 : channel;
        return front * change[c] + (back - front) * farther[c] + highlight[c];
    }
};

// Adds up the contribution of light to segments, piece by piece from the front, by Gauss' rule with
// three nodes, whose weights add up to the piece's opacity. Pieces end at kinks, where the gradient
// is perpendicular to a light. In each lane a piece is as long as its optical depth and its bend
// allow: the second difference of light at the nodes. The rule's error is below .045 of the bend.
template <std::size_t channels>
class LightAlong {
  public:
    LightAlong(const CpuLight& light, float smallest_square, const LitSegment& segment)
        : light_(light), smallest_square_(smallest_square), segment_(segment) {
        segment_.front_depth = min(segment.front_depth, deepest);
        change_ = min(segment.back_depth, deepest) - segment_.front_depth;
        find_kinks();
    }

    // `in_front`: transmittance in front of the segments. Lanes outside `wanted` get 0.
    LAMINA_INLINE LightSums<channels> sum(Float in_front, FloatMask wanted) {
        for (std::size_t c = 0; c < channels; ++c)
            sums_.change[c] = sums_.farther[c] = sums_.highlight[c] = Float(0);
        at_ = Float(0);
        longest_ = Float(1);
        in_front_ = in_front;
        FloatMask left = wanted & (segment_.front_depth + change_ + segment_.front_depth > 0);
        while (true) {
            left = left & (at_ < 1);
            left = left & (in_front_ > least_transmittance);
            if (none_of(left)) return sums_;
            add_piece(left);
        }
    }

  private:
    // Limit of extinctions times length, so that their products are finite.
    static constexpr float deepest = 1e12f;
    // The sum ends at this transmittance: light behind it is not visible.
    static constexpr float least_transmittance = 1e-5f;
    // Shortest piece, as a share of the segment; it counts as one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;

    // Finds for each light the place (0 to 1) where the gradient is perpendicular to it; else 2.
    LAMINA_INLINE void find_kinks() {
        for (std::size_t i = 0; i < light_.directions.size(); ++i) {
            const CpuLight::Direction& direction = light_.directions[i];
            Float from(0), change(0);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Float to_light =
                    direction.to_eye ? segment_.to_eye[axis] : Float(direction.to_light[axis]);
                from += segment_.gradient[axis] * to_light;
                change += segment_.turn[axis] * to_light;
            }
            const FloatMask within = (from * (from + change) < 0) & (abs(change) > 0);
            kinks_[i] = select(within, (0 - from) / change, 2);
        }
    }

    // The next piece of the segment in each lane. `last`: the piece reaches the segment's end.
    struct Piece {
        Float extent;  // share of the segment
        FloatMask last;
        Float front, depth, opacity;  // front: extinction there times the segment's length
    };

    LAMINA_INLINE Piece next_piece() const {
        Piece piece;
        const Float rest = 1 - at_;
        piece.front = max(segment_.front_depth + change_ * at_, 0);
        piece.extent = min(longest_, rest);
        for (std::size_t i = 0; i < light_.directions.size(); ++i) {
            const Float to_kink = kinks_[i] - at_;
            const FloatMask ahead = (to_kink > shortest) & (to_kink < piece.extent);
            piece.extent = select(ahead, to_kink, piece.extent);
        }
        const auto depth_to = [&](Float extent) LAMINA_LAMBDA {
            return max(extent * (piece.front + 0.5f * change_ * extent), 0);
        };
        // Cuts deep pieces to a shallow one's depth: a quadratic equation, without cancellation.
        const FloatMask deep = depth_to(piece.extent) > largest_piece_depth;
        const Float goal(0.7f), square = piece.front * piece.front + 2 * goal * change_;
        const Float root = sqrt(max(square, 0));
        const Float shallow = 2 * goal / max(piece.front + root, 1e-30f);
        piece.extent = select(deep, clamp(shallow, shortest, rest), piece.extent);
        piece.last = piece.extent >= rest;
        piece.depth = depth_to(piece.extent);
        piece.opacity = opacity_from_depth(piece.depth);
        return piece;
    }

    // Adds the next piece of each segment, or shortens it if its light bends too much for one rule.
    LAMINA_INLINE void add_piece(FloatMask left) {
        const Piece piece = next_piece();
        const FloatMask deep = piece.depth > largest_piece_depth;
        LitNodes<channels> nodes;
        for (std::size_t i = 0; i < 3; ++i) {
            const Float along = GaussRule<3>::nodes[i] * piece.extent, place = at_ + along;
            const Float before = along * (piece.front + 0.5f * change_ * along);
            const Float extinction = max(piece.front + change_ * along, 0);
            nodes.add(i, effect_at(place), extinction, before, deep, place);
        }
        advance(piece, nodes, left);
    }

    LAMINA_INLINE void advance(const Piece& piece, const LitNodes<channels>& nodes,
                               FloatMask left) {
        const Float bend = max(hidden_bend(piece.extent), nodes.largest_bend());
        const Float weight = in_front_ * piece.opacity;
        const FloatMask again = (piece.extent > shortest_lit_piece) & bends(light_, bend, weight);
        const FloatMask done = without(left, again);
        const Float scale = zero_unless(done, weight / nodes.total);
        for (std::size_t c = 0; c < channels; ++c) {
            sums_.change[c] += scale * nodes.change[c];
            sums_.farther[c] += scale * nodes.shared[c];
            sums_.highlight[c] += scale * nodes.highlight[c];
        }
        in_front_ -= zero_unless(done, weight);
        at_ = select(done, select(piece.last, Float(1), at_ + piece.extent), at_);
        const Float shorter = piece.extent * min(longest_piece(light_, bend), 0.5f);
        longest_ = select(again, shorter, max(longest_, 2 * piece.extent));
    }

    LAMINA_INLINE EffectLanes<channels> effect_at(Float place) const {
        const Float there[3] = {segment_.gradient[0] + place * segment_.turn[0],
                                segment_.gradient[1] + place * segment_.turn[1],
                                segment_.gradient[2] + place * segment_.turn[2]};
        return effect_of<channels>(light_, there, smallest_square_, segment_.to_eye);
    }

    // Returns a bound on the bend of light within the next piece that its three nodes may not show.
    LAMINA_INLINE Float hidden_bend(Float extent) const {
        const Float half = 0.5f * extent, middle = at_ + half;
        Float square(0), reach(0);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Float center = segment_.gradient[axis] + middle * segment_.turn[axis];
            const Float most = half * segment_.turn[axis];
            square += center * center;
            reach += most * most;
        }
        return hidden_effect(light_, square, reach, smallest_square_);
    }

    const CpuLight& light_;
    Float smallest_square_;
    LitSegment segment_;
    Float change_;  // change of extinction from front to back, times the length
    LightSums<channels> sums_;
    // The walk's place on the segment, the longest next piece, and the transmittance before it.
    Float at_, longest_, in_front_;
    Float kinks_[Lighting::most_lights];
};

// Gradients, and the direction to the eye, along a segment from front to back.
struct SegmentGradients {
    Float front[3], back[3], to_eye[3];

    // Returns the piece between two places, each a share (0 to 1) of the segment.
    LAMINA_INLINE LitSegment between(Float from, Float to, Float front_depth,
                                     Float back_depth) const {
        LitSegment segment;
        segment.front_depth = front_depth;
        segment.back_depth = back_depth;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Float turn = back[axis] - front[axis];
            segment.gradient[axis] = front[axis] + from * turn;
            segment.turn[axis] = (to - from) * turn;
            segment.to_eye[axis] = to_eye[axis];
        }
        return segment;
    }
};

// A piece of a segment on which colour is linear from `near` to `far`; `unlit`: its colour without
// light, as it reaches the front of the segment.
struct LitEnds {
    Float near[3], far[3];
    Float unlit[3];
};

template <std::size_t channels>
LAMINA_INLINE void add_channels(const TetFragments& fragments, const LitSegment& segment,
                                Float in_front, FloatMask wanted, const LitEnds& piece,
                                Float (&color)[3]) {
    const LightSums<channels> sums =
        LightAlong<channels>(*fragments.light, fragments.smallest_square, segment)
            .sum(in_front, wanted);
    for (std::size_t c = 0; c < 3; ++c) {
        const Float sum = piece.unlit[c] + sums.added(c, piece.near[c], piece.far[c]);
        // Only rounding makes the sum less than 0, because light only multiplies colour.
        color[c] += max(sum, 0);
    }
}

LAMINA_INLINE void add_lit(const TetFragments& fragments, const LitSegment& segment, Float in_front,
                           FloatMask wanted, const LitEnds& piece, Float (&color)[3]) {
    if (fragments.light->gray) {
        add_channels<1>(fragments, segment, in_front, wanted, piece, color);
    } else {
        add_channels<3>(fragments, segment, in_front, wanted, piece, color);
    }
}

// A Shader (tet_drawing-inl.h) for plans with light.
struct LitShader {
    static constexpr bool lit = true, scalars = true, opacity_only = false;
    const TetFragments& fragments;
    bool cut, perspective;

    explicit LitShader(const TetFragments& of)
        : fragments(of), cut(of.source == SegmentSource::parts), perspective(of.perspective) {}

    LAMINA_NOINLINE Fragment lit_color(const TileBatch& batch, std::size_t number,
                                       const PlacedRay& found) const {
        const SilhouetteRecord& record = batch.record(number);
        const SeenTet& seen = record.seen();
        const Float column = found.column, row = found.row;
        SegmentGradients gradient;
        const Float slant = find_eye(seen, column, row, gradient);
        const bool by_depth = fragments.slanted;
        const TetSpan ends =
            find_ends(*this, fragments, record, found.span, by_depth ? slant : Float(1));
        const Float aside = column * seen.scalar_per_column + row * seen.scalar_per_row;
        const FragmentSegment segment =
            has_exact_segments(fragments, batch.area(number))
                ? find_exact_segment(*this, fragments, record, found, by_depth)
                : segment_between(*this, record, ends, aside);
        find_gradients(batch.gradient(number), column, row, ends, gradient);
        return cut ? cell_fragment_lit(batch, number, segment, gradient)
                   : analytic_lit(segment, gradient);
    }
    LAMINA_INLINE void put(const TetFragments&, std::uint32_t number, const Fragment& fragment,
                           const TetTile& tile, std::size_t place) const {
        put_fragments(fragments, number, fragment, tile, place);
    }

  private:
    // Sets the direction to the eye; returns the length of the ray per unit of z.
    LAMINA_INLINE Float find_eye(const SeenTet& record, Float column, Float row,
                                 SegmentGradients& gradient) const {
        const auto& [right, up, forward] = fragments.axes;
        if (!perspective) {
            for (int axis = 0; axis < 3; ++axis) gradient.to_eye[axis] = Float(-forward[axis]);
            return Float(1);
        }
        const float pixel = fragments.pixel_size;
        const Float x = (column + (record.center[0] - fragments.image_middle.x)) * pixel,
                    y = (row + (record.center[1] - fragments.image_middle.y)) * pixel;
        const Float slant = sqrt(1 + (x * x + y * y));
        for (int axis = 0; axis < 3; ++axis) {
            const Float along = forward[axis] + x * right[axis] + y * up[axis];
            gradient.to_eye[axis] = (0 - along) / slant;
        }
        return slant;
    }

    LAMINA_INLINE static void find_gradients(const GradientRecord& record, Float column, Float row,
                                             const TetSpan& ends, SegmentGradients& gradient) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const GradientRecord::Component& of = record.components[axis];
            const Float aside = column * of.per_column + row * of.per_row;
            const auto at = [&](const TetSpanEnd& end) LAMINA_LAMBDA {
                const Float sum = of.at_center + end.from_center * of.per_z + end.z * aside;
                // Only rounding in slivers makes a gradient longer than those at the corners.
                return clamp(sum, -1, 1);
            };
            gradient.front[axis] = at(ends.front);
            gradient.back[axis] = at(ends.back);
        }
    }

    LAMINA_INLINE Fragment cell_fragment_lit(const TileBatch& batch, std::size_t number,
                                             const FragmentSegment& segment,
                                             const SegmentGradients& gradient) const {
        const FragmentRecord& record = batch.record(number).fragment;
        const Fragment unlit =
            cell_fragment_color(true, GeneralShader::depth_of(fragments, batch.area(number)),
                                fragments, record, segment);
        const auto optics = [&](std::size_t i, Float place) LAMINA_LAMBDA {
            return mix(Float(record.low[i]), Float(record.high[i]), place);
        };
        LitEnds piece{{}, {}, {unlit.red, unlit.green, unlit.blue}};
        for (std::size_t c = 0; c < 3; ++c) {
            piece.near[c] = optics(c, segment.front);
            piece.far[c] = optics(c, segment.back);
        }
        const LitSegment lit_segment =
            gradient.between(0, 1, optics(3, segment.front) * segment.world_length,
                             optics(3, segment.back) * segment.world_length);
        Float color[3] = {0, 0, 0};
        add_lit(fragments, lit_segment, 1, unlit.alpha > 0, piece, color);
        return {color[0], color[1], color[2], unlit.alpha};
    }

    LAMINA_INLINE Fragment analytic_lit(const FragmentSegment& segment,
                                        const SegmentGradients& gradient) const {
        Float color[3] = {0, 0, 0};
        const Float front = segment.front, back = segment.back;
        const Float per_scalar = 1 / abs(back - front);
        const auto place = [&](Float scalar)
                               LAMINA_LAMBDA { return abs(scalar - front) * per_scalar; };
        Float depth(0), transmittance(1), from(0);
        const auto add = [&](const AnalyticPiece& piece) LAMINA_LAMBDA {
            const Float opacity = opacity_from_depth(piece.depth);
            const EndWeights weights = end_weights(piece, opacity);
            const Float to = select(piece.last, Float(1), place(piece.next_scalar));
            LitEnds ends;
            for (std::size_t c = 0; c < 3; ++c) {
                ends.near[c] = piece.near(c);
                ends.far[c] = piece.far(c);
                const Float shown = weights.near * ends.near[c] + weights.far * ends.far[c];
                ends.unlit[c] = transmittance * shown;
            }
            const FloatMask wanted = piece.counted & (opacity > 0);
            add_lit(fragments, gradient.between(from, to, piece.p, piece.q), transmittance, wanted,
                    ends, color);
            depth += piece.depth;
            transmittance *= 1 - opacity;
            from = to;
        };
        for_each_analytic_piece(*fragments.transfer, front, back, segment.world_length, add);
        return {color[0], color[1], color[2], opacity_from_depth(depth)};
    }
};

std::int64_t draw_lit(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    TetDrawing drawing(fragments, batch, tile);
    drawing.draw(LitShader(fragments));
    return drawing.fragments();
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(draw_lit);

std::int64_t draw_lit_tets(const TetFragments& fragments, const TileBatch& batch,
                           const TetTile& tile) {
    return LAMINA_DISPATCH(draw_lit)(fragments, batch, tile);
}

}  // namespace lamina
#endif
