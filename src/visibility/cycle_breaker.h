// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/order_graph.h"

namespace lamina {

// Orders the tets of one cycle (a strongly connected component) so that the constraints it breaks
// look small: the feedback arc set of Demetrescu and Finocchi (Combinatorial algorithms for
// feedback problems in directed graphs, 2003) with seen areas as weights. Best possible for a ring;
// in general no broken constraint could be kept without breaking another one, unless a component
// has more cycles than can be gone through in seconds: some are then broken wherever the search
// meets them. Keeps its memory from cycle to cycle.
class CycleBreaker {
  public:
    struct Broken {
        std::int64_t edges = 0;  // pairs of tets
        // Sum of their seen areas: bounds the part of the view where the order is wrong, because a
        // ray on which each tet comes before the next nearer one meets none in a wrong place.
        double area = 0;
    };
    // `members`: the tets of component `id`, reordered back to front. `nodes`: scratch, one a tet.
    Broken order(const OrderGraph& graph, std::span<std::int32_t> members,
                 std::span<const std::int32_t> components, std::int32_t id,
                 std::span<std::int32_t> nodes);

  private:
    struct Edge {
        std::int32_t from, to;  // nodes: places in the sorted `members`
        double area;
        double left;  // of the area, in the search for cycles
        bool kept;
    };
    enum class State : std::uint8_t { fresh, on_path, done };
    struct Node {
        std::int32_t out, in;  // where its edges begin in edges_ and in entering_
        std::int32_t next;     // edge that the search follows
        std::int32_t depth;    // on the path
        std::int32_t place;    // in the order, back to front
        State state;
        bool marked;
    };
    Node& node(std::int32_t index) { return nodes_[static_cast<std::size_t>(index)]; }
    Edge& edge(std::int32_t index) { return edges_[static_cast<std::size_t>(index)]; }
    void collect(const OrderGraph& graph, std::span<const std::int32_t> members,
                 std::span<const std::int32_t> components, std::int32_t id,
                 std::span<const std::int32_t> nodes);
    void add(std::int32_t from, std::int32_t to, double area);
    void list_entering();
    void drop_edges();
    void push(std::int32_t index);
    void thin_cycle(std::int32_t first);
    void take_back();
    bool keep(const Edge& edge);
    bool mark_nearer(std::int32_t from, std::int32_t end);
    void mark_farther(std::int32_t from, std::int32_t end);

    std::vector<Edge> edges_;             // by `from`
    std::vector<std::int32_t> entering_;  // edges by `to`
    std::vector<Node> nodes_;             // and one more for the ends
    std::vector<std::int32_t> path_;
    std::vector<std::int32_t> dropped_;
    std::vector<std::int32_t> nearer_, farther_, places_;  // of one edge that is taken back
    std::vector<std::int32_t> members_;
    std::int64_t work_ = 0;  // edges looked at
};

}  // namespace lamina
