// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/cycle_breaker.h"
#include "visibility/order_graph.h"

namespace lamina {

// Orders tets among which there are cycles. The strongly connected components of the graph (Tarjan,
// Depth-first search and linear graph algorithms, 1972) are ordered without breaking a constraint.
// Inside each component CycleBreaker breaks constraints of small seen area, which bounds the area
// of the view where the order is wrong: on a ray that meets no broken constraint, each tet comes
// before the next nearer one. Memory (28 bytes a tet) is taken at the first use, and more only for
// larger cycles.
class OrderCycles {
  public:
    static constexpr std::int32_t none = -1;

    struct Found {
        std::int64_t cycles = 0;  // number of components of more than one tet
        std::int64_t cyclic_tets = 0;
        CycleBreaker::Broken broken;
    };
    // Orders all tets whose farther count is above zero. No edge may lead from such a tet to
    // another tet. The time is linear in their number (n log n in a component).
    // `break_rings`: the tets of each component are ordered, too; else they are in no order.
    Found order(const OrderGraph& graph, bool break_rings = true);

    // The tets that order() ordered, back to front.
    std::span<const std::int32_t> sequence() const { return sequence_; }
    // The component of more than one tet that holds the tet, or none.
    std::int32_t component(std::int32_t tet) const {
        return components_.empty() ? none : components_[static_cast<std::size_t>(tet)];
    }
    void forget();  // forgets the components of an earlier view

  private:
    struct Step {
        std::int32_t tet, edge;  // next of its edges to follow
    };
    void reserve(std::size_t tets);
    void search(const OrderGraph& graph, std::int32_t root);
    void visit(const OrderGraph& graph, std::int32_t tet);
    void finish(std::int32_t tet);
    CycleBreaker::Broken break_ring(const OrderGraph& graph, std::int32_t component);

    std::vector<std::int32_t> numbers_;  // order of discovery, from 1; 0 for a tet not found yet
    std::vector<std::int32_t> lowest_;   // lowest number that a tet's subtree reaches
    std::vector<std::int32_t> open_;     // tets that are found but whose component is not complete
    std::vector<Step> path_;
    std::vector<std::int32_t> components_;
    std::vector<std::int32_t> memory_;  // memory of sequence_, which is filled from its end
    std::span<std::int32_t> sequence_;
    struct Range {
        std::size_t first, end;  // in memory_
    };
    std::vector<Range> cyclic_;  // range of each component of more than one tet, by its number
    std::int32_t found_ = 0;
    bool remembers_ = false;
    CycleBreaker breaker_;
    std::vector<CycleBreaker::Edge> edges_;  // of one component
    std::vector<std::int32_t> members_;
};

}  // namespace lamina
