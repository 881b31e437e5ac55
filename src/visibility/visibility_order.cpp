// SPDX-License-Identifier: Apache-2.0
#include "visibility/visibility_order.h"

#include <atomic>
#include <bit>
#include <numeric>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "mesh/mesh_shape.h"

namespace lamina {
namespace {

// Near plane of RingOrder, a share of the diagonal: half the renderer's (plan/project_planner.cpp).
constexpr double near_share = 0.5e-6;

}  // namespace

std::int64_t face_violations(const TetMesh& mesh, const Eye& eye,
                             std::span<const std::int32_t> order) {
    const std::size_t tets = mesh.tets().size();
    if (order.size() != tets)
        fail("an order has {} tets, expected the mesh's {}", order.size(), tets);
    std::vector<std::int32_t> places(tets, -1);
    for (std::size_t i = 0; i < tets; ++i) {
        const auto tet = static_cast<std::size_t>(order[i]);
        if (tet >= tets || places[tet] >= 0)
            fail("place {} of an order is tet {}, expected each of {} tets once", i, order[i],
                 tets);
        places[tet] = static_cast<std::int32_t>(i);
    }
    const FaceSigner signer(mesh, eye);
    std::atomic<std::int64_t> violations{0};
    parallel_for(std::ssize(order), tets_per_task, [&](std::size_t tet) {
        const FaceSigns signs = signer.signs(tet);
        for (std::size_t face = 0; face < 4; ++face) {
            const std::int32_t other = mesh.neighbors()[tet][face];
            if (other == TetMesh::no_neighbor || !(signs & farther_bit(face))) continue;
            if (places[other] > places[tet]) violations.fetch_add(1, std::memory_order_relaxed);
        }
    });
    return violations;
}

const char* name_of(OrderMethod method) {
    static constexpr const char* words[] = {"mpvo", "exact", "centroid", "none"};
    return word_of(method, words);
}

VisibilityOrder::VisibilityOrder(const TetMesh& mesh, OrderMethod method,
                                 std::span<const TetPair> overlaps)
    : mesh_(mesh), method_(method), order_(mesh.tets().size()) {
    std::iota(order_.begin(), order_.end(), 0);
    if (method == OrderMethod::centroid) distances_.resize(order_.size());
    if (method != OrderMethod::mpvo && method != OrderMethod::exact) return;
    if (!overlaps.empty()) overlapping_.resize(order_.size());
    for (const std::int32_t tet : tets_of(overlaps)) overlapping_[tet] = 1;
    const Stage building("order graph");
    const Convexity shape = convexity(mesh);
    graph_ = std::make_unique<OrderGraph>(
        mesh, method == OrderMethod::exact && shape != Convexity::exact, overlaps);
    if (method == OrderMethod::mpvo && shape == Convexity::none)
        farthest_first_ = std::make_unique<FarthestFirst>(mesh);
}

DrawOrder<std::int32_t> VisibilityOrder::sort_pixels(const View& view,
                                                     const std::function<void()>& meanwhile,
                                                     bool overlapping_rings) {
    const bool breaks_all = !overlapping_rings && overlapping_.empty();
    const auto breaks = [&](std::span<const std::int32_t> ring) {
        const auto overlaps = [&](std::int32_t tet) { return overlapping_[tet] != 0; };
        return breaks_all || (!overlapping_rings && std::ranges::any_of(ring, overlaps));
    };
    const auto tets = sort(eye_of(view), meanwhile, std::cref(breaks));  // takes no memory
    if (!graph_ || farthest_first_ || report_.cycles == 0 || breaks_all) return {tets, {}};
    solve_rings(view, std::cref(breaks));
    return rings_->order();
}

std::span<const std::int32_t> VisibilityOrder::sort(const Eye& eye,
                                                    const std::function<void()>& meanwhile,
                                                    const RingChoice& breaks) {
    report_ = {};
    cycles_.forget();
    if (graph_) {
        graph_->look_from(eye);
        parallel_invoke(
            [&] {
                if (!farthest_first_) return sort_topologically(breaks);
                const std::int64_t broken = farthest_first_->sort(*graph_, order_);
                if (broken == 0) return;
                // Only for the report: FarthestFirst has made the order.
                find_cycles([](auto) { return false; });
                report_.broken = broken;
                report_.broken_area = 0;
            },
            meanwhile);
        return order_;
    }
    if (method_ == OrderMethod::centroid) sort_centroids(eye);
    meanwhile();
    return order_;
}

// Splits order_ into runs of tets of one ring, and of tets in no ring (sort_topologically()).
void VisibilityOrder::solve_rings(const View& view, const RingChoice& broken) {
    const Stage solving("rings");
    rings_.emplace(*graph_, view,
                   near_share * glm::distance(mesh_.bounds().min, mesh_.bounds().max));
    const auto tets = std::span<const std::int32_t>(order_);
    for (std::size_t first = 0; first < tets.size();) {
        const std::int32_t ring = cycles_.component(tets[first]);
        std::size_t end = first + 1;
        while (end < tets.size() && cycles_.component(tets[end]) == ring) ++end;
        const auto consecutive = tets.subspan(first, end - first);
        if (ring == OrderCycles::none || broken(consecutive)) {
            rings_->add(consecutive);
        } else {
            rings_->add_ring(consecutive, cycles_);
        }
        first = end;
    }
    report_.broken += rings_->overlapping_pairs();  // none are found if overlaps are ordered
}

// Sorts by distance from the eye: better than depth along the view (VTK's vtkCellCenterDepthSort).
void VisibilityOrder::sort_centroids(const Eye& eye) {
    const auto points = mesh_.points();
    parallel_for(std::ssize(order_), tets_per_task, [&](std::int64_t index) {
        glm::dvec3 sum(0);
        for (const std::int32_t corner : mesh_.tets()[index]) sum += points[corner];
        distances_[index] = {view_distance(eye, 0.25 * sum), static_cast<std::int32_t>(index)};
    });
    parallel_sort(distances_.begin(), distances_.end(), [](const auto& a, const auto& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.tet < b.tet;
    });
    std::transform(distances_.begin(), distances_.end(), order_.begin(),
                   [](const Distance& entry) { return entry.tet; });
}

void VisibilityOrder::sort_topologically(const RingChoice& breaks) {
    const std::size_t drawn = draw_free();
    if (drawn == order_.size()) return;
    find_cycles(breaks);
    const auto rest = cycles_.sequence();
    std::copy(rest.begin(), rest.end(), order_.begin() + static_cast<std::ptrdiff_t>(drawn));
}

// Orders tets by Kahn's algorithm (1962) and returns how many: all, unless there are cycles. Tets
// whose farther tets are drawn wait on a stack at the end of order_: its top is mostly a neighbour.
std::size_t VisibilityOrder::draw_free() {
    const auto counts = graph_->farther_counts();
    const auto neighbors = mesh_.neighbors();
    const std::size_t tets = order_.size();
    std::size_t drawn = 0, top = tets;
    const auto count_down = [&](std::int32_t tet) {
        if (--counts[tet] == 0) order_[--top] = tet;
    };
    for (std::size_t tet = 0; tet < tets; ++tet) {
        if (counts[tet] == 0) order_[--top] = static_cast<std::int32_t>(tet);
    }
    while (top < tets) {
        const std::int32_t tet = order_[top++];
        order_[drawn++] = tet;
        const auto& across = neighbors[tet];
        for (FaceSigns left = graph_->signs(tet) & 0xf; left != 0; left &= left - 1)
            count_down(across[std::countr_zero(left)]);
        for (std::int32_t edge = graph_->first_gap_edge(tet); edge != OrderGraph::no_edge;
             edge = graph_->next_edge(tet, edge))
            count_down(graph_->nearer(tet, edge));
    }
    return drawn;
}

void VisibilityOrder::find_cycles(const RingChoice& breaks) {
    const OrderCycles::Found found = cycles_.order(*graph_, breaks);
    report_.cycles = found.cycles;
    report_.cyclic_tets = found.cyclic_tets;
    report_.broken = found.broken.edges;
    report_.broken_area = found.broken.area;
}

}  // namespace lamina
