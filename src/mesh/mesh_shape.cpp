// SPDX-License-Identifier: Apache-2.0
#include "mesh/mesh_shape.h"

#include <algorithm>
#include <atomic>
#include <numeric>
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

// Tells whether the faces around each point of a closed surface without concave edges are part of
// a convex cone's boundary: pyramids on both sides of a pentagram go round their tops twice
// (docs/numerics.md, Convex meshes).
class Fans {
  public:
    Fans(const TetMesh& mesh, double tolerance)
        : mesh_(mesh), tolerance_(tolerance), starts_(mesh.points().size() + 1) {
        const auto count = static_cast<std::int32_t>(mesh.open_faces().size());
        for (std::int32_t face = 0; face < count; ++face)
            for (const std::int32_t point : open_face(mesh, face)) ++starts_[point + 1];
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        blades_.resize(3 * mesh.open_faces().size());
        std::vector<std::int32_t> next(starts_.begin(), starts_.end() - 1);
        for (std::int32_t face = 0; face < count; ++face) {
            const auto corners = open_face(mesh, face);
            for (std::size_t i = 0; i < 3; ++i)
                blades_[next[corners[i]]++] = {corners[(i + 1) % 3], corners[(i + 2) % 3]};
        }
    }

    // Returns the least convexity of all points. Parallel; call once.
    Convexity least() {
        std::atomic<bool> none = false, rounded = false;
        parallel_for(std::ssize(mesh_.points()), points_per_task, [&](std::int64_t point) {
            if (starts_[point] == starts_[point + 1] || none) return;
            const Convexity here = of_point(static_cast<std::int32_t>(point));
            if (here == Convexity::none) none = true;
            if (here == Convexity::within_rounding) rounded = true;
        });
        return none ? Convexity::none : rounded ? Convexity::within_rounding : Convexity::exact;
    }

  private:
    // A face at a point: its other corners, counter-clockwise as seen from outside.
    struct Blade {
        std::int32_t from, to;
    };
    static constexpr std::int64_t points_per_task = 4096;
    // Sine of the angle within which directions are one. A larger one may only deny convexity.
    static constexpr double one_direction = 1e-12;

    // Goes round a point from the edge to the first neighbour: this has to lie inside each face,
    // and in the cone of none but its own, and all other neighbours inside the first face.
    Convexity of_point(std::int32_t point) {
        const std::span<Blade> fan(blades_.begin() + starts_[point],
                                   blades_.begin() + starts_[point + 1]);
        std::ranges::sort(fan, {}, &Blade::from);
        const Blade first = fan.front();
        Convexity result = Convexity::exact;
        std::size_t seen = 1;
        for (Blade blade = first; blade.to != first.from; ++seen) {
            const auto next = std::ranges::lower_bound(fan, blade.to, {}, &Blade::from);
            if (next == fan.end() || next->from != blade.to || seen == fan.size())
                return Convexity::none;
            blade = *next;
            if (blade.to == first.from) continue;  // the last face: it has the edge, too
            const Plane plane(mesh_, point, blade);
            result = std::min({result, plane.has_inside(first.from, tolerance_),
                               Plane(mesh_, point, first).has_inside(blade.to, tolerance_)});
            if (plane.cone_has(first.from, tolerance_)) return Convexity::none;
        }
        return seen == fan.size() ? result : Convexity::none;
    }

    class Plane {
      public:
        Plane(const TetMesh& mesh, std::int32_t point, const Blade& blade)
            : mesh_(mesh),
              top_(at(point)),
              from_(at(blade.from)),
              to_(at(blade.to)),
              normal_(glm::cross(from_ - top_, to_ - top_)) {}

        Convexity has_inside(std::int32_t point, double tolerance) const {
            if (orientation(top_, from_, to_, at(point)) <= 0) return Convexity::exact;
            return height(point) <= tolerance * glm::length(normal_) ? Convexity::within_rounding
                                                                     : Convexity::none;
        }
        // Tells whether a point, if near the plane, is in the face's cone, edges included.
        bool cone_has(std::int32_t point, double tolerance) const {
            if (std::abs(height(point)) > tolerance * glm::length(normal_)) return false;
            const glm::dvec3 way = at(point) - top_;
            return turns_left(from_ - top_, way) && turns_left(way, to_ - top_);
        }

      private:
        const glm::dvec3& at(std::int32_t point) const { return mesh_.points()[point]; }
        double height(std::int32_t point) const { return glm::dot(normal_, at(point) - top_); }
        bool turns_left(const glm::dvec3& a, const glm::dvec3& b) const {
            return glm::dot(normal_, glm::cross(a, b)) >=
                   -one_direction * glm::length(normal_) * glm::length(a) * glm::length(b);
        }
        const TetMesh& mesh_;
        glm::dvec3 top_, from_, to_, normal_;
    };

    const TetMesh& mesh_;
    double tolerance_;
    std::vector<std::int32_t> starts_;  // of each point's blades
    std::vector<Blade> blades_;
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
    if (surfaces.count() != 1) return Convexity::none;
    return std::min(result, Fans(mesh, tolerance).least());
}

}  // namespace lamina
