// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "visibility/order_graph.h"

namespace lamina {

// Orders the tets of one cycle (a strongly connected component) so that the constraints that it
// breaks have a small seen area. It computes a feedback arc set as Demetrescu and Finocchi do
// (Combinatorial algorithms for feedback problems in directed graphs, 2003), with seen areas as
// weights. For a ring the result is optimal. In general no broken constraint could be kept without
// breaking another one. A component with more cycles than can be visited in seconds is an
// exception: then the search breaks some constraints wherever it meets them. Memory is kept from
// cycle to cycle.
class CycleBreaker {
  public:
    struct Broken {
        std::int64_t edges = 0;  // pairs of tets
        // Sum of their seen areas. It bounds the area of the view where the order is wrong: on a
        // ray that meets no broken pair, each tet comes before the next nearer one.
        double area = 0;
    };
    // `members`: the tets of component `id`; they are reordered back to front. `nodes`: scratch
    // memory, one number a tet.
    Broken order(const OrderGraph& graph, std::span<std::int32_t> members,
                 std::span<const std::int32_t> components, std::int32_t id,
                 std::span<std::int32_t> nodes);

  private:
    struct Edge {
        std::int32_t from, to;  // nodes, as places in the sorted `members`
        double area;
        double left;  // area that is left in the search for cycles
        bool kept;
    };
    enum class State : std::uint8_t { fresh, on_path, done };
    struct Node {
        std::int32_t out, in;  // first place of its edges in edges_ and in entering_
        std::int32_t next;     // edge that the search follows next
        std::int32_t depth;    // its place on the path
        std::int32_t place;    // its place in the order, back to front
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

    std::vector<Edge> edges_;             // sorted by `from`
    std::vector<std::int32_t> entering_;  // numbers of edges, sorted by `to`
    std::vector<Node> nodes_;             // with one more at the end
    std::vector<std::int32_t> path_;
    std::vector<std::int32_t> dropped_;
    std::vector<std::int32_t> nearer_, farther_, places_;  // scratch of taking one edge back
    std::vector<std::int32_t> members_;
    std::int64_t work_ = 0;  // number of edges that were visited
};

}  // namespace lamina
