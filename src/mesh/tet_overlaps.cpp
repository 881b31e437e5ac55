// SPDX-License-Identifier: Apache-2.0
// Finds overlapping tets: a tree of boxes proposes pairs, and the separating axis theorem decides.
// Two tets have no inner point in common if and only if a plane separates them that is the plane of
// a face, or is parallel to an edge of each. Planes of faces are tested exactly, so tets that share
// a face, an edge, or a corner in a mesh's usual places are never listed.
#include "mesh/tet_overlaps.h"

#include <atomic>
#include <numeric>

#include <glm/vector_relational.hpp>
#include "base/parallel.h"
#include "mesh/face_tree.h"

namespace lamina {
namespace {

constexpr std::int64_t tets_per_task = 256;

// Limit on the pairs examined, per tet on average, and for a mesh of few tets that all overlap. A
// tet of a Delaunay mesh meets the boxes of 80, and each pair is examined once.
constexpr std::int64_t most_tests_per_tet = 200, most_tests_of_few = 1'000'000;

// Distance, as a share of the far end's, within which two places of entry are one (tie_distance()).
constexpr double tie_share = 1e-10;

struct PlacedTet {
    std::array<glm::dvec3, 4> corners;
    Tet places;
};

constexpr std::array<std::array<std::size_t, 2>, 6> edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

struct FacePlane {
    Triangle corners;
    RoundedPlane plane;
};

std::array<FacePlane, 4> faces_of(const PlacedTet& tet) {
    std::array<FacePlane, 4> found;
    for (std::size_t face = 0; face < 4; ++face) {
        const auto [i, j, k] = corners_of_face({0, 1, 2, 3}, face);
        const Triangle corners{tet.corners[i], tet.corners[j], tet.corners[k]};
        found[face] = {corners, RoundedPlane(corners[1] - corners[0], corners[2] - corners[0])};
    }
    return found;
}

// Tells whether one of a tet's faces separates it from another tet, which may touch it. Exact.
bool some_separates(const std::array<FacePlane, 4>& faces, const PlacedTet& other) {
    return std::ranges::any_of(faces, [&](const FacePlane& face) {
        return std::ranges::all_of(other.corners, [&](const glm::dvec3& point) {
            return side_of(face.corners, face.plane, point) >= 0;
        });
    });
}

// Tells whether the plane through `base` that is parallel to two edges surely has tet `a` on its
// inner side and `b` on its outer side, or the other way round, apart from the corners marked as
// lying on it exactly. `on_a`, `on_b`: bits of the corners.
bool surely_apart(const glm::dvec3& base, const RoundedPlane& plane, const PlacedTet& a,
                  unsigned on_a, const PlacedTet& b, unsigned on_b) {
    const auto side = [&](const PlacedTet& tet, unsigned on) {
        int common = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if ((on >> i & 1) != 0) continue;
            const int sign = plane.sign(tet.corners[i] - base);
            if (sign == 0 || sign == -common) return 0;
            common = sign;
        }
        return common;
    };
    const int of_a = side(a, on_a);
    return of_a != 0 && side(b, on_b) == -of_a;
}

// Tells whether a plane parallel to an edge of each tet surely separates them. If the tets share a
// corner, planes through it suffice, and it and its edges' other ends lie on these exactly.
bool edges_separate(const PlacedTet& a, const PlacedTet& b) {
    for (std::size_t i = 0; i < 4; ++i) {
        const auto same = std::ranges::find(b.places, a.places[i]);
        if (same == b.places.end()) continue;
        const auto j = static_cast<std::size_t>(same - b.places.begin());
        for (std::size_t p = 0; p < 4; ++p) {
            for (std::size_t q = 0; q < 4; ++q) {
                if (p == i || q == j) continue;
                const RoundedPlane plane(a.corners[p] - a.corners[i], b.corners[q] - a.corners[i]);
                if (surely_apart(a.corners[i], plane, a, 1U << i | 1U << p, b, 1U << j | 1U << q))
                    return true;
            }
        }
        return false;
    }
    for (const auto& [i, p] : edges) {
        for (const auto& [j, q] : edges) {
            // The plane through the edge of `a`; a corner of `b` on it would only touch it.
            const RoundedPlane plane(a.corners[p] - a.corners[i], b.corners[q] - b.corners[j]);
            if (surely_apart(a.corners[i], plane, a, 1U << i | 1U << p, b, 0)) return true;
        }
    }
    return false;
}

bool boxes_meet(const FaceTree::Box& a, const FaceTree::Box& b) {
    return glm::all(glm::lessThan(a.min, b.max)) && glm::all(glm::lessThan(b.min, a.max));
}

}  // namespace

std::optional<std::vector<TetPair>> overlapping_pairs(const TetMesh& mesh, std::size_t most) {
    const auto count = std::ssize(mesh.tets());
    const auto placed = [&](std::int64_t tet) {
        PlacedTet found{{}, mesh.place(mesh.tets()[tet])};
        for (std::size_t i = 0; i < 4; ++i) found.corners[i] = mesh.points()[mesh.tets()[tet][i]];
        return found;
    };
    std::vector<FaceTree::Box> boxes(mesh.tets().size());
    parallel_for(count, tets_per_task,
                 [&](std::int64_t tet) { boxes[tet] = FaceTree::box_around(placed(tet).corners); });
    const FaceTree tree(boxes);
    const auto flat = [&](std::int64_t tet) {
        return std::ranges::binary_search(mesh.flat_tets(), static_cast<std::int32_t>(tet));
    };

    const std::int64_t tasks = (count + tets_per_task - 1) / tets_per_task;
    std::vector<std::vector<TetPair>> found(static_cast<std::size_t>(tasks));
    std::atomic<std::int64_t> left{std::max(most_tests_of_few, most_tests_per_tet * count)};
    std::atomic<std::size_t> total{0};
    parallel_for(tasks, 1, [&](std::int64_t task) {
        const std::int64_t end = std::min(count, (task + 1) * tets_per_task);
        std::vector<TetPair>& mine = found[task];
        for (std::int64_t first = task * tets_per_task; first < end; ++first) {
            if (left < 0 || total > most) return;
            if (flat(first)) continue;
            const PlacedTet here = placed(first);
            const std::array<FacePlane, 4> faces = faces_of(here);
            const auto& neighbors = mesh.neighbors()[first];
            std::int64_t tests = 0;
            const std::size_t before = mine.size();
            tree.visit([&](const FaceTree::Box& box) { return boxes_meet(box, boxes[first]); },
                       [&](std::int32_t second) {
                           if (second <= first || !boxes_meet(boxes[second], boxes[first])) return;
                           if (std::ranges::find(neighbors, second) != neighbors.end()) return;
                           ++tests;
                           const PlacedTet there = placed(second);
                           if (some_separates(faces, there) ||
                               some_separates(faces_of(there), here) ||
                               edges_separate(here, there) || flat(second))
                               return;
                           mine.emplace_back(static_cast<std::int32_t>(first), second);
                       });
            std::sort(mine.begin() + static_cast<std::ptrdiff_t>(before), mine.end());
            left -= tests;
            total += mine.size() - before;
        }
    });
    if (left < 0 || total > most) return std::nullopt;
    std::vector<TetPair> all;
    for (const auto& mine : found) all.insert(all.end(), mine.begin(), mine.end());
    return all;
}

double tie_distance(const TetMesh& mesh, const Eye& eye) {
    const auto& [low, high] = mesh.bounds();
    if (eye.at_infinity) return tie_share * glm::length(high - low);
    return tie_share *
           glm::length(glm::max(glm::abs(low - eye.position), glm::abs(high - eye.position)));
}

EntryRule entry_rule(const TetMesh& mesh, const Eye& eye, const glm::dvec3& direction) {
    return {eye.at_infinity ? -INFINITY : 0, tie_distance(mesh, eye) / glm::length(direction)};
}

}  // namespace lamina
