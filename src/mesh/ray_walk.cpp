// SPDX-License-Identifier: Apache-2.0
#include "mesh/ray_walk.h"

#include "mesh/predicates.h"

// LAMINA_CLONE_FOR_FMA compiles a function twice, once for processors with fused multiply-add;
// glibc's loader chooses. Otherwise std::fma is a library call with the same result. Callees need
// LAMINA_IN_CLONES, to be inlined into both. Not with sanitizers, which are not ready at that time.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LAMINA_CLONE_FOR_FMA __attribute__((target_clones("default", "fma")))
#define LAMINA_IN_CLONES __attribute__((always_inline)) inline
#else
#define LAMINA_CLONE_FOR_FMA
#define LAMINA_IN_CLONES inline
#endif

namespace lamina {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Distance before an exit, as a share of the line's parameters, up to which an entry does not count
// as an overlap: crossings have errors of some epsilon, and meshes may touch themselves.
constexpr double touching = 1e-12;

// Returns a * b - c * d to 2 ulps (Kahan; Jeannerod, Louvet, Muller 2013), for faces seen edge-on.
LAMINA_IN_CLONES double difference_of_products(double a, double b, double c, double d) {
    const double cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

// The point of an edge from a to b that is nearest to 0.
struct Nearest {
    double share;  // weight of b
    double distance;
};
Nearest nearest(double ax, double ay, double bx, double by) {
    const double dx = bx - ax, dy = by - ay;
    const double square = dx * dx + dy * dy;
    const double share = square > 0 ? std::clamp(-(ax * dx + ay * dy) / square, 0.0, 1.0) : 0.5;
    return {share, std::hypot(ax + share * dx, ay + share * dy)};
}

}  // namespace

void RayWalk::aim(const glm::dvec3& origin, const glm::dvec3& direction) {
    set_line(origin, direction);
    tree_.visit([&](const FaceTree::Box& box) { return meets(box); },
                [&](std::int32_t index) { test_face(index); });
    sort_crossings();
}

void RayWalk::aim(const glm::dvec3& origin, const glm::dvec3& direction,
                  std::span<const std::int32_t> faces) {
    set_line(origin, direction);
    for (const std::int32_t index : faces) test_face(index);
    sort_crossings();
}

void RayWalk::set_line(const glm::dvec3& origin, const glm::dvec3& direction) {
    line_.origin = origin;
    line_.direction = direction;
    line_.direction_square = glm::dot(direction, direction);
    const glm::dvec3 d = direction / std::sqrt(line_.direction_square);
    const glm::dvec3 a = glm::abs(d);
    const glm::dvec3 axis = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                            : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                     : glm::dvec3(0, 0, 1);
    line_.across_x = glm::normalize(glm::cross(axis, d));
    line_.across_y = glm::cross(d, line_.across_x);
    extent_x_ = glm::abs(line_.across_x);
    extent_y_ = glm::abs(line_.across_y);
    origin_norm_ = norm1(origin);
    entries_.clear();
    exits_.clear();
}

LAMINA_IN_CLONES RayWalk::Corner RayWalk::see(std::int32_t point) const {
    const glm::dvec3 p = mesh_.points()[point] - line_.origin;
    return {point, glm::dot(p, line_.across_x), glm::dot(p, line_.across_y),
            glm::dot(p, line_.direction) / line_.direction_square, place_error * norm1(p)};
}

LAMINA_IN_CLONES RayWalk::Side RayWalk::side(const Corner& a, const Corner& b) const {
    const double area = difference_of_products(a.x, b.y, a.y, b.x);
    const double error = (std::abs(a.x) + std::abs(a.y) + a.reach) * b.reach +
                         (std::abs(b.x) + std::abs(b.y)) * a.reach + epsilon * std::abs(area);
    if (area > error) return {area, 1};
    if (-area > error) return {area, -1};
    const int sign = exact_side(mesh_.points()[a.point], mesh_.points()[b.point]);
    return {area * sign > 0 ? area : 0, sign};
}

// Returns the exact sign of det(d, p - o, q - o) for the line o + t d. If it is 0, returns the sign
// after o moved by (e, e^2, e^3) and d by (f, f^2, f^3), f infinitely smaller than any power of e:
// tests the terms, the largest first (E = q - p). If p != q, one of them is not 0.
int RayWalk::exact_side(const glm::dvec3& p, const glm::dvec3& q) const {
    const glm::dvec3 none(0);
    const glm::dvec3 &origin = line_.origin, &direction = line_.direction;
    if (const int sign = sign_of_determinant(direction, none, p, origin, q, origin)) return sign;
    const std::array<glm::dvec3, 3> axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0),
                                         glm::dvec3(0, 0, 1)};
    for (const glm::dvec3& axis : axes) {  // e_i . (d x E)
        if (const int sign = sign_of_determinant(axis, none, direction, none, q, p)) return sign;
    }
    const auto sign_of = [](double a, double b) { return a > b ? 1 : a < b ? -1 : 0; };
    for (int i = 0; i < 3; ++i) {  // f^(i+1) times (P x Q)_i - (e x E)_i
        const auto axis = static_cast<std::size_t>(i);
        if (const int sign = sign_of_determinant(axes[axis], none, p, origin, q, origin))
            return sign;
        // -(e x E)_i = e_k E_j - e_j E_k with j, k after i: the lower power of e first.
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const int by_k = sign_of(q[j], p[j]), by_j = -sign_of(q[k], p[k]);
        if (const int sign = j < k ? by_j : by_k) return sign;
        if (const int sign = j < k ? by_k : by_j) return sign;
    }
    return 1;  // p == q: the mesh has the point twice, as an edge without length
}

FaceCrossing RayWalk::crossing(const RayFront& front) {
    const auto& [corners, areas] = front;
    FaceCrossing result;
    for (std::size_t i = 0; i < 3; ++i) result.corners[i] = corners[i].point;
    if (areas[0] > 0 && areas[1] > 0 && areas[2] > 0) {
        const double sum = areas[0] + areas[1] + areas[2];
        result.weights = {areas[1] / sum, areas[2] / sum, areas[0] / sum};
    } else {  // the line meets an edge or a corner, up to rounding: take the place on it
        double best = INFINITY;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const Nearest place = nearest(corners[i].x, corners[i].y, corners[j].x, corners[j].y);
            if (place.distance >= best) continue;
            best = place.distance;
            result.weights = {0, 0, 0};
            result.weights[i] = 1 - place.share;
            result.weights[j] = place.share;
        }
    }
    // Interpolated relative to the first corner, so that no digits are lost far from the origin.
    result.at = corners[0].at + (result.weights[1] * (corners[1].at - corners[0].at) +
                                 result.weights[2] * (corners[2].at - corners[0].at));
    return result;
}

// Returns the corners of a face, counter-clockwise as seen along a line that enters by it.
LAMINA_IN_CLONES std::array<RayWalk::Corner, 3> RayWalk::see_face(const TetFace& face) const {
    const auto [a, b, c] = corners_of_face(mesh_.tets()[face.tet], face.face);
    return {see(a), see(c), see(b)};
}

LAMINA_IN_CLONES std::array<RayWalk::Side, 3> RayWalk::sides_of(
    const std::array<Corner, 3>& p) const {
    return {side(p[0], p[1]), side(p[1], p[2]), side(p[2], p[0])};
}

LAMINA_CLONE_FOR_FMA RayFront RayWalk::front_of(const TetFace& face) const {
    const std::array<Corner, 3> corners = see_face(face);
    const auto [first, second, third] = sides_of(corners);
    return {corners, {first.area, second.area, third.area}};
}

// Tells whether rounding surely leaves all corners on one side, so that the line misses the face.
LAMINA_IN_CLONES bool RayWalk::passes(const std::array<Corner, 3>& p) {
    const double reach = std::max({p[0].reach, p[1].reach, p[2].reach});
    const auto aside = [&](double a, double b, double c) {
        return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
    };
    return aside(p[0].x, p[1].x, p[2].x) || aside(p[0].y, p[1].y, p[2].y);
}

LAMINA_CLONE_FOR_FMA void RayWalk::test_face(std::int32_t index) {
    const TetFace& face = mesh_.open_faces()[index];
    const std::array<Corner, 3> corners = see_face(face);
    if (passes(corners)) return;
    const auto [first, second, third] = sides_of(corners);
    if (second.sign != first.sign || third.sign != first.sign) return;
    const bool enters = first.sign > 0;
    const double sign = enters ? 1 : -1;
    const double at =
        crossing({corners, {sign * first.area, sign * second.area, sign * third.area}}).at;
    if (enters) {
        entries_.push_back({face, at});
    } else {
        exits_.push_back(at);
    }
}

bool RayWalk::meets(const FaceTree::Box& box) const {
    const glm::dvec3 center = 0.5 * box.min + 0.5 * box.max - line_.origin;
    const glm::dvec3 half = 0.5 * box.max - 0.5 * box.min;
    const double margin = 2 * place_error * (norm1(center) + norm1(half) + origin_norm_);
    return std::abs(glm::dot(center, line_.across_x)) <= glm::dot(half, extent_x_) + margin &&
           std::abs(glm::dot(center, line_.across_y)) <= glm::dot(half, extent_y_) + margin;
}

void RayWalk::sort_crossings() {
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.at < b.at; });
    std::sort(exits_.begin(), exits_.end());
    overlapping_ = entries_.size() != exits_.size();
    for (std::size_t i = 0; i + 1 < entries_.size() && !overlapping_; ++i) {
        const double scale =
            std::max(std::abs(exits_[i]), std::abs(exits_.back() - entries_[0].at));
        overlapping_ = entries_[i + 1].at < exits_[i] - touching * scale;
    }
}

// The line leaves by the face of the fourth corner (top) and those corners i and j of the front
// between which the sign of the edge to the top turns from - to +. The top replaces corner k.
LAMINA_CLONE_FOR_FMA std::int32_t RayWalk::step(TetSegment& segment, RayFront& front) const {
    const Tet& tet = mesh_.tets()[segment.tet];
    auto& [p, areas] = front;
    const Corner top = see(corner_opposite(tet, p[0].point, p[1].point, p[2].point));
    const std::array<Side, 3> to_top{side(p[0], top), side(p[1], top), side(p[2], top)};
    std::size_t i = 0;
    while (i < 2 && !(to_top[i].sign < 0 && to_top[(i + 1) % 3].sign > 0)) ++i;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const auto face = static_cast<std::size_t>(std::ranges::find(tet, p[k].point) - tet.begin());
    p[k] = top;
    areas[j] = to_top[j].area;
    areas[k] = -to_top[i].area;
    segment.out = crossing(front);
    segment.out.at = std::max(segment.out.at, segment.in.at);
    const std::int32_t behind = mesh_.neighbors()[segment.tet][face];
    if (mesh_.has_copies() && behind != TetMesh::no_neighbor) {
        for (Corner& corner : p) corner.point = mesh_.corner_at(behind, corner.point);
    }
    return behind;
}

void RayWalk::list(std::vector<TetSegment>& segments) const {
    segments.clear();
    for (const Entry& entry : entries_) {
        follow(entry, [&](const TetSegment& segment) {
            segments.push_back(segment);
            return true;
        });
    }
    std::stable_sort(segments.begin(), segments.end(),
                     [](const TetSegment& a, const TetSegment& b) { return a.in.at < b.in.at; });
}

}  // namespace lamina
