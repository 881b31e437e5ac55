// SPDX-License-Identifier: Apache-2.0
#include "visibility/overlap_constraints.h"

#include "base/parallel.h"

namespace lamina {
namespace {

constexpr std::int64_t pairs_per_task = 64, seen_per_task = 64;

// Faces lie in one plane if their corners are at most this share of tie_distance() off it: then a
// ray meets both within that distance if it is not within .001 of a face's direction.
constexpr double share_of_tie = 1e-3;

// Sine of the angle between two planes below which a ray may meet both within tie_distance() at
// more than ring_order.cpp's margin from the line where they cross, so that pixels decide.
constexpr double nearly_parallel = 1e-5;

Triangle turned(const Triangle& corners) {
    return {corners[0], corners[2], corners[1]};
}

glm::dvec3 normal_of(const Triangle& corners) {
    return glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

// Returns the largest distance of a triangle's corners from the plane of another.
double distance_from_plane(const Triangle& plane, const Triangle& corners) {
    const glm::dvec3 normal = normal_of(plane);
    double most = 0;
    for (const glm::dvec3& corner : corners)
        most = std::max(most, std::abs(glm::dot(normal, corner - plane[0])));
    return most;
}

}  // namespace

OverlapConstraints::OverlapConstraints(const TetMesh& mesh, std::span<const TetPair> pairs)
    : mesh_(mesh),
      pairs_(pairs.begin(), pairs.end()),
      open_faces_(static_cast<std::int32_t>(mesh.open_faces().size())),
      faces_(mesh.open_faces().begin(), mesh.open_faces().end()),
      first_face_(mesh.tets().size(), -1),
      found_((pairs.size() + pairs_per_task - 1) / pairs_per_task) {
    const auto add = [&](std::int32_t tet) {
        if (tet == TetMesh::no_neighbor || first_face_[tet] >= 0) return;
        first_face_[tet] = static_cast<std::int32_t>(faces_.size());
        for (std::int32_t face = 0; face < 4; ++face) faces_.push_back({tet, face});
    };
    for (const auto& [a, b] : pairs_) {
        for (const std::int32_t tet : {a, b}) {
            add(tet);
            for (const std::int32_t neighbor : mesh.neighbors()[tet]) add(neighbor);
        }
    }
    seen_.resize((faces_.size() - mesh.open_faces().size()) / 4);
}

void OverlapConstraints::look_from(const Eye& eye) {
    parallel_for(std::ssize(seen_), seen_per_task, [&](std::int64_t index) {
        SeenTet& tet = seen_[index];
        tet.around_eye = true;
        for (std::size_t face = 0; face < 4; ++face) {
            const auto number = static_cast<std::size_t>(open_faces_ + 4 * index) + face;
            const Triangle corners = mesh_.corners(faces_[number]);
            tet.faces[face] = SeenTriangle(eye, corners);
            if (tet.faces[face].sign() >= 0) continue;
            tet.fronts[face] = SeenTriangle(eye, turned(corners));
            tet.around_eye = false;
        }
    });
}

std::span<const OpenFaceConstraint> OverlapConstraints::find(const Eye& eye) {
    look_from(eye);
    const double tie = tie_distance(mesh_, eye);
    parallel_for(std::ssize(found_), 1, [&](std::int64_t task) {
        Found& mine = found_[task];
        mine.clear();
        const auto first = static_cast<std::size_t>(task * pairs_per_task);
        const std::size_t end = std::min(pairs_.size(), first + pairs_per_task);
        for (std::size_t i = first; i < end; ++i) {
            order_fronts(eye, tie, pairs_[i], mine);
            order_behind(eye, pairs_[i].first, pairs_[i].second, mine);
            order_behind(eye, pairs_[i].second, pairs_[i].first, mine);
        }
    });
    all_.clear();
    for (const Found& found : found_) all_.insert(all_.end(), found.begin(), found.end());
    return all_;
}

// Finds constraint 1 of a pair.
void OverlapConstraints::order_fronts(const Eye& eye, double tie, const TetPair& pair,
                                      Found& found) const {
    const auto& [a, b] = pair;
    const SeenTet &seen_a = seen(a), &seen_b = seen(b);
    // No tet is nearer than one around the eye, so such constraints are in no ring, and none asks
    // for the faces in which they are seen.
    if (seen_a.around_eye) return found.push_back({face_index(a, 0), face_index(b, 0)});
    if (seen_b.around_eye) return found.push_back({face_index(b, 0), face_index(a, 0)});
    for (std::size_t of_a = 0; of_a < 4; ++of_a) {
        if (seen_a.faces[of_a].sign() >= 0) continue;
        for (std::size_t of_b = 0; of_b < 4; ++of_b) {
            if (seen_b.faces[of_b].sign() < 0) order_front(eye, tie, a, of_a, b, of_b, found);
        }
    }
}

// Orders tets a < b in the pixels in which the eye sees the given front faces one behind the other.
void OverlapConstraints::order_front(const Eye& eye, double tie, std::int32_t a, std::size_t of_a,
                                     std::int32_t b, std::size_t of_b, Found& found) const {
    const OpenFaceConstraint a_first{face_index(a, of_a), face_index(b, of_b)},
        b_first{a_first.entry, a_first.exit};
    const bool a_shows = seen(a).fronts[of_a].shows(eye, seen(b).faces[of_b]);
    const bool b_shows = seen(b).fronts[of_b].shows(eye, seen(a).faces[of_a]);
    if (!a_shows && !b_shows) return;
    const Triangle face_a = mesh_.corners(faces_[a_first.exit]),
                   face_b = mesh_.corners(faces_[a_first.entry]);
    const bool in_one_plane = std::min(distance_from_plane(face_a, face_b),
                                       distance_from_plane(face_b, face_a)) <= share_of_tie * tie;
    const bool unsure =
        in_one_plane ||
        glm::length(glm::cross(normal_of(face_a), normal_of(face_b))) < nearly_parallel;
    if (unsure) {
        order_before(a, of_a, a_first.entry, found);
        order_before(b, of_b, a_first.exit, found);
    }
    if (in_one_plane) return found.push_back(a_first);
    if (a_shows || unsure) found.push_back(a_first);
    if (b_shows || unsure) found.push_back(b_first);
}

// Finds constraint 3: rays leave a tet's neighbour in front of it where they enter another tet.
void OverlapConstraints::order_before(std::int32_t tet, std::size_t front, std::int32_t entry,
                                      Found& found) const {
    const std::int32_t before = mesh_.neighbors()[tet][front];
    if (before == TetMesh::no_neighbor) return;
    const auto& across = mesh_.neighbors()[before];
    const auto exit = static_cast<std::size_t>(std::ranges::find(across, tet) - across.begin());
    found.push_back({face_index(before, exit), entry});
}

// Finds constraint 2: rays leave `inner` by an open face, then `outer` by a shared one.
void OverlapConstraints::order_behind(const Eye& eye, std::int32_t inner, std::int32_t outer,
                                      Found& found) const {
    const SeenTet& seen_inner = seen(inner);
    const auto& around = mesh_.neighbors()[outer];
    for (std::size_t exit = 0; exit < 4; ++exit) {
        if (mesh_.neighbors()[inner][exit] != TetMesh::no_neighbor ||
            seen_inner.faces[exit].sign() <= 0)
            continue;
        for (std::size_t face = 0; face < 4; ++face) {
            const std::int32_t behind = around[face];
            if (behind == TetMesh::no_neighbor || behind == inner ||
                seen(outer).faces[face].sign() <= 0)
                continue;
            const auto& back = mesh_.neighbors()[behind];
            const auto entry =
                static_cast<std::size_t>(std::ranges::find(back, outer) - back.begin());
            if (seen_inner.faces[exit].shows(eye, seen(behind).faces[entry]))
                found.push_back({face_index(inner, exit), face_index(behind, entry)});
        }
    }
}

}  // namespace lamina
