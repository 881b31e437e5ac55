// SPDX-License-Identifier: Apache-2.0
#include "visibility/ring_order.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include "base/client.h"
#include "scene/camera.h"

namespace lamina {

namespace {

constexpr PixelArea no_pixels{0, -1, 0, -1};

// Constraints that are visited for each constraint, at most, while rings are broken. Constraints
// that are then broken without need are found again, and kept, in smaller parts of the picture.
constexpr std::int64_t work_a_constraint = 16;

// Two tets overlap on a ray if they share more than these parts of the shorter way through one of
// them, and of the depth. That is far above what rounding does to both ends of a way (1e-16 of the
// depth, over the slope of a face, which the ray perturbation keeps above 1e-7). A smaller overlap
// changes the picture, in either order, by that part of one tet's opacity at most.
constexpr double overlap_share = 1e-3, overlap_of_depth = 1e-9;

// The depths between which a ray is inside a tet. If it misses the tet, `in` is above `out`.
struct Way {
    double in, out;
    double middle() const { return 0.5 * in + 0.5 * out; }
};

Way way_through(const View::Ray& ray, std::span<const glm::dvec3> points, const Tet& tet) {
    const auto corner = [&](std::int32_t number) -> const glm::dvec3& {
        return points[static_cast<std::size_t>(number)];
    };
    Way way{-INFINITY, INFINITY};
    for (std::size_t face = 0; face < 4; ++face) {
        const auto [a, b, c] = corners_of_face(tet, face);
        const glm::dvec3 outwards = glm::cross(corner(b) - corner(a), corner(c) - corner(a));
        const double speed = glm::dot(outwards, ray.direction);
        const double at = glm::dot(outwards, corner(a) - ray.origin) / speed;
        if (speed > 0) way.out = std::min(way.out, at);
        if (speed < 0) way.in = std::max(way.in, at);
    }
    if (std::isfinite(way.in) && std::isfinite(way.out)) return way;
    // A tet without volume shows nothing, wherever it is drawn.
    return {0, 0};
}

PixelArea half_of(const PixelArea& area, bool second) {
    PixelArea half = area;
    const bool across = area.last_column - area.first_column > area.last_row - area.first_row;
    std::int32_t& first = across ? half.first_column : half.first_row;
    std::int32_t& last = across ? half.last_column : half.last_row;
    const std::int32_t middle = first + (last - first) / 2;
    (second ? first : last) = second ? middle + 1 : middle;
    return half;
}

}  // namespace

RingOrder::RingOrder(const OrderGraph& graph, const View& view, double near)
    : graph_(graph), finder_(view, near) {}

PixelArea RingOrder::picture() const {
    return {0, finder_.view().width - 1, 0, finder_.view().height - 1};
}

SeenPolygon RingOrder::seen_through(std::int32_t tet, std::int32_t edge) const {
    const OrderGraph::Passage passage = graph_.passage(tet, edge);
    const SeenPolygon exit = finder_.polygon(passage.exit);
    return passage.shared ? exit : overlap_of(exit, finder_.polygon(passage.entry));
}

void RingOrder::add_ring(std::span<const std::int32_t> tets, const OrderCycles& cycles) {
    Problem whole{picture(), std::vector<Member>(tets.size()), {}};
    const TetMesh& mesh = graph_.mesh();
    std::vector<std::int32_t> members(tets.begin(), tets.end());
    std::sort(members.begin(), members.end());
    const auto index_of = [&](std::int32_t tet) {
        return static_cast<std::int32_t>(std::lower_bound(members.begin(), members.end(), tet) -
                                         members.begin());
    };
    for (std::size_t i = 0; i < members.size(); ++i) {
        check_interrupt();
        const std::int32_t tet = members[i];
        std::array<glm::dvec3, 4> corners;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const std::int32_t point = mesh.tets()[static_cast<std::size_t>(tet)][corner];
            corners[corner] = mesh.points()[static_cast<std::size_t>(point)];
        }
        whole.tets[i] = {tet, finder_.pixels_of(corners)};
        for (std::int32_t edge = graph_.first_edge(tet); edge != OrderGraph::no_edge;
             edge = graph_.next_edge(tet, edge)) {
            const std::int32_t nearer = graph_.nearer(tet, edge);
            if (cycles.component(nearer) != cycles.component(tet)) continue;
            const SeenPolygon seen = seen_through(tet, edge);
            if (covers_some(seen, whole.pixels))
                whole.constraints.push_back({static_cast<std::int32_t>(i), index_of(nearer), seen});
        }
    }
    solve(whole);
}

std::int64_t RingOrder::overlapping_pairs() const {
    auto pairs = overlapping_;
    std::sort(pairs.begin(), pairs.end());
    return std::unique(pairs.begin(), pairs.end()) - pairs.begin();
}

RingOrder::Solution RingOrder::sorted(const Problem& problem) {
    edges_.clear();
    for (const Constraint& constraint : problem.constraints)
        edges_.push_back({constraint.farther, constraint.nearer, constraint.seen.area()});
    const CycleBreaker::Order found = breaker_.order(
        problem.tets.size(), edges_, work_a_constraint * std::ssize(problem.constraints));
    const auto place_of = [&](std::int32_t index) {
        return static_cast<std::size_t>(found.places[static_cast<std::size_t>(index)]);
    };
    Solution solution{std::vector<std::int32_t>(problem.tets.size()), no_pixels};
    for (std::size_t i = 0; i < problem.tets.size(); ++i) {
        const auto index = static_cast<std::int32_t>(i);
        solution.order[place_of(index)] = index;
    }
    for (const Constraint& constraint : problem.constraints) {
        if (place_of(constraint.farther) > place_of(constraint.nearer))
            solution.wrong.add(covered_pixels(constraint.seen, problem.pixels));
    }
    return solution;
}

void RingOrder::solve(const Problem& problem) {
    check_interrupt();
    const Solution solution = sorted(problem);
    const PixelArea& wrong = solution.wrong;
    if (wrong.empty()) {
        draw(problem, solution.order, problem.pixels);
        return;
    }
    draw_around(problem, solution);
    if (wrong.count() == 1) {
        draw_pixel(problem, wrong);
        return;
    }
    const auto solve_in = [&](const PixelArea& pixels) {
        Problem part{pixels, {}, {}};
        std::vector<std::int32_t> index_of(problem.tets.size(), -1);
        for (std::size_t i = 0; i < problem.tets.size(); ++i) {
            if (common_pixels(problem.tets[i].pixels, pixels).empty()) continue;
            index_of[i] = static_cast<std::int32_t>(part.tets.size());
            part.tets.push_back(problem.tets[i]);
        }
        for (const Constraint& constraint : problem.constraints) {
            const std::int32_t farther = index_of[static_cast<std::size_t>(constraint.farther)],
                               nearer = index_of[static_cast<std::size_t>(constraint.nearer)];
            if (farther >= 0 && nearer >= 0 && covers_some(constraint.seen, pixels))
                part.constraints.push_back({farther, nearer, constraint.seen});
        }
        solve(part);
    };
    if (2 * wrong.count() <= problem.pixels.count()) {
        solve_in(wrong);
    } else {
        solve_in(half_of(wrong, false));
        solve_in(half_of(wrong, true));
    }
}

void RingOrder::draw(const Problem& problem, std::span<const std::int32_t> order,
                     const PixelArea& pixels) {
    if (pixels.empty()) return;
    const std::size_t first = tets_.size();
    for (const std::int32_t index : order) {
        const Member& member = problem.tets[static_cast<std::size_t>(index)];
        if (!common_pixels(member.pixels, pixels).empty()) tets_.push_back(member.tet);
    }
    const bool limited = pixels.count() < picture().count();
    if (limited && first < tets_.size()) limited_.push_back({first, tets_.size(), pixels});
}

void RingOrder::draw_around(const Problem& problem, const Solution& solution) {
    const PixelArea &all = problem.pixels, &hole = solution.wrong;
    PixelArea above = all, below = all, left = hole, right = hole;
    above.last_row = hole.first_row - 1;
    below.first_row = hole.last_row + 1;
    left.first_column = all.first_column;
    left.last_column = hole.first_column - 1;
    right.first_column = hole.last_column + 1;
    right.last_column = all.last_column;
    for (const PixelArea& pixels : {above, below, left, right})
        draw(problem, solution.order, pixels);
}

void RingOrder::draw_pixel(const Problem& problem, const PixelArea& pixel) {
    const glm::dvec3 moved = ray_perturbation(finder_.view());
    const View::Ray ray =
        finder_.view().ray(pixel.first_column + moved.x, pixel.first_row - moved.y);
    const TetMesh& mesh = graph_.mesh();
    std::vector<Way> ways(problem.tets.size());
    std::vector<std::int32_t> order(problem.tets.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = static_cast<std::int32_t>(i);
        const auto tet = static_cast<std::size_t>(problem.tets[i].tet);
        ways[i] = way_through(ray, mesh.points(), mesh.tets()[tet]);
    }
    const auto way_of = [&](std::int32_t index) -> const Way& {
        return ways[static_cast<std::size_t>(index)];
    };
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return way_of(a).middle() > way_of(b).middle();
    });
    draw(problem, order, pixel);
    const Member* before = nullptr;  // the tet with the least depth so far at which the ray enters
    Way reached{INFINITY, INFINITY};
    for (const std::int32_t index : order) {
        const Way& way = way_of(index);
        if (!(way.out > way.in)) continue;
        const Member& member = problem.tets[static_cast<std::size_t>(index)];
        const double shorter = std::min(way.out - way.in, reached.out - reached.in);
        if (before != nullptr &&
            way.out - reached.in > overlap_share * shorter + overlap_of_depth * std::abs(way.out))
            overlapping_.emplace_back(std::minmax(before->tet, member.tet));
        if (before != nullptr && way.in > reached.in) continue;
        before = &member;
        reached = way;
    }
}

}  // namespace lamina
