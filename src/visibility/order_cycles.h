// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/cycle_breaker.h"
#include "visibility/order_graph.h"

namespace lamina {

// Orders tets among which there are cycles: the strongly connected components of the graph (Tarjan,
// Depth-first search and linear graph algorithms, 1972) in an order that breaks no constraint, and
// inside each component one that breaks what looks small. Takes its memory (28 bytes a tet) when it
// is first used, more only for larger cycles.
class OrderCycles {
  public:
    static constexpr std::int32_t none = -1;

    struct Found {
        std::int64_t cycles = 0;  // components of more than one tet
        std::int64_t cyclic_tets = 0;
        CycleBreaker::Broken broken;
    };
    // Orders all tets with a farther count above zero; no edge may lead from such a tet to another
    // one. In time linear in their number (n log n in a component).
    Found order(const OrderGraph& graph);

    // What order() ordered, back to front.
    std::span<const std::int32_t> sequence() const { return sequence_; }
    // The component of more than one tet that holds the tet, or none.
    std::int32_t component(std::int32_t tet) const {
        return components_.empty() ? none : components_[static_cast<std::size_t>(tet)];
    }
    void forget();  // components of an earlier view

  private:
    struct Step {
        std::int32_t tet, edge;  // how far its edges were followed
    };
    void reserve(std::size_t tets);
    void search(const OrderGraph& graph, std::int32_t root);
    void visit(const OrderGraph& graph, std::int32_t tet);
    void finish(std::int32_t tet);

    std::vector<std::int32_t> numbers_;  // in order of discovery from 1; 0: not found yet
    std::vector<std::int32_t> lowest_;   // number that a tet's subtree reaches
    std::vector<std::int32_t> open_;     // found, component not complete
    std::vector<Step> path_;
    std::vector<std::int32_t> components_;
    std::vector<std::int32_t> memory_;  // of sequence_, which fills it from its end
    std::span<std::int32_t> sequence_;
    struct Range {
        std::size_t first, end;  // in memory_
    };
    std::vector<Range> cyclic_;  // of each component of more than one tet, by its number
    std::int32_t found_ = 0;
    bool remembers_ = false;
    CycleBreaker breaker_;
};

}  // namespace lamina
