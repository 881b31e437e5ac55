// SPDX-License-Identifier: Apache-2.0
#include "visibility/ring_order.h"

#include <ranges>

#include "base/client.h"

namespace lamina {
namespace {

constexpr PixelArea no_pixels{0, -1, 0, -1};

// Distance in pixels from a polygon up to which a pixel's centre counts as covered: above the
// rounding of corners (1e-7 at 1e9 pixels) and ray_perturbation() (1e-7).
constexpr double margin = 1e-3;

double signed_area(const SeenPolygon& polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
        sum += cross(polygon.corners[i - 1] - polygon.corners[0],
                     polygon.corners[i] - polygon.corners[0]);
    }
    return 0.5 * sum;
}

// A range of columns or of rows, clamped to what a picture can have.
struct Range {
    double low = INFINITY, high = -INFINITY;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    std::int32_t first(std::int32_t least) const {
        return static_cast<std::int32_t>(
            std::clamp(std::ceil(low - margin), static_cast<double>(least), 0x1p30));
    }
    std::int32_t last(std::int32_t most) const {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(high + margin), -0x1p30, static_cast<double>(most)));
    }
};

Range columns_between(const SeenPolygon& polygon, double top, double bottom) {
    Range columns;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& a = polygon.corners[i];
        const glm::dvec2& b = polygon.corners[(i + 1) % polygon.count];
        if (a.y >= top && a.y <= bottom) columns.add(a.x);
        for (const double row : {top, bottom}) {
            if ((a.y < row) == (b.y < row)) continue;
            columns.add(a.x + (row - a.y) / (b.y - a.y) * (b.x - a.x));
        }
    }
    return columns;
}

// Calls visit(pixels) for each row with covered pixels, until it returns false.
template <typename Visit>
void for_each_row(const SeenPolygon& polygon, const PixelArea& area, const Visit& visit) {
    Range rows;
    for (std::size_t i = 0; i < polygon.count; ++i) rows.add(polygon.corners[i].y);
    const std::int32_t last = rows.last(area.last_row);
    for (std::int32_t row = rows.first(area.first_row); row <= last; ++row) {
        const Range columns = columns_between(polygon, row - margin, row + margin);
        const PixelArea pixels{columns.first(area.first_column), columns.last(area.last_column),
                               row, row};
        if (!pixels.empty() && !visit(pixels)) return;
    }
}

SeenPolygon overlap_of(const SeenPolygon& a, const SeenPolygon& b) {
    if (b.count == 0) return {};
    const double sign = signed_area(b) < 0 ? -1 : 1;
    SeenPolygon common = a;
    for (std::size_t i = 0; i < b.count; ++i) {
        const glm::dvec2& from = b.corners[i];
        const glm::dvec2 along = b.corners[(i + 1) % b.count] - from;
        common = cut(common, [&](const glm::dvec2& c) { return sign * cross(along, c - from); });
    }
    return common;
}

// Returns the rectangle around the pixels whose centres a polygon (nearly) covers.
PixelArea covered_pixels(const SeenPolygon& polygon, const PixelArea& area) {
    PixelArea covered = no_pixels;
    for_each_row(polygon, area, [&](const PixelArea& pixels) {
        covered.add(pixels);
        return true;
    });
    return covered;
}

bool covers_some(const SeenPolygon& polygon, const PixelArea& area) {
    bool some = false;
    for_each_row(polygon, area, [&](const PixelArea&) {
        some = true;
        return false;
    });
    return some;
}
// Edges that CycleBreaker may visit, per constraint: what it breaks, smaller rectangles solve.
constexpr std::int64_t work_a_constraint = 16;

// Pixels are ordered one by one, if tets overlap, where this takes at most so many looks at tets a
// constraint: to halve a rectangle again and again takes longer. Measured: the order of 200 random
// tets takes .6 s in place of 9.5 s; with 32, `can` has a third more tets to draw.
constexpr std::int64_t looks_a_constraint = 8;

// Two tets overlap on a ray if they share more than the sum of these parts of the shorter tet's
// length and of the depth. Both are far above rounding (1e-16 of the depth, over a face's slope of
// at least 1e-7). A smaller overlap changes the picture by that share of one tet's opacity.
constexpr double overlap_share = 1e-3, overlap_of_depth = 1e-9;

// The parameters of a ray between which it is inside a tet; it misses the tet if in > out.
struct RaySpan {
    double in, out;
    double middle() const { return 0.5 * in + 0.5 * out; }
};

RaySpan span_through(const View::Ray& ray, std::span<const glm::dvec3> points, const Tet& tet) {
    const auto corner = [&](std::int32_t number) -> const glm::dvec3& { return points[number]; };
    RaySpan span{-INFINITY, INFINITY};
    for (std::size_t face = 0; face < 4; ++face) {
        const auto [a, b, c] = corners_of_face(tet, face);
        const glm::dvec3 outwards = glm::cross(corner(b) - corner(a), corner(c) - corner(a));
        const double speed = glm::dot(outwards, ray.direction);
        const double at = glm::dot(outwards, corner(a) - ray.origin) / speed;
        if (speed > 0) span.out = std::min(span.out, at);
        if (speed < 0) span.in = std::max(span.in, at);
    }
    if (std::isfinite(span.in) && std::isfinite(span.out)) return span;
    // A tet without volume shows nothing, wherever it is in the order.
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

glm::dvec2 PixelFinder::place_of(const glm::dvec3& seen) const {
    const glm::dvec2 window = window_.to_window(seen);
    return {window.x - 0.5, window_.view().height - 0.5 - window.y};
}

SeenPolygon PixelFinder::polygon(std::span<const glm::dvec3> corners) const {
    SeenPolygon seen;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = window_.see(corners[i]),
                         b = window_.see(corners[i + 1 < corners.size() ? i + 1 : 0]);
        if (!window_.perspective() || a.z >= near_) seen.add(place_of(a));
        if (window_.perspective() && (a.z < near_) != (b.z < near_)) {
            glm::dvec3 at = a + (near_ - a.z) / (b.z - a.z) * (b - a);
            at.z = near_;
            seen.add(place_of(at));
        }
    }
    return seen;
}

PixelArea PixelFinder::pixels_of(std::span<const glm::dvec3> points) const {
    const PixelArea all = picture();
    Range columns, rows;
    std::size_t hidden = 0;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 seen = window_.see(point);
        if (window_.perspective() && seen.z < near_) {
            ++hidden;
            continue;
        }
        const glm::dvec2 place = place_of(seen);
        columns.add(place.x);
        rows.add(place.y);
    }
    if (hidden == points.size()) return no_pixels;
    if (hidden > 0) return all;
    return {columns.first(0), columns.last(all.last_column), rows.first(0),
            rows.last(all.last_row)};
}

RingOrder::RingOrder(const OrderGraph& graph, const View& view, double near)
    : graph_(graph), finder_(view, near) {}

SeenPolygon RingOrder::seen_through(std::int32_t tet, std::int32_t edge) const {
    const OrderGraph::Passage passage = graph_.passage(tet, edge);
    const SeenPolygon exit = finder_.polygon(passage.exit);
    if (passage.shared) return exit;
    if (!passage.behind) return overlap_of(exit, finder_.polygon(passage.entry));
    const auto whole = [](const Triangle& corners) {
        return CutTriangle{3, {corners[0], corners[1], corners[2]}};
    };
    const CutTriangle entry = part_behind(whole(passage.exit), whole(passage.entry),
                                          tie_distance(graph_.mesh(), graph_.eye()));
    return overlap_of(exit, finder_.polygon(entry.points()));
}

void RingOrder::add_ring(std::span<const std::int32_t> tets, const OrderCycles& cycles) {
    Problem whole{finder_.picture(), std::vector<Member>(tets.size()), {}};
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
        whole.tets[i] = {tet, finder_.pixels_of(mesh.corners(tet))};
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
        edges_.push_back(
            {constraint.farther, constraint.nearer, std::abs(signed_area(constraint.seen))});
    const CycleBreaker::Order found = breaker_.order(
        problem.tets.size(), edges_, work_a_constraint * std::ssize(problem.constraints));
    const auto place_of = [&](std::int32_t index) {
        return static_cast<std::size_t>(found.places[index]);
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
    if (wrong.count() == 1 || (graph_.orders_overlaps() && is_dense(problem, wrong))) {
        draw_pixels(problem, wrong);
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
            const std::int32_t farther = index_of[constraint.farther],
                               nearer = index_of[constraint.nearer];
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
        const Member& member = problem.tets[index];
        if (!common_pixels(member.pixels, pixels).empty()) tets_.push_back(member.tet);
    }
    const bool limited = pixels.count() < finder_.picture().count();
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

bool RingOrder::is_dense(const Problem& problem, const PixelArea& pixels) {
    // draw_row() looks at all tets once, and at each tet once a pixel.
    std::int64_t looks = (pixels.last_row - pixels.first_row + 1) * std::ssize(problem.tets);
    for (const Member& member : problem.tets) looks += common_pixels(member.pixels, pixels).count();
    return looks <= looks_a_constraint * std::ssize(problem.constraints);
}

void RingOrder::draw_pixels(const Problem& problem, const PixelArea& pixels) {
    for (std::int32_t row = pixels.first_row; row <= pixels.last_row; ++row) {
        check_interrupt();
        const PixelArea here{pixels.first_column, pixels.last_column, row, row};
        if (graph_.orders_overlaps()) {
            draw_row(problem, here);
            continue;
        }
        for (std::int32_t column = here.first_column; column <= here.last_column; ++column)
            draw_pixel(problem, {column, column, row, row});
    }
}

View::Ray RingOrder::ray_of(const PixelArea& pixel) const {
    const glm::dvec3 moved = ray_perturbation(finder_.view());
    return finder_.view().ray(pixel.first_column + moved.x, pixel.first_row - moved.y);
}

// Draws the tets of each pixel of a row by entry.
void RingOrder::draw_row(const Problem& problem, const PixelArea& row) {
    std::vector<std::vector<std::int32_t>> columns(static_cast<std::size_t>(row.count()));
    for (std::size_t i = 0; i < problem.tets.size(); ++i) {
        const PixelArea pixels = common_pixels(problem.tets[i].pixels, row);
        if (pixels.empty()) continue;
        for (std::int32_t at = pixels.first_column; at <= pixels.last_column; ++at)
            columns[at - row.first_column].push_back(static_cast<std::int32_t>(i));
    }
    for (std::int32_t at = row.first_column; at <= row.last_column; ++at)
        draw_by_entry(problem, columns[at - row.first_column],
                      {at, at, row.first_row, row.last_row});
}

void RingOrder::draw_by_entry(const Problem& problem, std::span<const std::int32_t> tets,
                              const PixelArea& pixel) {
    struct Met {
        std::int32_t index;
        double entry;
    };
    const View::Ray ray = ray_of(pixel);
    const TetMesh& mesh = graph_.mesh();
    const auto tet_of = [&](const Met& met) { return problem.tets[met.index].tet; };
    std::vector<Met> met;
    for (const std::int32_t index : tets) {
        const Tet& tet = mesh.tets()[problem.tets[index].tet];
        const RaySpan span = span_through(ray, mesh.points(), tet);
        if (span.out > span.in) met.push_back({index, span.in});
    }
    sort_by_entry(std::span(met), entry_rule(mesh, graph_.eye(), ray.direction), &Met::entry,
                  tet_of);
    std::vector<std::int32_t> order;
    for (const Met& each : std::views::reverse(met)) order.push_back(each.index);
    draw(problem, order, pixel);
}

void RingOrder::draw_pixel(const Problem& problem, const PixelArea& pixel) {
    const View::Ray ray = ray_of(pixel);
    const TetMesh& mesh = graph_.mesh();
    std::vector<RaySpan> spans(problem.tets.size());
    std::vector<std::int32_t> order(problem.tets.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = static_cast<std::int32_t>(i);
        const auto tet = static_cast<std::size_t>(problem.tets[i].tet);
        spans[i] = span_through(ray, mesh.points(), mesh.tets()[tet]);
    }
    const auto span_of = [&](std::int32_t index) -> const RaySpan& { return spans[index]; };
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        return span_of(a).middle() > span_of(b).middle();
    });
    draw(problem, order, pixel);
    const Member* before = nullptr;  // the tet so far that the ray enters first
    RaySpan reached{INFINITY, INFINITY};
    for (const std::int32_t index : order) {
        const RaySpan& span = span_of(index);
        const Member& member = problem.tets[index];
        // Rounding may give a tet without volume a span, at which it shares no space with others.
        if (!(span.out > span.in) || std::ranges::binary_search(mesh.flat_tets(), member.tet))
            continue;
        const double shorter = std::min(span.out - span.in, reached.out - reached.in);
        if (before != nullptr &&
            span.out - reached.in > overlap_share * shorter + overlap_of_depth * std::abs(span.out))
            overlapping_.emplace_back(std::minmax(before->tet, member.tet));
        if (before != nullptr && span.in > reached.in) continue;
        before = &member;
        reached = span;
    }
}

}  // namespace lamina
