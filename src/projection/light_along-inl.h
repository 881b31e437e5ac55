// SPDX-License-Identifier: Apache-2.0
// What light adds to runs through tets (docs/numerics.md, section 10): extinction and gradient are
// linear along them.
#if defined(LAMINA_PROJECTION_LIGHT_ALONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_LIGHT_ALONG_INL_H_
#undef LAMINA_PROJECTION_LIGHT_ALONG_INL_H_
#else
#define LAMINA_PROJECTION_LIGHT_ALONG_INL_H_
#endif

#include <hwy/highway.h>

#include "executors/tile_light-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// A run, or the piece of one on which the transfer function is linear.
struct LitRun {
    Number front_depth, back_depth;  // extinction at both ends, times the length
    Number gradient[3], turn[3];     // at the front, and from there to the back
    Number to_eye[3];
};

// Where the colour at the front of a run is f and that at its back b, light adds
// f * change + (b - f) * farther + highlight. Of one channel where light is grey.
template <std::size_t channels>
struct LightSums {
    Number change[channels], farther[channels], highlight[channels];

    HWY_INLINE Number added(std::size_t channel, Number front, Number back) const {
        const std::size_t c = channels == 1 ? 0 : channel;
        return front * change[c] + (back - front) * farther[c] + highlight[c];
    }
};

// Sums up what light adds to runs, piece by piece from the front, by Gauss' rule with three nodes,
// whose weights add up to the piece's opacity. Pieces end at kinks, and are as long as depth and
// light allow in each lane: of light that bends the rule misses less than .045 of how much it does
// so from node to node to node.
template <std::size_t channels>
class LightAlong {
  public:
    LightAlong(const TileLight& light, float smallest_square, const LitRun& run)
        : light_(light), smallest_square_(smallest_square), run_(run) {
        // Products of depths are numbers.
        run_.front_depth = min(run.front_depth, Number(deepest));
        change_ = min(run.back_depth, Number(deepest)) - run_.front_depth;
        find_kinks();
    }

    // `in_front`: transmittance in front of the runs. Lanes outside `wanted` get 0.
    HWY_INLINE LightSums<channels> sum(Number in_front, FloatMask wanted) {
        const FloatTag d;
        for (std::size_t c = 0; c < channels; ++c)
            sums_.change[c] = sums_.farther[c] = sums_.highlight[c] = Number(0);
        at_ = Number(0);
        longest_ = Number(1);
        in_front_ = in_front;
        FloatMask left = hn::And(wanted, run_.front_depth + change_ + run_.front_depth > Number(0));
        while (true) {
            left = hn::And(left, at_ < Number(1));
            left = hn::And(left, in_front_ > Number(least_transmittance));
            if (hn::AllFalse(d, left)) return sums_;
            add_piece(left);
        }
    }

  private:
    static constexpr float deepest = 1e12f;
    // Nothing behind this transmittance can be seen.
    static constexpr float least_transmittance = 1e-5f;
    // A piece this short has one colour, whatever its depth.
    static constexpr float shortest = 1e-6f;

    // Where the gradient is perpendicular to a light; beyond the run where it is nowhere.
    HWY_INLINE void find_kinks() {
        for (std::size_t i = 0; i < light_.directions.size(); ++i) {
            const TileLight::Direction& direction = light_.directions[i];
            Number from(0), change(0);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const Number to_light =
                    direction.to_eye ? run_.to_eye[axis] : Number(direction.to_light[axis]);
                from = from + run_.gradient[axis] * to_light;
                change = change + run_.turn[axis] * to_light;
            }
            const FloatMask within =
                hn::And(from * (from + change) < Number(0), Number(hn::Abs(change.v)) > Number(0));
            kinks_[i] = select(within, (Number(0) - from) / change, Number(2));
        }
    }

    struct Piece {
        Number extent;
        FloatMask last;
        Number front, depth, opacity;  // front: extinction there times the run's length
    };

    HWY_INLINE Piece next_piece() const {
        Piece piece;
        const Number rest = Number(1) - at_;
        piece.front = max(run_.front_depth + change_ * at_, Number(0));
        piece.extent = min(longest_, rest);
        for (std::size_t i = 0; i < light_.directions.size(); ++i) {
            const Number to_kink = kinks_[i] - at_;
            const FloatMask ahead = hn::And(to_kink > Number(shortest), to_kink < piece.extent);
            piece.extent = select(ahead, to_kink, piece.extent);
        }
        const auto depth_to = [&](Number extent) HWY_ATTR {
            return max(extent * (piece.front + Number(0.5f) * change_ * extent), Number(0));
        };
        // To the depth of a shallow piece: a quadratic equation, in the form without cancellation.
        const FloatMask deep = depth_to(piece.extent) > Number(largest_part_depth);
        const Number goal(0.7f), square = piece.front * piece.front + Number(2) * goal * change_;
        const Number root = hn::Sqrt(max(square, Number(0)).v);
        const Number shallow = Number(2) * goal / max(piece.front + root, Number(1e-30f));
        piece.extent = select(deep, min(max(shallow, Number(shortest)), rest), piece.extent);
        piece.last = piece.extent >= rest;
        piece.depth = depth_to(piece.extent);
        piece.opacity = opacity_from_depth(FloatTag(), piece.depth.v);
        return piece;
    }

    // Adds the next piece of each run, or shortens it where its light bends too much for one rule.
    HWY_INLINE void add_piece(FloatMask left) {
        const Piece piece = next_piece();
        const FloatMask deep = piece.depth > Number(largest_part_depth);
        LitNodes<channels> nodes;
        for (std::size_t i = 0; i < 3; ++i) {
            const Number along = Number(GaussRule<3>::nodes[i]) * piece.extent, place = at_ + along;
            const Number before = along * (piece.front + Number(0.5f) * change_ * along);
            const Number extinction = max(piece.front + change_ * along, Number(0));
            nodes.add(i, effect_at(place), extinction, before, deep, place);
        }
        advance(piece, nodes, left);
    }

    HWY_INLINE void advance(const Piece& piece, const LitNodes<channels>& nodes, FloatMask left) {
        const Number bend = max(hidden_bend(piece.extent), nodes.largest_bend());
        const Number weight = in_front_ * piece.opacity;
        const FloatMask again =
            hn::And(piece.extent > Number(shortest_lit_piece), bends(light_, bend, weight));
        const FloatMask done = hn::AndNot(again, left);
        const Number scale = zero_unless(done, weight / nodes.total);
        for (std::size_t c = 0; c < channels; ++c) {
            sums_.change[c] = sums_.change[c] + scale * nodes.change[c];
            sums_.farther[c] = sums_.farther[c] + scale * nodes.shared[c];
            sums_.highlight[c] = sums_.highlight[c] + scale * nodes.highlight[c];
        }
        in_front_ = in_front_ - zero_unless(done, weight);
        at_ = select(done, select(piece.last, Number(1), at_ + piece.extent), at_);
        const Number shorter = piece.extent * min(longest_piece(light_, bend), Number(0.5f));
        longest_ = select(again, shorter, max(longest_, Number(2) * piece.extent));
    }

    HWY_INLINE EffectLanes<channels> effect_at(Number place) const {
        const Number there[3] = {run_.gradient[0] + place * run_.turn[0],
                                 run_.gradient[1] + place * run_.turn[1],
                                 run_.gradient[2] + place * run_.turn[2]};
        return effect_of<channels>(light_, there, smallest_square_, run_.to_eye);
    }

    // Returns what the nodes of the next piece may not see.
    HWY_INLINE Number hidden_bend(Number extent) const {
        const Number half = Number(0.5f) * extent, middle = at_ + half;
        Number square(0), reach(0);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Number center = run_.gradient[axis] + middle * run_.turn[axis];
            const Number most = half * run_.turn[axis];
            square = square + center * center;
            reach = reach + most * most;
        }
        return hidden_effect(light_, square, reach, smallest_square_);
    }

    const TileLight& light_;
    Number smallest_square_;
    LitRun run_;
    Number change_;  // of extinction from front to back, times the length
    LightSums<channels> sums_;
    Number at_, longest_, in_front_;
    Number kinks_[Lighting::most_lights];
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
