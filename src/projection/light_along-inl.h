// SPDX-License-Identifier: Apache-2.0
// Light on segments through tets (docs/numerics.md, section 10): extinction and gradient are linear
// along them.
#if defined(LAMINA_PROJECTION_LIGHT_ALONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_LIGHT_ALONG_INL_H_
#undef LAMINA_PROJECTION_LIGHT_ALONG_INL_H_
#else
#define LAMINA_PROJECTION_LIGHT_ALONG_INL_H_
#endif

#include "executors/cpu_light-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

// A segment, or the piece of one on which the transfer function is linear.
struct LitRun {
    Float front_depth, back_depth;  // extinction at both ends, times the length
    Float gradient[3], turn[3];     // at the front, and from there to the back
    Float to_eye[3];
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
// three nodes, whose weights add up to the piece's opacity. Pieces end at kinks, and are as long as
// depth and light allow in each lane: the rule misses less than .045 of the bend of light from node
// to node to node.
template <std::size_t channels>
class LightAlong {
  public:
    LightAlong(const TileLight& light, float smallest_square, const LitRun& run)
        : light_(light), smallest_square_(smallest_square), run_(run) {
        // Limited depths have finite products.
        run_.front_depth = min(run.front_depth, deepest);
        change_ = min(run.back_depth, deepest) - run_.front_depth;
        find_kinks();
    }

    // `in_front`: transmittance in front of the segments. Lanes outside `wanted` get 0.
    LAMINA_INLINE LightSums<channels> sum(Float in_front, FloatMask wanted) {
        for (std::size_t c = 0; c < channels; ++c)
            sums_.change[c] = sums_.farther[c] = sums_.highlight[c] = Float(0);
        at_ = Float(0);
        longest_ = Float(1);
        in_front_ = in_front;
        FloatMask left = wanted & (run_.front_depth + change_ + run_.front_depth > 0);
        while (true) {
            left = left & (at_ < 1);
            left = left & (in_front_ > least_transmittance);
            if (none_of(left)) return sums_;
            add_piece(left);
        }
    }

  private:
    static constexpr float deepest = 1e12f;
    // Transmittance behind which nothing is visible.
    static constexpr float least_transmittance = 1e-5f;
    // Extent below which a piece has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;

    // Finds the places at which the gradient is perpendicular to a light; beyond the segment if
    // there is none.
    LAMINA_INLINE void find_kinks() {
        for (std::size_t i = 0; i < light_.directions.size(); ++i) {
            const TileLight::Direction& direction = light_.directions[i];
            Float from(0), change(0);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Float to_light =
                    direction.to_eye ? run_.to_eye[axis] : Float(direction.to_light[axis]);
                from += run_.gradient[axis] * to_light;
                change += run_.turn[axis] * to_light;
            }
            const FloatMask within = (from * (from + change) < 0) & (abs(change) > 0);
            kinks_[i] = select(within, (0 - from) / change, 2);
        }
    }

    struct Piece {
        Float extent;
        FloatMask last;
        Float front, depth, opacity;  // front: extinction there times the segment's length
    };

    LAMINA_INLINE Piece next_piece() const {
        Piece piece;
        const Float rest = 1 - at_;
        piece.front = max(run_.front_depth + change_ * at_, 0);
        piece.extent = min(longest_, rest);
        for (std::size_t i = 0; i < light_.directions.size(); ++i) {
            const Float to_kink = kinks_[i] - at_;
            const FloatMask ahead = (to_kink > shortest) & (to_kink < piece.extent);
            piece.extent = select(ahead, to_kink, piece.extent);
        }
        const auto depth_to = [&](Float extent) LAMINA_LAMBDA {
            return max(extent * (piece.front + 0.5f * change_ * extent), 0);
        };
        // Cuts deep pieces to the depth of a shallow one: a quadratic equation, in the form without
        // cancellation.
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
        const Float there[3] = {run_.gradient[0] + place * run_.turn[0],
                                run_.gradient[1] + place * run_.turn[1],
                                run_.gradient[2] + place * run_.turn[2]};
        return effect_of<channels>(light_, there, smallest_square_, run_.to_eye);
    }

    // Returns the bend that the nodes of the next piece may miss.
    LAMINA_INLINE Float hidden_bend(Float extent) const {
        const Float half = 0.5f * extent, middle = at_ + half;
        Float square(0), reach(0);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Float center = run_.gradient[axis] + middle * run_.turn[axis];
            const Float most = half * run_.turn[axis];
            square += center * center;
            reach += most * most;
        }
        return hidden_effect(light_, square, reach, smallest_square_);
    }

    const TileLight& light_;
    Float smallest_square_;
    LitRun run_;
    Float change_;  // change of extinction from front to back, times the length
    LightSums<channels> sums_;
    Float at_, longest_, in_front_;
    Float kinks_[Lighting::most_lights];
};

LAMINA_SIMD_END

#endif
