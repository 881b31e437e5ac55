// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scene/camera.h"
#include "visibility/order_cycles.h"
#include "visibility/order_graph.h"
#include "visibility/seen_shapes.h"

namespace lamina {

// Consecutive places of a list that are drawn only in some of the pixels.
struct LimitedRun {
    std::size_t first, end;
    PixelArea pixels;
};

// Tets, or cell fragments, back to front. If they hide one another in rings, no order of whole tets
// is right for all pixels: these tets are listed several times, each time for other pixels.
template <typename Item>
struct DrawOrder {
    std::span<const Item> items;
    std::span<const LimitedRun> limited;  // ascending, disjoint; other places are for all pixels
    std::size_t first = 0;                // the place of items[0] that the runs count from

    // `count` items from the i-th on.
    DrawOrder part(std::size_t i, std::size_t count) const {
        const std::size_t begin = first + i, end = begin + count;
        const auto from = std::ranges::upper_bound(limited, begin, {}, &LimitedRun::end);
        const auto to = std::ranges::lower_bound(from, limited.end(), end, {}, &LimitedRun::first);
        return {items.subspan(i, count), {from, to}, begin};
    }
    // Returns the pixels of the i-th item, or null if these are all.
    const PixelArea* pixels(std::size_t i) const {
        if (limited.empty()) return nullptr;
        const auto run = std::ranges::upper_bound(limited, first + i, {}, &LimitedRun::end);
        return run != limited.end() && run->first <= first + i ? &run->pixels : nullptr;
    }
};

// Orders tets that hide one another in rings. No order of whole tets is right for all pixels of a
// ring, but each is right for the pixels whose rays meet none of the constraints that it breaks:
//
//   order the tets; break constraints of small seen area (CycleBreaker)
//   W = rectangle around the pixels that see a broken constraint
//   draw the tets in this order in all pixels but W
//   in W do the same with those tets and constraints that are seen there;
//     if W is more than half of the pixels: in each half of W
//     if W is one pixel: draw the tets by where its ray meets them
//
// Kraus and Ertl (Cell-projection of cyclic meshes, 2001, which is [10] of Kraus 2004) order such
// tets by rendering them in layers.
class RingOrder {
  public:
    // `near`: depth before which nothing is seen (perspective views). The graph must outlive this
    // object.
    RingOrder(const OrderGraph& graph, const View& view, double near);

    // Appends tets that are in no ring, in their order.
    void add(std::span<const std::int32_t> tets) {
        tets_.insert(tets_.end(), tets.begin(), tets.end());
    }
    // Appends the tets of a ring, a component of `cycles`.
    void add_ring(std::span<const std::int32_t> tets, const OrderCycles& cycles);

    DrawOrder<std::int32_t> order() const { return {tets_, limited_}; }
    // Returns the number of pairs of tets that overlap on a pixel's ray. No order is right for
    // these.
    std::int64_t overlapping_pairs() const;

  private:
    struct Member {
        std::int32_t tet;
        PixelArea pixels;  // that may see it
    };
    // Tet `farther` comes before tet `nearer` (indices into Problem::tets) in the pixels that see
    // `seen`.
    struct Constraint {
        std::int32_t farther, nearer;
        SeenPolygon seen;
    };
    // Tets that are to be ordered for some pixels.
    struct Problem {
        PixelArea pixels;
        std::vector<Member> tets;
        std::vector<Constraint> constraints;  // ascending `farther`
    };
    struct Solution {
        std::vector<std::int32_t> order;  // indices of tets, back to front
        PixelArea wrong;                  // around the pixels for which it is wrong
    };

    PixelArea picture() const;
    SeenPolygon seen_through(std::int32_t tet, std::int32_t edge) const;
    Solution sorted(const Problem& problem);
    void solve(const Problem& problem);
    void draw(const Problem& problem, std::span<const std::int32_t> order, const PixelArea& pixels);
    void draw_around(const Problem& problem, const Solution& solution);
    void draw_pixel(const Problem& problem, const PixelArea& pixel);

    const OrderGraph& graph_;
    PixelFinder finder_;
    CycleBreaker breaker_;
    std::vector<CycleBreaker::Edge> edges_;
    std::vector<std::int32_t> tets_;
    std::vector<LimitedRun> limited_;
    std::vector<std::pair<std::int32_t, std::int32_t>> overlapping_;
};

}  // namespace lamina
