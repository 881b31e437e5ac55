// SPDX-License-Identifier: Apache-2.0
#include "visibility/cycle_breaker.h"

#include <algorithm>

#include "base/interrupt.h"

namespace lamina {
namespace {

// The most edges that are examined in the search for cycles, and again while edges are taken back.
// Where tets overlap everywhere there may be more cycles than can be broken in acceptable time.
constexpr std::int64_t most_work = 200'000'000;

}  // namespace

CycleBreaker::Broken CycleBreaker::order(const OrderGraph& graph, std::span<std::int32_t> members,
                                         std::span<const std::int32_t> components, std::int32_t id,
                                         std::span<std::int32_t> nodes) {
    std::sort(members.begin(), members.end());
    for (std::size_t i = 0; i < members.size(); ++i)
        nodes[static_cast<std::size_t>(members[i])] = static_cast<std::int32_t>(i);
    collect(graph, members, components, id, nodes);
    work_ = 0;
    drop_edges();
    work_ = 0;
    take_back();

    members_.assign(members.begin(), members.end());
    for (std::size_t i = 0; i < members.size(); ++i)
        members[static_cast<std::size_t>(nodes_[i].place)] = members_[i];
    Broken broken;
    for (const Edge& edge : edges_) {
        if (node(edge.from).place < node(edge.to).place) continue;
        ++broken.edges;
        broken.area += edge.area;
    }
    return broken;
}

void CycleBreaker::collect(const OrderGraph& graph, std::span<const std::int32_t> members,
                           std::span<const std::int32_t> components, std::int32_t id,
                           std::span<const std::int32_t> nodes) {
    edges_.clear();
    nodes_.assign(members.size() + 1, {});
    for (std::size_t i = 0; i < members.size(); ++i) {
        nodes_[i].out = nodes_[i].next = static_cast<std::int32_t>(edges_.size());
        const std::int32_t tet = members[i];
        for (std::int32_t edge = graph.first_edge(tet); edge != OrderGraph::no_edge;
             edge = graph.next_edge(tet, edge)) {
            const auto nearer = static_cast<std::size_t>(graph.nearer(tet, edge));
            if (components[nearer] != id) continue;
            add(static_cast<std::int32_t>(i), nodes[nearer], graph.area(tet, edge));
        }
    }
    nodes_.back().out = static_cast<std::int32_t>(edges_.size());
    list_entering();
}

// Several pairs of faces may make one tet hide another. They are one edge.
void CycleBreaker::add(std::int32_t from, std::int32_t to, double area) {
    for (auto at = static_cast<std::size_t>(node(from).out); at < edges_.size(); ++at) {
        if (edges_[at].to != to) continue;
        edges_[at].area += area;
        edges_[at].left += area;
        return;
    }
    edges_.push_back({from, to, area, area, true});
}

void CycleBreaker::list_entering() {
    for (const Edge& edge : edges_) ++node(edge.to + 1).in;
    for (std::size_t i = 1; i < nodes_.size(); ++i) nodes_[i].in += nodes_[i - 1].in;
    entering_.resize(edges_.size());
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(edges_.size()); ++i)
        entering_[static_cast<std::size_t>(node(edge(i).to).in++)] = i;
    // Each list's start has moved to its end, which is where the next list started.
    for (std::size_t i = nodes_.size() - 1; i > 0; --i) nodes_[i].in = nodes_[i - 1].in;
    nodes_[0].in = 0;
}

// Searches for cycles depth first, subtracts the smallest area left on each cycle from all its
// edges, and drops the edges with nothing left. What is kept has no cycle. A node gets its place,
// the nearest first, when all nearer nodes are done.
void CycleBreaker::drop_edges() {
    dropped_.clear();
    path_.clear();
    const auto count = static_cast<std::int32_t>(nodes_.size()) - 1;
    std::int32_t place = count;
    for (std::int32_t root = 0; root < count; ++root) {
        if (node(root).state == State::fresh) push(root);
        while (!path_.empty()) {
            const std::int32_t index = path_.back();
            Node& top = node(index);
            const std::int32_t end = node(index + 1).out;
            while (top.next < end &&
                   (!edge(top.next).kept || node(edge(top.next).to).state == State::done))
                ++top.next;
            if (top.next == end) {
                top.state = State::done;
                top.place = --place;
                path_.pop_back();
            } else if (const std::int32_t to = edge(top.next).to; node(to).state == State::fresh) {
                push(to);
            } else if (work_ < most_work) {
                check_interrupt();
                thin_cycle(node(to).depth);
            } else {
                edge(top.next).kept = false;
                dropped_.push_back(top.next);
            }
        }
    }
}

void CycleBreaker::push(std::int32_t index) {
    node(index).state = State::on_path;
    node(index).depth = static_cast<std::int32_t>(path_.size());
    path_.push_back(index);
}

// The cycle is the path from depth `first` to its end, and the edge back. The search goes on from
// the first edge of the path that is dropped.
void CycleBreaker::thin_cycle(std::int32_t first) {
    const auto begin = path_.begin() + first;
    work_ += path_.end() - begin;
    const auto edge_of = [&](std::int32_t index) -> Edge& { return edge(node(index).next); };
    double least = edge_of(*begin).left;
    for (auto at = begin; at != path_.end(); ++at) least = std::min(least, edge_of(*at).left);
    auto cut = path_.end();
    for (auto at = begin; at != path_.end(); ++at) {
        Edge& passed = edge_of(*at);
        passed.left -= least;
        if (passed.left > 0) continue;
        passed.kept = false;
        dropped_.push_back(node(*at).next);
        if (cut == path_.end()) cut = at;
    }
    for (auto at = cut + 1; at != path_.end(); ++at) node(*at).state = State::fresh;
    path_.erase(cut + 1, path_.end());
}

// Takes dropped edges back, the largest first, where they close no cycle.
void CycleBreaker::take_back() {
    std::sort(dropped_.begin(), dropped_.end(), [&](std::int32_t a, std::int32_t b) {
        return edge(a).area != edge(b).area ? edge(a).area > edge(b).area : a < b;
    });
    for (const std::int32_t index : dropped_) {
        check_interrupt();
        Edge& dropped = edge(index);
        dropped.kept = node(dropped.from).place < node(dropped.to).place ||
                       (work_ < most_work && keep(dropped));
    }
}

// Changes the places so that the edge is kept with all others, if that is possible (Pearce and
// Kelly, A dynamic topological sort algorithm for directed acyclic graphs, 2007).
bool CycleBreaker::keep(const Edge& edge) {
    nearer_.clear();
    farther_.clear();
    const std::int32_t first = node(edge.to).place, last = node(edge.from).place;
    const bool free = mark_nearer(edge.to, last);
    if (free) mark_farther(edge.from, first);
    for (const auto* marked : {&nearer_, &farther_})
        for (const std::int32_t index : *marked) node(index).marked = false;
    if (!free) return false;
    const auto by_place = [&](std::int32_t a, std::int32_t b) {
        return node(a).place < node(b).place;
    };
    std::sort(nearer_.begin(), nearer_.end(), by_place);
    std::sort(farther_.begin(), farther_.end(), by_place);
    farther_.insert(farther_.end(), nearer_.begin(), nearer_.end());
    places_.clear();
    for (const std::int32_t index : farther_) places_.push_back(node(index).place);
    std::sort(places_.begin(), places_.end());
    for (std::size_t i = 0; i < places_.size(); ++i) node(farther_[i]).place = places_[i];
    return true;
}

// Collects the nodes that kept edges lead to before place `end`. Returns false if the node at that
// place is among them.
bool CycleBreaker::mark_nearer(std::int32_t from, std::int32_t end) {
    nearer_.push_back(from);
    node(from).marked = true;
    for (std::size_t i = 0; i < nearer_.size(); ++i) {
        work_ += node(nearer_[i] + 1).out - node(nearer_[i]).out;
        for (std::int32_t at = node(nearer_[i]).out; at < node(nearer_[i] + 1).out; ++at) {
            if (!edge(at).kept) continue;
            Node& to = node(edge(at).to);
            if (to.place == end) return false;
            if (to.place > end || to.marked) continue;
            to.marked = true;
            nearer_.push_back(edge(at).to);
        }
    }
    return true;
}

void CycleBreaker::mark_farther(std::int32_t from, std::int32_t end) {
    farther_.push_back(from);
    node(from).marked = true;
    for (std::size_t i = 0; i < farther_.size(); ++i) {
        work_ += node(farther_[i] + 1).in - node(farther_[i]).in;
        for (std::int32_t at = node(farther_[i]).in; at < node(farther_[i] + 1).in; ++at) {
            const Edge& entering = edge(entering_[static_cast<std::size_t>(at)]);
            if (!entering.kept) continue;
            Node& other = node(entering.from);
            if (other.place < end || other.marked) continue;
            other.marked = true;
            farther_.push_back(entering.from);
        }
    }
}

}  // namespace lamina
