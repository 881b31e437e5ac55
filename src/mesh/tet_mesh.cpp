// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "mesh/face_matching.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

constexpr std::int64_t grain = 4096;                     // tets a task
constexpr std::size_t most_tets = std::size_t{1} << 29;  // four faces each must fit 32 bits

// Products of three coordinates must stay numbers (mesh/predicates.h).
constexpr double largest_coordinate = 1e100;

bool usable(const glm::dvec3& p) {
    return std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate &&
           std::abs(p.z) <= largest_coordinate;  // false for NaN
}

bool repeats_corner(Tet corners) {
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
}

// Returns whether two neighbours lie on the two sides of their common face, by the order of its
// corners. `face` is the face of `tet`, opposite the corner that `other` lacks.
bool opposite_sides(const Tet& tet, std::size_t face, const Tet& other) {
    const auto [p, q, r] = corners_of_face(tet, face);
    std::size_t apex = 0;
    while (other[apex] == p || other[apex] == q || other[apex] == r) ++apex;
    const auto seen = corners_of_face(other, apex);
    const auto at = static_cast<std::size_t>(std::find(seen.begin(), seen.end(), p) - seen.begin());
    return seen[(at + 1) % 3] == r;
}

void turn(Tet& tet, std::array<std::int32_t, 4>& neighbors) {
    std::swap(tet[2], tet[3]);
    std::swap(neighbors[2], neighbors[3]);
}

}  // namespace

TetMesh::TetMesh(MeshData data, const std::string& name)
    : points_(std::move(data.points)),
      tets_(std::move(data.tets)),
      point_scalars_(std::move(data.point_scalars)),
      cell_scalars_(std::move(data.cell_scalars)) {
    findings_.cells = data.cells;
    findings_.tets_read = static_cast<std::int64_t>(tets_.size());
    check_corners(name);
    drop_repeated_corners();
    if (tets_.empty()) fail("{}: all {} tets repeat a corner", name, findings_.tets_read);
    check_points(name);
    FaceMatching matching = match_faces(tets_, points_.size());
    if (!matching.duplicates.empty()) {
        findings_.duplicates = static_cast<std::int64_t>(matching.duplicates.size());
        std::vector<char> dropped(tets_.size(), 0);
        for (const std::int32_t tet : matching.duplicates)
            dropped[static_cast<std::size_t>(tet)] = 1;
        drop(dropped);
        matching = match_faces(tets_, points_.size());
    }
    neighbors_ = std::move(matching.neighbors);
    findings_.boundary_faces = matching.boundary_faces;
    findings_.nonmanifold_faces = matching.nonmanifold_faces;
    orient();
    orient_flat();
    cut_folded_faces();
    list_open_faces();
}

std::array<glm::dvec3, 3> TetMesh::corners(const TetFace& face) const {
    const auto [a, b, c] = corners_of_face(tets_[static_cast<std::size_t>(face.tet)],
                                           static_cast<std::size_t>(face.face));
    return {points_[static_cast<std::size_t>(a)], points_[static_cast<std::size_t>(b)],
            points_[static_cast<std::size_t>(c)]};
}

void TetMesh::check_corners(const std::string& name) const {
    if (tets_.empty()) fail("{}: found no tetrahedra, expected at least one", name);
    if (tets_.size() >= most_tets)
        fail("{}: found {} tets, expected fewer than {}", name, tets_.size(), most_tets);
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        for (const std::int32_t corner : tets_[tet]) {
            if (corner < 0 || static_cast<std::size_t>(corner) >= points_.size())
                fail("{}: tet {} has corner {}, expected 0 to {}", name, tet, corner,
                     static_cast<std::int64_t>(points_.size()) - 1);
        }
    }
}

void TetMesh::check_points(const std::string& name) {
    std::vector<char> used(points_.size(), 0);
    for (const Tet& tet : tets_) {
        for (const std::int32_t corner : tet) used[static_cast<std::size_t>(corner)] = 1;
    }
    bounds_ = {glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (used[i] == 0) {
            ++findings_.unused_points;
            continue;
        }
        const glm::dvec3& p = points_[i];
        if (!usable(p))
            fail("{}: point {} is ({}, {}, {}), expected finite numbers up to 1e100", name, i, p.x,
                 p.y, p.z);
        bounds_.min = glm::min(bounds_.min, p);
        bounds_.max = glm::max(bounds_.max, p);
    }
}

void TetMesh::drop(const std::vector<char>& dropped) {
    const auto compact = [&](auto& items) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (dropped[i] == 0) items[kept++] = items[i];
        }
        items.resize(kept);
    };
    compact(tets_);
    for (MeshScalar& scalar : cell_scalars_) compact(scalar.values);
}

void TetMesh::drop_repeated_corners() {
    std::vector<char> dropped(tets_.size(), 0);
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        if (!repeats_corner(tets_[tet])) continue;
        dropped[tet] = 1;
        ++findings_.repeated_corners;
    }
    findings_.degenerate = findings_.repeated_corners;
    if (findings_.repeated_corners > 0) drop(dropped);
}

void TetMesh::orient() {
    std::vector<char> flat(tets_.size(), 0);
    std::atomic<std::int64_t> inverted{0};
    parallel_for(static_cast<std::int64_t>(tets_.size()), grain, [&](std::int64_t index) {
        const auto i = static_cast<std::size_t>(index);
        const auto at = [&](std::size_t k) {
            return points_[static_cast<std::size_t>(tets_[i][k])];
        };
        const int sign = orientation(at(0), at(1), at(2), at(3));
        flat[i] = sign == 0;
        if (sign >= 0) return;
        turn(tets_[i], neighbors_[i]);
        inverted.fetch_add(1, std::memory_order_relaxed);
    });
    findings_.inverted = inverted;
    for (std::size_t tet = 0; tet < flat.size(); ++tet) {
        if (flat[tet] != 0) flat_.push_back(static_cast<std::int32_t>(tet));
    }
    findings_.degenerate += static_cast<std::int64_t>(flat_.size());
}

// A flat tet has no orientation of its own. It gets the one that agrees with a neighbour.
void TetMesh::orient_flat() {
    std::vector<char> open(tets_.size(), 0);
    for (const std::int32_t tet : flat_) open[static_cast<std::size_t>(tet)] = 1;
    std::vector<std::int32_t> waiting = flat_;
    for (bool progress = true; progress && !waiting.empty();) {
        std::vector<std::int32_t> left;
        for (const std::int32_t index : waiting) {
            const auto tet = static_cast<std::size_t>(index);
            std::size_t face = 0;
            const auto oriented = [&](std::int32_t other) {
                return other != no_neighbor && open[static_cast<std::size_t>(other)] == 0;
            };
            while (face < 4 && !oriented(neighbors_[tet][face])) ++face;
            if (face == 4) {
                left.push_back(index);
                continue;
            }
            const Tet& other = tets_[static_cast<std::size_t>(neighbors_[tet][face])];
            if (!opposite_sides(tets_[tet], face, other)) turn(tets_[tet], neighbors_[tet]);
            open[tet] = 0;
        }
        progress = left.size() < waiting.size();
        waiting = std::move(left);
    }
}

void TetMesh::cut_folded_faces() {
    std::atomic<std::int64_t> folded{0};
    parallel_for(static_cast<std::int64_t>(tets_.size()), grain, [&](std::int64_t index) {
        const auto tet = static_cast<std::size_t>(index);
        for (std::size_t face = 0; face < 4; ++face) {
            const std::int32_t other = neighbors_[tet][face];
            if (other == no_neighbor) continue;
            if (opposite_sides(tets_[tet], face, tets_[static_cast<std::size_t>(other)])) continue;
            neighbors_[tet][face] = no_neighbor;
            folded.fetch_add(1, std::memory_order_relaxed);
        }
    });
    findings_.folded_faces = folded / 2;  // each was counted from both tets
}

void TetMesh::list_open_faces() {
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            if (neighbors_[tet][face] == no_neighbor)
                open_faces_.push_back(
                    {static_cast<std::int32_t>(tet), static_cast<std::int32_t>(face)});
        }
    }
}

}  // namespace lamina
