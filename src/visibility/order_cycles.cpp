// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_cycles.h"

#include <algorithm>
#include <limits>

namespace lamina {
namespace {

// The most edges that are visited to break the cycles of a component: some seconds. If tets overlap
// everywhere, there may be more cycles than can be broken in acceptable time.
constexpr std::int64_t most_work = 200'000'000;

constexpr std::int32_t complete = std::numeric_limits<std::int32_t>::max();

}  // namespace

void OrderCycles::reserve(std::size_t tets) {
    if (memory_.size() == tets) return;
    lowest_.resize(tets);
    open_.reserve(tets);
    path_.reserve(tets);
    components_.resize(tets);
    memory_.resize(tets);
    remembers_ = true;
}

void OrderCycles::forget() {
    if (remembers_) std::fill(components_.begin(), components_.end(), none);
    remembers_ = false;
}

OrderCycles::Found OrderCycles::order(const OrderGraph& graph, bool break_rings) {
    const auto counts = graph.farther_counts();
    reserve(counts.size());
    forget();
    remembers_ = true;
    numbers_.assign(counts.size(), 0);
    cyclic_.clear();
    found_ = 0;
    sequence_ = std::span(memory_).last(0);
    for (std::size_t tet = 0; tet < counts.size(); ++tet) {
        if (counts[tet] > 0 && numbers_[tet] == 0) search(graph, static_cast<std::int32_t>(tet));
    }

    Found found;
    for (std::size_t id = 0; id < cyclic_.size(); ++id) {
        ++found.cycles;
        found.cyclic_tets += static_cast<std::int64_t>(cyclic_[id].end - cyclic_[id].first);
        if (!break_rings) continue;
        const CycleBreaker::Broken broken = break_ring(graph, static_cast<std::int32_t>(id));
        found.broken.edges += broken.edges;
        found.broken.area += broken.area;
    }
    return found;
}

// Reorders the tets of the component. The search is over, so its numbers may serve as nodes.
CycleBreaker::Broken OrderCycles::break_ring(const OrderGraph& graph, std::int32_t component) {
    const auto [first, end] = cyclic_[static_cast<std::size_t>(component)];
    const auto members = std::span(memory_).subspan(first, end - first);
    std::sort(members.begin(), members.end());
    members_.assign(members.begin(), members.end());
    for (std::size_t i = 0; i < members_.size(); ++i)
        numbers_[static_cast<std::size_t>(members_[i])] = static_cast<std::int32_t>(i);
    edges_.clear();
    for (std::size_t i = 0; i < members_.size(); ++i) {
        const std::int32_t tet = members_[i];
        for (std::int32_t edge = graph.first_edge(tet); edge != OrderGraph::no_edge;
             edge = graph.next_edge(tet, edge)) {
            const auto nearer = static_cast<std::size_t>(graph.nearer(tet, edge));
            if (components_[nearer] != component) continue;
            edges_.push_back(
                {static_cast<std::int32_t>(i), numbers_[nearer], graph.area(tet, edge)});
        }
    }
    const CycleBreaker::Order order = breaker_.order(members_.size(), edges_, most_work);
    for (std::size_t i = 0; i < members_.size(); ++i)
        members[static_cast<std::size_t>(order.places[i])] = members_[i];
    return order.broken;
}

void OrderCycles::search(const OrderGraph& graph, std::int32_t root) {
    visit(graph, root);
    while (!path_.empty()) {
        const auto [tet, edge] = path_.back();
        std::int32_t& low = lowest_[static_cast<std::size_t>(tet)];
        if (edge == OrderGraph::no_edge) {
            path_.pop_back();
            if (low == numbers_[static_cast<std::size_t>(tet)]) finish(tet);
            if (!path_.empty()) {
                std::int32_t& before = lowest_[static_cast<std::size_t>(path_.back().tet)];
                before = std::min(before, low);
            }
            continue;
        }
        path_.back().edge = graph.next_edge(tet, edge);
        const std::int32_t nearer = graph.nearer(tet, edge);
        const std::int32_t number = numbers_[static_cast<std::size_t>(nearer)];
        if (number == 0) {
            visit(graph, nearer);
        } else {
            low = std::min(low, number);
        }
    }
}

void OrderCycles::visit(const OrderGraph& graph, std::int32_t tet) {
    const auto index = static_cast<std::size_t>(tet);
    numbers_[index] = lowest_[index] = ++found_;
    open_.push_back(tet);
    path_.push_back({tet, graph.first_edge(tet)});
}

// The tet was the first of its component to be found, so the component is what is open since. All
// nearer components are complete, and follow it in the sequence.
void OrderCycles::finish(std::int32_t tet) {
    const std::size_t end = memory_.size() - sequence_.size();
    std::size_t first = end;
    const bool cyclic = open_.back() != tet;
    std::int32_t member = 0;
    do {
        member = open_.back();
        open_.pop_back();
        const auto index = static_cast<std::size_t>(member);
        numbers_[index] = complete;
        if (cyclic) components_[index] = static_cast<std::int32_t>(cyclic_.size());
        memory_[--first] = member;
    } while (member != tet);
    sequence_ = std::span(memory_).subspan(first);
    if (cyclic) cyclic_.push_back({first, end});
}

}  // namespace lamina
