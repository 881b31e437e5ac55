// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_shape.h"

#include <atomic>
#include <iterator>
#include <numeric>
#include <tuple>

#include <glm/vector_relational.hpp>
#include "base/parallel.h"
#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/ray_walk.h"

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

constexpr std::int64_t faces_per_task = 64;

// Limit on the pairs of faces examined, per face on average. Real meshes need far fewer.
constexpr std::int64_t max_tests_per_face = 60;

constexpr std::int64_t most_lines = 500, lines_per_task = 8;  // one line tests one component

bool meet(const FaceTree::Box& a, const FaceTree::Box& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// Tells whether the edge from p to q passes through the inside of a triangle.
bool pierces(const glm::dvec3& p, const glm::dvec3& q, const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    if (orientation(a, b, c, p) * orientation(a, b, c, q) >= 0) return false;
    const int first = orientation(p, q, a, b);
    return first != 0 && orientation(p, q, b, c) == first && orientation(p, q, c, a) == first;
}

bool edge_pierces(const Triangle& edges, const Triangle& triangle) {
    return pierces(edges[0], edges[1], triangle) || pierces(edges[1], edges[2], triangle) ||
           pierces(edges[2], edges[0], triangle);
}

// Implements count_overlapping_tets(): marks tets in three searches, and counts the marks.
class OverlapSearch {
  public:
    explicit OverlapSearch(const TetMesh& mesh)
        : mesh_(mesh), tree_(mesh, mesh.open_faces()), overlapping_(mesh.tets().size()) {}

    std::int64_t count() {
        mark_crossing();
        mark_shared();
        mark_inner_parts();
        return std::ranges::count(overlapping_, 1);
    }

  private:
    std::array<std::int32_t, 3> points_of(const TetFace& face) const {
        std::array<std::int32_t, 3> points =
            corners_of_face(mesh_.place(mesh_.tets()[face.tet]), face.face);
        std::sort(points.begin(), points.end());
        return points;
    }
    void mark(const TetFace& face) {
        std::atomic_ref<std::uint8_t>(overlapping_[face.tet]).store(1, std::memory_order_relaxed);
    }

    // Marks the tets of faces that cross. Faces with two points in common only touch.
    void mark_crossing() {
        const auto faces = mesh_.open_faces();
        std::atomic<std::int64_t> left{max_tests_per_face * std::ssize(faces)};
        parallel_for(std::ssize(faces), faces_per_task, [&](std::int64_t index) {
            const TetFace& face = faces[index];
            if (is_flat(face) || left <= 0) return;
            std::int64_t looks = 0;
            const Triangle here = mesh_.corners(face);
            const FaceTree::Box box = FaceTree::box_around(here);
            const auto points = points_of(face);
            tree_.visit([&](const FaceTree::Box& other) { return meet(box, other); },
                        [&](std::int32_t number) {
                            if (number <= index) return;
                            const TetFace& other = faces[number];
                            if (++looks > left || is_flat(other)) return;
                            if (shared_points(points, points_of(other)) >= 2) return;
                            const Triangle there = mesh_.corners(other);
                            if (!meet(box, FaceTree::box_around(there))) return;
                            if (!edge_pierces(here, there) && !edge_pierces(there, here)) return;
                            mark(face);
                            mark(other);
                        });
            left -= looks;
        });
    }
    bool is_flat(const TetFace& face) const {
        return std::ranges::binary_search(mesh_.flat_tets(), face.tet);
    }
    static int shared_points(const std::array<std::int32_t, 3>& a,
                             const std::array<std::int32_t, 3>& b) {
        int shared = 0;
        for (const std::int32_t point : a) shared += std::ranges::count(b, point) > 0;
        return shared;
    }

    // Marks the tets of open faces with the same corners: two or more lie on one side of the face.
    void mark_shared() {
        if (mesh_.findings().folded_faces + mesh_.findings().nonmanifold_faces == 0) return;
        std::vector<std::int32_t> order(mesh_.open_faces().size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::int32_t>(i);
        const auto face_of = [&](std::int32_t number) -> const TetFace& {
            return mesh_.open_faces()[number];
        };
        std::ranges::sort(order, {},
                          [&](std::int32_t number) { return points_of(face_of(number)); });
        for (std::size_t i = 1; i < order.size(); ++i) {
            const TetFace &a = face_of(order[i - 1]), &b = face_of(order[i]);
            if (points_of(a) != points_of(b)) continue;
            mark(a);
            mark(b);
        }
    }

    // Marks a tet of each connected component (part) inside another one. If no faces cross, a
    // component is inside as a whole, so one line through it suffices.
    void mark_inner_parts() {
        if (std::ranges::count(overlapping_, 1) > 0) return;
        std::vector<char> seen(mesh_.tets().size());
        std::vector<std::int32_t> waiting;
        std::vector<TetFace> parts;  // one open face of each component
        for (const TetFace& face : mesh_.open_faces()) {
            if (seen[face.tet]) continue;
            visit_part(face.tet, seen, waiting);
            parts.push_back(face);
        }
        if (parts.size() == 1) return;
        const std::int64_t step = (std::ssize(parts) - 1) / most_lines + 1;
        parallel_for((std::ssize(parts) - 1) / step + 1, lines_per_task, [&](std::int64_t index) {
            const TetFace& face = parts[index * step];
            const auto [a, b, c] = mesh_.corners(face);
            RayWalk walk(mesh_, tree_);
            walk.aim((a + b + c) / 3.0, glm::cross(b - a, c - a));
            if (walk.overlapping()) mark(face);
        });
    }
    void visit_part(std::int32_t tet, std::vector<char>& seen, std::vector<std::int32_t>& waiting) {
        waiting.assign(1, tet);
        seen[tet] = 1;
        while (!waiting.empty()) {
            const std::int32_t here = waiting.back();
            waiting.pop_back();
            for (const std::int32_t next : mesh_.neighbors()[here]) {
                if (next == TetMesh::no_neighbor || seen[next]) continue;
                seen[next] = 1;
                waiting.push_back(next);
            }
        }
    }

    const TetMesh& mesh_;
    FaceTree tree_;
    std::vector<std::uint8_t> overlapping_;
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
            const Tet& corners = mesh.tets()[tet];
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t j = i + 1; j < 4; ++j) {
                    const double length =
                        glm::length(mesh.points()[corners[j]] - mesh.points()[corners[i]]);
                    mine.shortest = std::min(mine.shortest, length);
                    mine.longest = std::max(mine.longest, length);
                }
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
    return surfaces.count() == 1 ? result : Convexity::none;
}

std::int64_t count_overlapping_tets(const TetMesh& mesh) {
    return OverlapSearch(mesh).count();
}

}  // namespace lamina
