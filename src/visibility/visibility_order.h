// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "scene/camera.h"
#include "visibility/order_cycles.h"
#include "visibility/order_graph.h"
#include "visibility/ring_order.h"

namespace lamina {

// Counts shared faces whose tets `order` reverses. Throws Error unless it has each tet once.
std::int64_t face_violations(const TetMesh& mesh, const Eye& eye,
                             std::span<const std::int32_t> order);

enum class OrderMethod {
    // Keeps the order across shared faces (Williams 1992); guesses it across gaps (FarthestFirst).
    mpvo,
    exact,     // also keeps the order across gaps (open_face_constraints.h)
    centroid,  // sorts by the distance of centroids, as VTK does; often wrong, for comparison
    none       // keeps the order of the mesh
};
const char* name_of(OrderMethod method);

struct OrderReport {
    std::int64_t cycles = 0;       // number of sets of tets that hide one another in a ring
    std::int64_t cyclic_tets = 0;  // number of tets in these
    // Number of pairs of tets in the wrong order; for mpvo of a nonconvex mesh, only of pairs that
    // share a face. After sort_pixels(), number of pairs that overlap and are not ordered.
    std::int64_t broken = 0;
    // Seen area of the pairs of `broken` for `exact`: bounds the area with a wrong order.
    double broken_area = 0;
};

// Sorts tets for compositing. Kahn's algorithm orders the tets of an OrderGraph that no cycle holds
// back, and OrderCycles or RingOrder orders the others; FarthestFirst guesses across gaps (mpvo).
// The order depends on mesh, method and eye alone. The mesh must outlive this object.
class VisibilityOrder {
  public:
    // `overlaps`: the mesh's TetOverlaps::pairs, which `exact` then orders by entry (EntryRule) in
    // all pixels; empty if there are none, or if they are not known.
    VisibilityOrder(const TetMesh& mesh, OrderMethod method,
                    std::span<const TetPair> overlaps = {});

    // Returns all tets back to front, for an eye anywhere, until the next call; those of rings as
    // well as possible. Calls `meanwhile` once, beside work on one core.
    std::span<const std::int32_t> sort(
        const Eye& eye, const std::function<void()>& meanwhile = [] {}) {
        return sort(eye, meanwhile, OrderCycles::all);
    }
    // Returns the tets for a view. Rings' tets are listed several times (RingOrder), to be right in
    // all pixels; if overlaps are not ordered, in those on whose ray no tets overlap. Holds for
    // `exact`, and for `mpvo` of a convex mesh. `overlapping_rings`: false if the tets of rings
    // with overlaps, or of all rings if overlaps are not known, are listed once, as by sort().
    DrawOrder<std::int32_t> sort_pixels(
        const View& view, const std::function<void()>& meanwhile = [] {},
        bool overlapping_rings = true);
    std::span<const std::int32_t> order() const { return order_; }  // result of the last sort()

    OrderMethod method() const { return method_; }
    const OrderReport& report() const { return report_; }
    // Returns the cycle (below report().cycles) that held the tet in the last sort(), or -1.
    std::int32_t cycle_of(std::int32_t tet) const { return cycles_.component(tet); }

  private:
    struct Distance {
        double distance;
        std::int32_t tet;
    };
    using RingChoice = OrderCycles::RingChoice;
    // `breaks`: tells which rings' tets are ordered as well as possible; others are in any order.
    std::span<const std::int32_t> sort(const Eye& eye, const std::function<void()>& meanwhile,
                                       const RingChoice& breaks);
    void sort_centroids(const Eye& eye);
    void sort_topologically(const RingChoice& breaks);
    std::size_t draw_free();
    void find_cycles(const RingChoice& breaks);
    void solve_rings(const View& view, const RingChoice& broken);

    const TetMesh& mesh_;
    OrderMethod method_;
    std::vector<std::int32_t> order_;
    std::vector<char> overlapping_;  // 1 for each tet that overlaps another; empty if there is none
    std::unique_ptr<OrderGraph> graph_;              // mpvo, exact
    std::unique_ptr<FarthestFirst> farthest_first_;  // mpvo of a nonconvex mesh
    std::vector<Distance> distances_;                // centroid
    OrderCycles cycles_;
    std::optional<RingOrder> rings_;  // rings of the last view that had some
    OrderReport report_;
};

}  // namespace lamina
