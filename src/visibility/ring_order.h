// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <utility>

#include "mesh/few_points.h"
#include "scene/camera.h"
#include "visibility/order_cycles.h"
#include "visibility/order_graph.h"

namespace lamina {

// Consecutive items of a DrawOrder, places first .. end - 1, that are drawn only in some pixels.
struct LimitedItems {
    std::size_t first, end;
    PixelArea pixels;
};

// Items to draw (tets, or cell fragments), back to front. If tets hide one another in rings, no
// order is right for all pixels. Such tets are listed several times, each time for other pixels.
template <typename Item>
struct DrawOrder {
    std::span<const Item> items;
    std::span<const LimitedItems> limited;  // ascending, disjoint; other items are for all pixels
    std::size_t first = 0;                  // the place of items[0], as `limited` counts places

    DrawOrder subrange(std::size_t i, std::size_t count) const {
        const std::size_t begin = first + i, end = begin + count;
        const auto from = std::ranges::upper_bound(limited, begin, {}, &LimitedItems::end);
        const auto to =
            std::ranges::lower_bound(from, limited.end(), end, {}, &LimitedItems::first);
        return {items.subspan(i, count), {from, to}, begin};
    }
    // Returns the pixels of the i-th item, or null if these are all.
    const PixelArea* pixels(std::size_t i) const {
        if (limited.empty()) return nullptr;
        const auto limited_items =
            std::ranges::upper_bound(limited, first + i, {}, &LimitedItems::end);
        return limited_items != limited.end() && limited_items->first <= first + i
                   ? &limited_items->pixels
                   : nullptr;
    }
};

// A convex polygon in pixels, rows downwards; the centre of pixel (i, j) is at (i, j). It has at
// most the corners of the overlap of two triangles, cut by the near plane to at most 4 corners; one
// of them may first have been cut by a plane, to at most 5.
using SeenPolygon = FewPoints<glm::dvec2, 9>;

// Projects triangles and points to pixels, in perspective from z = `near` on; no pixel is lost.
class PixelFinder {
  public:
    PixelFinder(const View& view, double near) : window_(view), near_(near) {}

    // Projects the corners of a convex polygon in a plane.
    SeenPolygon polygon(std::span<const glm::dvec3> corners) const;
    // Returns the pixels of the picture whose rays may meet the hull of some points.
    PixelArea pixels_of(std::span<const glm::dvec3> points) const;
    const View& view() const { return window_.view(); }
    PixelArea picture() const { return {0, view().width - 1, 0, view().height - 1}; }

  private:
    glm::dvec2 place_of(const glm::dvec3& seen) const;

    WindowView window_;
    double near_;
};

// Draws the tets of rings. An order of tets is right for all pixels whose rays meet none of the
// constraints that it breaks:
//   order the tets; break constraints of small seen area (CycleBreaker)
//   W = rectangle around the pixels that see a broken constraint
//   draw the tets in this order in all pixels outside W
//   in W do the same with those tets and constraints that are seen in W;
//     if W is more than half of the pixels: in each half of W
//     if W is one pixel: draw the tets by where its ray meets them; if the graph orders tets that
//     overlap, by where its ray enters them (EntryRule)
// Kraus and Ertl (Cell-projection of cyclic meshes, 2001) render such tets in layers.
class RingOrder {
  public:
    // The graph must outlive this object.
    RingOrder(const OrderGraph& graph, const View& view, double near);

    // Appends tets that are in no ring and already in visibility order.
    void add(std::span<const std::int32_t> tets) {
        tets_.insert(tets_.end(), tets.begin(), tets.end());
    }
    // Appends the tets of a ring, a component of `cycles`.
    void add_ring(std::span<const std::int32_t> tets, const OrderCycles& cycles);

    DrawOrder<std::int32_t> order() const { return {tets_, limited_}; }
    // Returns the number of pairs of tets that overlap on the ray of a pixel that was ordered
    // alone. Unless the graph orders overlaps, no order is right there.
    std::int64_t overlapping_pairs() const;

  private:
    struct Member {
        std::int32_t tet;
        PixelArea pixels;  // pixels that may see the tet
    };
    // Indices of two tets: `farther` must be drawn before `nearer` in the pixels that see `seen`.
    struct Constraint {
        std::int32_t farther, nearer;
        SeenPolygon seen;
    };
    // Tets to draw in some pixels, with the constraints on their order.
    struct Problem {
        PixelArea pixels;
        std::vector<Member> tets;
        std::vector<Constraint> constraints;  // ascending `farther`
    };
    struct Solution {
        std::vector<std::int32_t> order;  // indices of tets, back to front
        PixelArea wrong;  // rectangle around the pixels for which the order is wrong
    };

    SeenPolygon seen_through(std::int32_t tet, std::int32_t edge) const;
    Solution sorted(const Problem& problem);
    void solve(const Problem& problem);
    void draw(const Problem& problem, std::span<const std::int32_t> order, const PixelArea& pixels);
    void draw_around(const Problem& problem, const Solution& solution);
    View::Ray ray_of(const PixelArea& pixel) const;
    static bool is_dense(const Problem& problem, const PixelArea& pixels);
    void draw_pixels(const Problem& problem, const PixelArea& pixels);
    void draw_pixel(const Problem& problem, const PixelArea& pixel);
    void draw_row(const Problem& problem, const PixelArea& row);
    void draw_by_entry(const Problem& problem, std::span<const std::int32_t> tets,
                       const PixelArea& pixel);

    const OrderGraph& graph_;
    PixelFinder finder_;
    CycleBreaker breaker_;
    std::vector<CycleBreaker::Edge> edges_;
    std::vector<std::int32_t> tets_;
    std::vector<LimitedItems> limited_;
    std::vector<std::pair<std::int32_t, std::int32_t>> overlapping_;
};

}  // namespace lamina
