// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_cycles.h"

#include <algorithm>
#include <limits>

namespace lamina {
namespace {

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

OrderCycles::Found OrderCycles::order(const OrderGraph& graph) {
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
    // The numbers are not needed any more, so the breaker may use their memory.
    for (std::size_t id = 0; id < cyclic_.size(); ++id) {
        const auto [first, end] = cyclic_[id];
        const CycleBreaker::Broken broken =
            breaker_.order(graph, std::span(memory_).subspan(first, end - first), components_,
                           static_cast<std::int32_t>(id), numbers_);
        ++found.cycles;
        found.cyclic_tets += static_cast<std::int64_t>(end - first);
        found.broken.edges += broken.edges;
        found.broken.area += broken.area;
    }
    return found;
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
