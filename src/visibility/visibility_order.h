// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "scene/camera.h"
#include "visibility/order_cycles.h"
#include "visibility/order_graph.h"
#include "visibility/ring_order.h"

namespace lamina {

// Counts the shared faces that an order gets wrong, because the tet on the far side does not come
// first. Signs are exact. `order`: every tet once, back to front; throws Error otherwise. Parallel.
std::int64_t face_violations(const TetMesh& mesh, const Eye& eye,
                             std::span<const std::int32_t> order);

enum class OrderMethod {
    // Williams 1992: keeps the order across shared faces; on nonconvex meshes with the guess of
    // FarthestFirst.
    mpvo,
    exact,     // also keeps the order across gaps (open_face_constraints.h)
    centroid,  // by the distance of centroids, as VTK does; often wrong, for comparison
    none       // in the order of the mesh
};
const char* name_of(OrderMethod method);

// Findings of the last sort().
struct OrderReport {
    std::int64_t cycles = 0;       // number of sets of tets that hide one another in a ring
    std::int64_t cyclic_tets = 0;  // number of tets in these
    // Pairs of tets in a wrong order (exact; all of them are within cycles), or faces (mpvo of a
    // nonconvex mesh). After sort_pixels(): those that are left, because the tets overlap.
    std::int64_t broken = 0;
    // Seen area (seen_area()) of these pairs, for `exact`: it bounds the area of the view in which
    // the order is wrong. 0 for mpvo's guess.
    double broken_area = 0;
};

// Sorts tets into the order in which they are to be composited, for one eye after the other. It
// takes some 10 bytes a tet once, and 28 more at the first view with cycles. sort() allocates
// memory only if a view has more constraints across gaps, or larger cycles, than all views before
// it. The order depends only on the mesh, the method and the eye. The mesh must outlive this
// object.
class VisibilityOrder {
  public:
    VisibilityOrder(const TetMesh& mesh, OrderMethod method);

    // Returns all tets back to front, for an eye anywhere, also inside the mesh. The result is
    // valid until the next call. `meanwhile` is called once, while the rest of the work uses only
    // one core.
    std::span<const std::int32_t> sort(
        const Eye& eye, const std::function<void()>& meanwhile = [] {});
    // Sorts for the pixels of a view: tets that hide one another in rings are listed several times,
    // so that every pixel is right whose ray meets no overlap (RingOrder). It is for `exact`, and
    // for `mpvo` of a convex mesh; with other methods rings stay as sort(eye) leaves them.
    DrawOrder<std::int32_t> sort_pixels(
        const View& view, const std::function<void()>& meanwhile = [] {});
    std::span<const std::int32_t> order() const { return order_; }  // result of the last sort()

    OrderMethod method() const { return method_; }
    const OrderReport& report() const { return report_; }
    // Returns the number of the cycle that held the tet in the last sort(), below report().cycles,
    // or -1.
    std::int32_t cycle_of(std::int32_t tet) const { return cycles_.component(tet); }

  private:
    struct Distance {
        double distance;
        std::int32_t tet;
    };
    void sort_centroids(const Eye& eye);
    std::span<const std::int32_t> sort_whole(const Eye& eye, bool break_rings,
                                             const std::function<void()>& meanwhile);
    void sort_farthest_first();
    void sort_topologically(bool break_rings);
    std::size_t draw_free();
    void find_cycles(bool break_rings);
    void solve_rings(const View& view);

    const TetMesh& mesh_;
    OrderMethod method_;
    std::vector<std::int32_t> order_;
    std::unique_ptr<OrderGraph> graph_;              // mpvo, exact
    std::unique_ptr<FarthestFirst> farthest_first_;  // mpvo of a nonconvex mesh
    std::vector<Distance> distances_;                // centroid
    OrderCycles cycles_;
    std::optional<RingOrder> rings_;  // rings of the last view that had some
    OrderReport report_;
};

}  // namespace lamina
