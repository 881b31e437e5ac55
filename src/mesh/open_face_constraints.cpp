// SPDX-License-Identifier: Apache-2.0
#include "mesh/open_face_constraints.h"

#include <algorithm>
#include <atomic>

#include "base/error.h"
#include "base/parallel.h"

namespace lamina {
namespace {

constexpr std::int64_t grain = 256;             // faces that are looked at in one task
constexpr std::size_t faces_per_run = 32;       // exits whose pairs are one task
constexpr std::size_t most_pairs = 10'000'000;  // some seconds, and 200 MB with the order's lists
constexpr std::size_t most_looks = 200'000'000;

FaceTree::Box box_of(const Triangle& triangle) {
    FaceTree::Box box = FaceTree::nothing();
    for (const glm::dvec3& corner : triangle) box.add(corner);
    return box;
}

}  // namespace

OpenFaceConstraints::OpenFaceConstraints(const TetMesh& mesh)
    : mesh_(mesh),
      tree_(mesh, mesh.open_faces()),
      bounds_{mesh.bounds().min, mesh.bounds().max},
      seen_(mesh.open_faces().size()),
      signs_(mesh.open_faces().size()),
      found_((mesh.open_faces().size() + faces_per_run - 1) / faces_per_run) {
    triangles_.reserve(seen_.size());
    for (const TetFace& face : mesh.open_faces()) {
        const auto [a, b, c] = corners_of_face(mesh.tets()[static_cast<std::size_t>(face.tet)],
                                               static_cast<std::size_t>(face.face));
        const auto points = mesh.points();
        triangles_.push_back({points[static_cast<std::size_t>(a)],
                              points[static_cast<std::size_t>(b)],
                              points[static_cast<std::size_t>(c)]});
    }
}

void OpenFaceConstraints::look_from(const Eye& eye) {
    parallel_for(static_cast<std::int64_t>(seen_.size()), grain, [&](std::int64_t index) {
        const auto face = static_cast<std::size_t>(index);
        seen_[face] = SeenTriangle(eye, triangles_[face]);
        signs_[face] = static_cast<std::int8_t>(seen_[face].sign());
    });
    tree_.refit([&](std::int32_t face) {
        return signs_[static_cast<std::size_t>(face)] < 0 ? box_of(triangle(face))
                                                          : FaceTree::nothing();
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
            const std::size_t looked = find_from(static_cast<std::int32_t>(face), eye, found_[run]);
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

std::size_t OpenFaceConstraints::find_from(std::int32_t index, const Eye& eye,
                                           std::vector<OpenFaceConstraint>& found) const {
    const SeenTriangle& exit = seen_[static_cast<std::size_t>(index)];
    const SeenThrough behind(exit, bounds_);
    const std::int32_t tet = mesh_.open_faces()[static_cast<std::size_t>(index)].tet;
    std::size_t looked = 0;
    tree_.visit([&](const FaceTree::Box& box) { return behind.reaches(box); },
                [&](std::int32_t other) {
                    ++looked;
                    const auto entry = static_cast<std::size_t>(other);
                    if (signs_[entry] >= 0 || !behind.reaches(triangles_[entry])) return;
                    if (mesh_.open_faces()[entry].tet != tet && exit.shows(eye, seen_[entry]))
                        found.push_back({index, other});
                });
    return looked;
}

}  // namespace lamina
