// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_shape.h"

#include <numeric>
#include <optional>
#include <tuple>

#include "base/parallel.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

// Largest dent of Convexity::within_rounding, as a share of the diagonal.
constexpr double flat_enough = 1e-12;
constexpr std::int64_t tets_per_task = 8192;

constexpr EdgeLengths no_edges{std::numeric_limits<double>::infinity(), 0};

// An edge of an open face. Sorted, the edges of all faces that meet at one edge are neighbours.
struct BoundaryEdge {
    std::int32_t low, high;
    std::int32_t face;  // index into open_faces()
    std::int32_t apex;  // the face's third corner
    bool operator<(const BoundaryEdge& other) const {
        return std::tie(low, high, face) < std::tie(other.low, other.high, other.face);
    }
    bool same_place(const BoundaryEdge& other) const {
        return low == other.low && high == other.high;
    }
};

// Returns the places of an open face's corners.
std::array<std::int32_t, 3> open_face(const TetMesh& mesh, std::int32_t index) {
    const TetFace& face = mesh.open_faces()[index];
    return corners_of_face(mesh.place(mesh.tets()[face.tet]), face.face);
}

std::vector<BoundaryEdge> boundary_edges(const TetMesh& mesh) {
    std::vector<BoundaryEdge> edges;
    edges.reserve(3 * mesh.open_faces().size());
    for (std::size_t face = 0; face < mesh.open_faces().size(); ++face) {
        const auto index = static_cast<std::int32_t>(face);
        const auto corners = open_face(mesh, index);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::int32_t a = corners[(i + 1) % 3], b = corners[(i + 2) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), index, corners[i]});
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

// Tells how convex the edge of two faces is: on which side of `first`'s plane `second`'s apex lies.
Convexity bend(const TetMesh& mesh, const BoundaryEdge& first, const BoundaryEdge& second,
               double tolerance) {
    const auto point = [&](std::int32_t index) -> const glm::dvec3& {
        return mesh.points()[index];
    };
    const auto normal = [&](std::int32_t face) {
        const auto [a, b, c] = open_face(mesh, face);
        return glm::cross(point(b) - point(a), point(c) - point(a));
    };
    const auto [a, b, c] = open_face(mesh, first.face);
    const glm::dvec3& apex = point(second.apex);
    const int sign = orientation(point(a), point(b), point(c), apex);
    if (sign < 0) return Convexity::exact;
    const glm::dvec3 n = normal(first.face);
    // The angle is flat or concave. The faces must not be folded back onto each other.
    if (!(glm::dot(n, normal(second.face)) > 0)) return Convexity::none;
    if (sign == 0) return Convexity::exact;
    return glm::dot(n, apex - point(a)) <= tolerance * glm::length(n) ? Convexity::within_rounding
                                                                      : Convexity::none;
}

// Disjoint sets of faces (union-find), to count the closed surfaces of a boundary.
class FaceSets {
  public:
    explicit FaceSets(std::size_t faces) : parent_(faces), count_(faces) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    void join(std::int32_t a, std::int32_t b) {
        const std::size_t root_a = root(a), root_b = root(b);
        if (root_a == root_b) return;
        parent_[root_a] = root_b;
        --count_;
    }
    std::size_t count() const { return count_; }

  private:
    std::size_t root(std::int32_t face) {
        auto at = static_cast<std::size_t>(face);
        while (parent_[at] != at) at = parent_[at] = parent_[parent_[at]];
        return at;
    }
    std::vector<std::size_t> parent_;
    std::size_t count_;
};

// Tells whether a closed surface without concave edges, which may cross itself, winds once around
// its inside: pyramids on both sides of a pentagram wind twice (docs/numerics.md, Convex meshes).
class Winding {
  public:
    // `edges`: sorted; each stands there twice.
    Winding(const TetMesh& mesh, std::span<const BoundaryEdge> edges)
        : mesh_(mesh), edges_(edges) {}

    bool is_single() {
        const std::optional<std::int32_t> top = only_top();
        return top && turns_once(*top);
    }

  private:
    const glm::dvec3& point(std::int32_t place) const { return mesh_.points()[place]; }

    // Returns the surface's only point that is higher than its neighbours, if it has one and is a
    // sphere, by Euler's formula. "Higher" is along the cross product of two vectors.
    std::optional<std::int32_t> only_top() const {
        constexpr std::uint8_t elsewhere = 0, highest = 1, lower = 2;
        std::vector<std::uint8_t> state(mesh_.points().size(), elsewhere);
        const auto see = [&](std::int32_t place, bool is_lower) {
            state[place] = is_lower ? lower : std::max(state[place], highest);
        };
        for (std::size_t i = 0; i < edges_.size(); i += 2) {
            const auto& [low, high, face, apex] = edges_[i];
            const int sign = sign_of_determinant(point(low), point(high), across, glm::dvec3(0),
                                                 other_across, glm::dvec3(0));
            if (sign == 0) return {};
            see(low, sign < 0);
            see(high, sign > 0);
        }
        const auto points = std::ranges::count_if(state, [](auto s) { return s != elsewhere; });
        if (2 * points != std::ssize(mesh_.open_faces()) + 4) return {};
        const auto top = std::ranges::find(state, highest);
        if (top == state.end() || std::find(top + 1, state.end(), highest) != state.end())
            return {};
        return static_cast<std::int32_t>(top - state.begin());
    }

    // Tells whether the points around the top turn once around it: then they come nearer to a
    // plane that turns about an axis through the top, and then go away from it, once each.
    bool turns_once(std::int32_t top) const {
        std::vector<std::pair<std::int32_t, bool>>
            ways;  // each point twice: do the two edges rise?
        for (std::int32_t face = 0; face < std::ssize(mesh_.open_faces()); ++face) {
            const auto corners = open_face(mesh_, face);
            const auto at = std::ranges::find(corners, top) - corners.begin();
            if (at == 3) continue;
            const std::int32_t from = corners[(at + 1) % 3], to = corners[(at + 2) % 3];
            const int sign = sign_of_determinant(point(from), point(top), point(to), point(top),
                                                 across, glm::dvec3(0));
            if (sign == 0) return false;
            ways.emplace_back(from, sign > 0);
            ways.emplace_back(to, sign > 0);
        }
        std::ranges::sort(ways);
        int turns = 0;  // points at which a rise ends or begins
        for (std::size_t i = 0; i + 1 < ways.size(); i += 2)
            turns += ways[i].second != ways[i + 1].second;
        return turns == 2;
    }

    // Vectors that are at right angles to no edge of a mesh, but by a chance of 1e-15.
    static constexpr glm::dvec3 across{1, .7548776662466927, .1180339887498949},
        other_across{.2360679774997897, 1, .5698402909980532};

    const TetMesh& mesh_;
    std::span<const BoundaryEdge> edges_;
};

}  // namespace

EdgeLengths edge_lengths(const TetMesh& mesh) {
    const auto tets = std::ssize(mesh.tets());
    std::vector<EdgeLengths> found(
        static_cast<std::size_t>((tets + tets_per_task - 1) / tets_per_task), no_edges);
    parallel_for(std::ssize(found), 1, [&](std::int64_t task) {
        EdgeLengths& mine = found[task];
        const std::int64_t end = std::min(tets, (task + 1) * tets_per_task);
        for (std::int64_t tet = task * tets_per_task; tet < end; ++tet) {
            const auto corners = mesh.corners(static_cast<std::int32_t>(tet));
            for (const auto& [i, j] : tet_edges) {
                const double length = glm::length(corners[j] - corners[i]);
                mine.shortest = std::min(mine.shortest, length);
                mine.longest = std::max(mine.longest, length);
            }
        }
    });
    EdgeLengths all = no_edges;
    for (const EdgeLengths& mine : found) {
        all.shortest = std::min(all.shortest, mine.shortest);
        all.longest = std::max(all.longest, mine.longest);
    }
    return all;
}

Convexity convexity(const TetMesh& mesh) {
    if (mesh.findings().folded_faces > 0 || mesh.findings().nonmanifold_faces > 0)
        return Convexity::none;
    const double tolerance = flat_enough * glm::length(mesh.bounds().max - mesh.bounds().min);
    const std::vector<BoundaryEdge> edges = boundary_edges(mesh);
    FaceSets surfaces(mesh.open_faces().size());
    Convexity result = Convexity::exact;
    for (std::size_t i = 0; i < edges.size(); i += 2) {
        const bool closed = i + 1 < edges.size() && edges[i].same_place(edges[i + 1]);
        const bool more = i + 2 < edges.size() && edges[i].same_place(edges[i + 2]);
        if (!closed || more) return Convexity::none;
        const Convexity here = std::min(bend(mesh, edges[i], edges[i + 1], tolerance),
                                        bend(mesh, edges[i + 1], edges[i], tolerance));
        if (here == Convexity::none) return here;
        result = std::min(result, here);
        surfaces.join(edges[i].face, edges[i + 1].face);
    }
    return surfaces.count() == 1 && Winding(mesh, edges).is_single() ? result : Convexity::none;
}

}  // namespace lamina
