// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_cycles.h"

#include "base/client.h"

namespace lamina {

CycleBreaker::Order CycleBreaker::order(std::size_t nodes, std::span<const Edge> edges,
                                        std::int64_t work) {
    most_work_ = work;
    collect(nodes, edges);
    work_ = 0;
    drop_links();
    work_ = 0;
    take_back();
    places_.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i) places_[i] = nodes_[i].place;
    Broken broken;
    for (const Link& link : links_) {
        if (node(link.from).place < node(link.to).place) continue;
        ++broken.edges;
        broken.area += link.area;
    }
    return {places_, broken};
}

void CycleBreaker::collect(std::size_t nodes, std::span<const Edge> edges) {
    links_.clear();
    nodes_.assign(nodes + 1, {});
    auto next = edges.begin();
    for (std::size_t i = 0; i < nodes; ++i) {
        nodes_[i].out = nodes_[i].next = static_cast<std::int32_t>(links_.size());
        for (; next != edges.end() && next->from == static_cast<std::int32_t>(i); ++next)
            add(*next);
    }
    nodes_.back().out = static_cast<std::int32_t>(links_.size());
    list_entering();
}

void CycleBreaker::add(const Edge& edge) {
    for (auto at = static_cast<std::size_t>(node(edge.from).out); at < links_.size(); ++at) {
        if (links_[at].to != edge.to) continue;
        links_[at].area += edge.area;
        links_[at].left += edge.area;
        return;
    }
    links_.push_back({edge.from, edge.to, edge.area, edge.area, true});
}

void CycleBreaker::list_entering() {
    for (const Link& edge : links_) ++node(edge.to + 1).in;
    for (std::size_t i = 1; i < nodes_.size(); ++i) nodes_[i].in += nodes_[i - 1].in;
    entering_.resize(links_.size());
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(links_.size()); ++i)
        entering_[node(link(i).to).in++] = i;
    // Filling moved each list's start to the start of the next list: move them back.
    for (std::size_t i = nodes_.size() - 1; i > 0; --i) nodes_[i].in = nodes_[i - 1].in;
    nodes_[0].in = 0;
}

// Searches for cycles depth first. Subtracts the smallest `left` of a cycle's links from all of
// them, and drops links with nothing left. A node gets its place when all nearer nodes have theirs.
void CycleBreaker::drop_links() {
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
                   (!link(top.next).kept || node(link(top.next).to).state == State::done))
                ++top.next;
            if (top.next == end) {
                top.state = State::done;
                top.place = --place;
                path_.pop_back();
            } else if (const std::int32_t to = link(top.next).to; node(to).state == State::fresh) {
                push(to);
            } else if (work_ < most_work_) {
                check_interrupt();
                thin_cycle(node(to).depth);
            } else {
                link(top.next).kept = false;
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

// Thins the cycle that the path closes from depth `first` on, and cuts the path at a dropped link.
void CycleBreaker::thin_cycle(std::int32_t first) {
    const auto begin = path_.begin() + first;
    work_ += path_.end() - begin;
    const auto edge_of = [&](std::int32_t index) -> Link& { return link(node(index).next); };
    double least = edge_of(*begin).left;
    for (auto at = begin; at != path_.end(); ++at) least = std::min(least, edge_of(*at).left);
    auto cut = path_.end();
    for (auto at = begin; at != path_.end(); ++at) {
        Link& passed = edge_of(*at);
        passed.left -= least;
        if (passed.left > 0) continue;
        passed.kept = false;
        dropped_.push_back(node(*at).next);
        if (cut == path_.end()) cut = at;
    }
    for (auto at = cut + 1; at != path_.end(); ++at) node(*at).state = State::fresh;
    path_.erase(cut + 1, path_.end());
}

// Keeps dropped links again, those of the largest area first, if they close no cycle.
void CycleBreaker::take_back() {
    std::sort(dropped_.begin(), dropped_.end(), [&](std::int32_t a, std::int32_t b) {
        return link(a).area != link(b).area ? link(a).area > link(b).area : a < b;
    });
    for (const std::int32_t index : dropped_) {
        check_interrupt();
        Link& dropped = link(index);
        dropped.kept = node(dropped.from).place < node(dropped.to).place ||
                       (work_ < most_work_ && keep(dropped));
    }
}

// Adds a link to the order by moving nodes, or returns false if it closes a cycle (Pearce and
// Kelly, A dynamic topological sort algorithm for directed acyclic graphs, 2007).
bool CycleBreaker::keep(const Link& kept) {
    nearer_.clear();
    farther_.clear();
    const std::int32_t first = node(kept.to).place, last = node(kept.from).place;
    const bool free = mark_nearer(kept.to, last);
    if (free) mark_farther(kept.from, first);
    for (const auto* marked : {&nearer_, &farther_})
        for (const std::int32_t index : *marked) node(index).marked = false;
    if (!free) return false;
    const auto by_place = [&](std::int32_t a, std::int32_t b) {
        return node(a).place < node(b).place;
    };
    std::sort(nearer_.begin(), nearer_.end(), by_place);
    std::sort(farther_.begin(), farther_.end(), by_place);
    farther_.insert(farther_.end(), nearer_.begin(), nearer_.end());
    free_.clear();
    for (const std::int32_t index : farther_) free_.push_back(node(index).place);
    std::sort(free_.begin(), free_.end());
    for (std::size_t i = 0; i < free_.size(); ++i) node(farther_[i]).place = free_[i];
    return true;
}

// Collects in nearer_ the nodes before `end` that kept links reach; false if they reach `end`.
bool CycleBreaker::mark_nearer(std::int32_t from, std::int32_t end) {
    nearer_.push_back(from);
    node(from).marked = true;
    for (std::size_t i = 0; i < nearer_.size(); ++i) {
        work_ += node(nearer_[i] + 1).out - node(nearer_[i]).out;
        for (std::int32_t at = node(nearer_[i]).out; at < node(nearer_[i] + 1).out; ++at) {
            if (!link(at).kept) continue;
            Node& to = node(link(at).to);
            if (to.place == end) return false;
            if (to.place > end || to.marked) continue;
            to.marked = true;
            nearer_.push_back(link(at).to);
        }
    }
    return true;
}

// Collects in farther_ the nodes from place `end` on whose kept links lead to `from`.
void CycleBreaker::mark_farther(std::int32_t from, std::int32_t end) {
    farther_.push_back(from);
    node(from).marked = true;
    for (std::size_t i = 0; i < farther_.size(); ++i) {
        work_ += node(farther_[i] + 1).in - node(farther_[i]).in;
        for (std::int32_t at = node(farther_[i]).in; at < node(farther_[i] + 1).in; ++at) {
            const Link& entering = link(entering_[at]);
            if (!entering.kept) continue;
            Node& other = node(entering.from);
            if (other.place < end || other.marked) continue;
            other.marked = true;
            farther_.push_back(entering.from);
        }
    }
}

namespace {

// Limit on edges visited in one component: some seconds. Overlapping tets may make more cycles.
constexpr std::int64_t most_work = 200'000'000;

// Value in numbers_ of tets whose component is complete: larger than all others.
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

OrderCycles::Found OrderCycles::order(const OrderGraph& graph, const RingChoice& breaks) {
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
        const auto [first, end] = cyclic_[id];
        found.cyclic_tets += static_cast<std::int64_t>(end - first);
        if (!breaks(std::span(memory_).subspan(first, end - first))) continue;
        const CycleBreaker::Broken broken = break_ring(graph, static_cast<std::int32_t>(id));
        found.broken.edges += broken.edges;
        found.broken.area += broken.area;
    }
    return found;
}

// Reorders a component's tets. The search is over, so numbers_ can hold indices in members_.
CycleBreaker::Broken OrderCycles::break_ring(const OrderGraph& graph, std::int32_t component) {
    const auto [first, end] = cyclic_[component];
    const auto members = std::span(memory_).subspan(first, end - first);
    std::sort(members.begin(), members.end());
    members_.assign(members.begin(), members.end());
    for (std::size_t i = 0; i < members_.size(); ++i)
        numbers_[members_[i]] = static_cast<std::int32_t>(i);
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
    for (std::size_t i = 0; i < members_.size(); ++i) members[order.places[i]] = members_[i];
    return order.broken;
}

// Tarjan's algorithm from one root, without recursion.
void OrderCycles::search(const OrderGraph& graph, std::int32_t root) {
    visit(graph, root);
    while (!path_.empty()) {
        const auto [tet, edge] = path_.back();
        std::int32_t& low = lowest_[tet];
        if (edge == OrderGraph::no_edge) {
            path_.pop_back();
            if (low == numbers_[tet]) finish(tet);
            if (!path_.empty()) {
                std::int32_t& before = lowest_[path_.back().tet];
                before = std::min(before, low);
            }
            continue;
        }
        path_.back().edge = graph.next_edge(tet, edge);
        const std::int32_t nearer = graph.nearer(tet, edge);
        const std::int32_t number = numbers_[nearer];
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

// Completes the component that consists of all tets found from `tet` on that are still open.
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
