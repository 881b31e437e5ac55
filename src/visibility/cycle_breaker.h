// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lamina {

// Orders the nodes of a graph with cycles so that the edges that it breaks have a small area. It
// computes a feedback arc set as Demetrescu and Finocchi do (Combinatorial algorithms for feedback
// problems in directed graphs, 2003), with areas as weights. For a ring the result is optimal. In
// general no broken edge could be kept without breaking another one, unless the work is cut short.
// Memory is kept from graph to graph.
class CycleBreaker {
  public:
    // An edge from a node to a nearer one.
    struct Edge {
        std::int32_t from, to;
        double area;
    };
    struct Broken {
        std::int64_t edges = 0;  // pairs of nodes
        double area = 0;         // sum of their areas
    };
    struct Order {
        std::span<const std::int32_t> places;  // of each node; 0 is the farthest
        Broken broken;
    };
    // `edges`: in ascending order of `from`; several from one node to one other count as one edge
    // with the sum of their areas. The result is valid until the next call.
    // `work`: so many edges are visited at most in the search for cycles, and again while broken
    // edges are taken back; beyond that, edges are broken wherever they close a cycle.
    Order order(std::size_t nodes, std::span<const Edge> edges, std::int64_t work);

  private:
    struct Link {
        std::int32_t from, to;
        double area;
        double left;  // area that is left in the search for cycles
        bool kept;
    };
    enum class State : std::uint8_t { fresh, on_path, done };
    struct Node {
        std::int32_t out, in;  // first place of its links in links_ and in entering_
        std::int32_t next;     // link that the search follows next
        std::int32_t depth;    // its place on the path
        std::int32_t place;    // its place in the order, back to front
        State state;
        bool marked;
    };
    Node& node(std::int32_t index) { return nodes_[static_cast<std::size_t>(index)]; }
    Link& link(std::int32_t index) { return links_[static_cast<std::size_t>(index)]; }
    void collect(std::size_t nodes, std::span<const Edge> edges);
    void add(const Edge& edge);
    void list_entering();
    void drop_links();
    void push(std::int32_t index);
    void thin_cycle(std::int32_t first);
    void take_back();
    bool keep(const Link& link);
    bool mark_nearer(std::int32_t from, std::int32_t end);
    void mark_farther(std::int32_t from, std::int32_t end);

    std::vector<Link> links_;             // sorted by `from`
    std::vector<std::int32_t> entering_;  // numbers of links, sorted by `to`
    std::vector<Node> nodes_;             // with one more at the end
    std::vector<std::int32_t> path_;
    std::vector<std::int32_t> dropped_;
    std::vector<std::int32_t> nearer_, farther_, free_;  // scratch of taking one link back
    std::vector<std::int32_t> places_;
    std::int64_t work_ = 0, most_work_ = 0;  // number of links that were visited
};

}  // namespace lamina
