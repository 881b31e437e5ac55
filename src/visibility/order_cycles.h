// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "visibility/order_graph.h"

namespace lamina {

// Orders the nodes of a graph with cycles so that broken edges have a small area: a feedback arc
// set (Demetrescu and Finocchi, Combinatorial algorithms for feedback problems in directed graphs,
// 2003). It is optimal for a single ring; else no broken edge can be kept without breaking another.
class CycleBreaker {
  public:
    struct Edge {
        std::int32_t from, to;  // `from` is farther
        double area;            // the cost of breaking it
    };
    struct Broken {
        std::int64_t edges = 0;  // pairs of nodes
        double area = 0;         // sum of their areas
    };
    struct Order {
        std::span<const std::int32_t> places;  // place of each node; 0 is the farthest
        Broken broken;
    };
    // `edges`: by ascending `from`; areas of parallel edges are summed. `work`: limit on the edges
    // visited to find cycles, and again to take edges back. The result lasts until the next call.
    Order order(std::size_t nodes, std::span<const Edge> edges, std::int64_t work);

  private:
    // All edges from one node to another.
    struct Link {
        std::int32_t from, to;
        double area;
        double left;  // area minus what the cycles found so far took
        bool kept;
    };
    enum class State : std::uint8_t { fresh, on_path, done };
    struct Node {
        std::int32_t out, in;  // where its links begin in links_ and in entering_
        std::int32_t next;     // link that the search follows next
        std::int32_t depth;    // its place on the path
        std::int32_t place;    // its place in the order, back to front
        State state;
        bool marked;
    };
    Node& node(std::int32_t index) { return nodes_[index]; }
    Link& link(std::int32_t index) { return links_[index]; }
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
    std::vector<Node> nodes_;             // and one more, which ends the lists of the last
    std::vector<std::int32_t> path_;
    std::vector<std::int32_t> dropped_;
    std::vector<std::int32_t> nearer_, farther_, free_;  // working memory of keep()
    std::vector<std::int32_t> places_;
    std::int64_t work_ = 0, most_work_ = 0;  // links visited, and the limit
};

// Orders tets that hide one another in cycles. Strongly connected components (Tarjan, Depth-first
// search and linear graph algorithms, 1972) keep all constraints between them; inside, CycleBreaker
// breaks some of small seen area. Memory (28 bytes a tet) is taken at the first use.
class OrderCycles {
  public:
    static constexpr std::int32_t none = -1;

    struct Found {
        std::int64_t cycles = 0;  // number of components of more than one tet
        std::int64_t cyclic_tets = 0;
        CycleBreaker::Broken broken;
    };
    // Orders all tets whose farther count is above zero. No edge may lead from these to other tets.
    // Linear time (n log n in a component). `breaks`: tells of the tets of each component whether
    // these are ordered, too.
    using RingChoice = std::function<bool(std::span<const std::int32_t> tets)>;
    static bool all(std::span<const std::int32_t> /*tets*/) { return true; }
    Found order(const OrderGraph& graph, const RingChoice& breaks = all);

    // Returns the tets that order() ordered, back to front.
    std::span<const std::int32_t> sequence() const { return sequence_; }
    // Returns the component of more than one tet that holds `tet`, or none.
    std::int32_t component(std::int32_t tet) const {
        return components_.empty() ? none : components_[tet];
    }
    void forget();  // forgets the components of an earlier view

  private:
    struct Step {
        std::int32_t tet, edge;  // a tet on the path, and its edge to follow next
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
    std::vector<CycleBreaker::Edge> edges_;  // edges of one component
    std::vector<std::int32_t> members_;
};

}  // namespace lamina
