// SPDX-License-Identifier: Apache-2.0
#include "visibility/open_face_constraints.h"

#include <algorithm>
#include <atomic>

#include <glm/geometric.hpp>
#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"
#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "visibility/seen_shapes.h"

namespace lamina {

namespace {

// Faces that may be examined for each face, on average. Real meshes need far fewer.
constexpr std::size_t looks_a_face = 100;

class Search {
  public:
    explicit Search(const TetMesh& mesh)
        : mesh_(mesh),
          tree_(mesh, mesh.open_faces()),
          bounds_{mesh.bounds().min, mesh.bounds().max},
          left_(looks_a_face * mesh.open_faces().size()),
          outside_(mesh.points()[static_cast<std::size_t>(mesh.tets()[0][0])]) {}

    std::vector<std::int32_t> find() {
        std::vector<char> outermost(mesh_.open_faces().size());
        std::vector<std::int32_t> found;
        for (std::size_t i = 0; i < outermost.size(); ++i) {
            if (outermost[i]) continue;
            check_interrupt();
            const auto face = static_cast<std::int32_t>(i);
            if (!is_outermost(face)) {
                found.push_back(face);
                continue;
            }
            // One face of a flat side of the mesh is enough.
            for (const std::int32_t other : in_plane_)
                outermost[static_cast<std::size_t>(other)] = true;
        }
        return found;
    }

  private:
    Triangle triangle(std::int32_t face) const {
        return mesh_.corners(mesh_.open_faces()[static_cast<std::size_t>(face)]);
    }

    // Tells whether a face is outermost. Then `in_plane_` has all other faces of its plane.
    bool is_outermost(std::int32_t face) {
        const Triangle corners = triangle(face);
        const RoundedPlane plane(corners[1] - corners[0], corners[2] - corners[0]);
        in_plane_.clear();
        // A point outside of the last face is mostly outside of its neighbours, too.
        if (side_of(corners, plane, outside_) > 0) return false;
        const PlaneSide side(plane, corners[0], bounds_);
        bool outermost = true;
        const auto look_at = [&](std::int32_t other) {
            if (!outermost || other == face) return;
            if (left_ == 0) {
                outermost = false;
                return;
            }
            --left_;
            const Triangle there = triangle(other);
            if (!side.reaches(there)) return;
            bool in_plane = true;
            for (const glm::dvec3& point : there) {
                const int sign = side_of(corners, plane, point);
                in_plane &= sign == 0;
                if (sign <= 0) continue;
                outside_ = point;
                outermost = false;
                return;
            }
            if (!in_plane) return;
            const RoundedPlane touching(there[1] - there[0], there[2] - there[0]);
            if (is_sure(plane) && is_sure(touching) &&
                glm::dot(plane.normal, touching.normal) > 0) {
                in_plane_.push_back(other);
            } else {
                outermost = false;
            }
        };
        tree_.visit([&](const FaceTree::Box& box) { return outermost && side.reaches(box); },
                    look_at);
        return outermost;
    }

    // Tells whether the direction of its normal is certain.
    static bool is_sure(const RoundedPlane& plane) { return norm1(plane.normal) > plane.error; }

    const TetMesh& mesh_;
    FaceTree tree_;
    FaceTree::Box bounds_;
    std::size_t left_;    // looks at faces
    glm::dvec3 outside_;  // a point of the mesh: outside of the last face that is not outermost
    std::vector<std::int32_t> in_plane_;
};

}  // namespace

std::vector<std::int32_t> gap_faces(const TetMesh& mesh) {
    return Search(mesh).find();
}

namespace {

constexpr std::int64_t faces_per_task = 256;
constexpr std::size_t faces_per_run = 32;       // exits whose pairs are one task
constexpr std::size_t most_pairs = 10'000'000;  // some seconds, and 200 MB with the order's lists
constexpr std::size_t most_looks = 200'000'000;

std::vector<TetFace> faces_of(const TetMesh& mesh, std::span<const std::int32_t> open_faces) {
    std::vector<TetFace> faces;
    faces.reserve(open_faces.size());
    for (const std::int32_t face : open_faces)
        faces.push_back(mesh.open_faces()[static_cast<std::size_t>(face)]);
    return faces;
}

}  // namespace

OpenFaceConstraints::OpenFaceConstraints(const TetMesh& mesh)
    : OpenFaceConstraints(mesh, gap_faces(mesh)) {}

OpenFaceConstraints::OpenFaceConstraints(const TetMesh& mesh, std::vector<std::int32_t> gap_faces)
    : mesh_(mesh),
      open_faces_(std::move(gap_faces)),
      tree_(mesh, faces_of(mesh, open_faces_)),
      bounds_{mesh.bounds().min, mesh.bounds().max},
      boxes_(tree_.node_count()),
      seen_boxes_(open_faces_.size()),
      seen_(open_faces_.size()),
      signs_(open_faces_.size()),
      found_((open_faces_.size() + faces_per_run - 1) / faces_per_run) {
    triangles_.reserve(open_faces_.size());
    for (const std::int32_t face : open_faces_)
        triangles_.push_back(mesh.corners(mesh.open_faces()[static_cast<std::size_t>(face)]));
}

void OpenFaceConstraints::look_from(const Eye& eye) {
    const SeenBoxes seen_boxes(eye, 0.5 * bounds_.min + 0.5 * bounds_.max);
    parallel_for(static_cast<std::int64_t>(seen_.size()), faces_per_task, [&](std::int64_t index) {
        const auto face = static_cast<std::size_t>(index);
        seen_[face] = SeenTriangle(eye, triangles_[face]);
        seen_boxes_[face] = seen_boxes.of(triangles_[face]);
        signs_[face] = static_cast<std::int8_t>(seen_[face].sign());
    });
    const Boxes nothing{FaceTree::nothing(), FaceTree::nothing()};
    tree_.sum(std::span(boxes_), nothing, [&](std::int32_t index, Boxes& node) {
        const auto face = static_cast<std::size_t>(index);
        if (signs_[face] < 0) node.add({FaceTree::box_around(triangles_[face]), seen_boxes_[face]});
    });
}

std::span<const OpenFaceConstraint> OpenFaceConstraints::find(const Eye& eye) {
    look_from(eye);
    std::atomic<std::size_t> total{0}, looked_at{0};
    parallel_for(static_cast<std::int64_t>(found_.size()), 1, [&](std::int64_t index) {
        const auto run = static_cast<std::size_t>(index);
        found_[run].clear();
        const std::size_t end = std::min(seen_.size(), (run + 1) * faces_per_run);
        for (std::size_t face = run * faces_per_run; face < end; ++face) {
            if (signs_[face] <= 0) continue;
            const std::size_t before = found_[run].size();
            const std::size_t looked = find_from(face, eye, found_[run]);
            const std::size_t added = found_[run].size() - before;
            if (looked_at.fetch_add(looked, std::memory_order_relaxed) + looked > most_looks ||
                total.fetch_add(added, std::memory_order_relaxed) + added > most_pairs) {
                fail(
                    "more than {} pairs of open faces are seen one through the other, or {} may "
                    "be: the exact order is not for a mesh with so many gaps, mpvo is",
                    most_pairs, most_looks);
            }
        }
    });
    all_.clear();
    for (const auto& found : found_) all_.insert(all_.end(), found.begin(), found.end());
    return all_;
}

std::size_t OpenFaceConstraints::find_from(std::size_t index, const Eye& eye,
                                           std::vector<OpenFaceConstraint>& found) const {
    const SeenTriangle& exit = seen_[index];
    const FaceTree::Box& box = seen_boxes_[index];
    const SeenThrough behind(exit, bounds_);
    const auto tet_of = [&](std::int32_t open_face) {
        return mesh_.open_faces()[static_cast<std::size_t>(open_face)].tet;
    };
    const std::int32_t face = open_faces_[index];
    std::size_t looked = 0;
    const auto reaches = [&](std::size_t node) {
        return may_show(box, boxes_[node].seen) && behind.reaches(boxes_[node].world);
    };
    tree_.visit_nodes(reaches, [&](std::int32_t other) {
        ++looked;
        const auto entry = static_cast<std::size_t>(other);
        if (signs_[entry] >= 0 || !may_show(box, seen_boxes_[entry]) ||
            !behind.reaches(triangles_[entry]))
            return;
        const std::int32_t entered = open_faces_[entry];
        if (tet_of(entered) != tet_of(face) && exit.shows(eye, seen_[entry]))
            found.push_back({face, entered});
    });
    return looked;
}

}  // namespace lamina
