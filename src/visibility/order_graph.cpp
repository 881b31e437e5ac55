// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_graph.h"

#include "base/parallel.h"

namespace lamina {
namespace {

// Bounds the error of a rounded determinant, by the cube of the largest coordinate: 8 half ulps of
// its permanent (Shewchuk 1997, section 4.3; at most 6 cubes), doubled for rounding of the bound.
constexpr double error_bound = 96 * (std::numeric_limits<double>::epsilon() / 2);

double largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// A tet's state in FarthestFirst: unmet; on the path (face `state - first_face` is next); drawn.
constexpr std::uint8_t unmet = 0, first_face = 1, drawn = 6;

}  // namespace

// Computes rounded determinants of the four faces, which share two cross products.
FaceSigner::Rounded FaceSigner::rounded(const Tet& tet) const {
    std::array<glm::dvec3, 4> p;
    double reach = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        p[i] = points_[tet[i]] - eye_.position;
        reach = std::max(reach, largest(p[i]));
    }
    const glm::dvec3 p01 = glm::cross(p[0], p[1]), p23 = glm::cross(p[2], p[3]);
    return {{glm::dot(p[1], p23), -glm::dot(p[0], p23), glm::dot(p[3], p01), -glm::dot(p[2], p01)},
            error_bound * reach * reach * reach};
}

FaceSigner::Rounded FaceSigner::rounded_at_infinity(const Tet& tet) const {
    const glm::dvec3& d = eye_.position;
    const glm::dvec3& origin = points_[tet[0]];
    std::array<glm::dvec3, 3> p;
    double reach = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = points_[tet[i + 1]] - origin;
        reach = std::max(reach, largest(p[i]));
    }
    const glm::dvec3 d1 = glm::cross(d, p[0]), d3 = glm::cross(d, p[2]);
    const double d12 = glm::dot(d1, p[1]), d13 = glm::dot(d1, p[2]), d23 = -glm::dot(d3, p[1]);
    // Face 0 has the sum of the other three determinants; its error bound is used for all faces.
    return {{d12 + d23 - d13, -d23, d13, -d12}, 4 * error_bound * largest(d) * reach * reach};
}

// Avoids branches on signs, which could not be predicted.
FaceSigns FaceSigner::signs(std::size_t index) const {
    const Tet& tet = tets_[index];
    const Rounded seen = eye_.at_infinity ? rounded_at_infinity(tet) : rounded(tet);
    FaceSigns nearer = 0, farther = 0;
    for (std::size_t face = 0; face < 4; ++face) {
        const double value = seen.determinants[face];
        nearer |= FaceSigns{-value > seen.error} << face;
        farther |= FaceSigns{value > seen.error} << face;
    }
    if ((nearer | farther) != 0xf) {
        for (std::size_t face = 0; face < 4; ++face) {
            if ((nearer | farther) & nearer_bit(face)) continue;
            const auto [a, b, c] = corners_of_face(tet, face);
            const int sign = sign_as_seen(eye_, points_[a], points_[b], points_[c]);
            nearer |= FaceSigns{sign < 0} << face;
            farther |= FaceSigns{sign > 0} << face;
        }
    }
    return nearer | farther * farther_bit(0);
}

OrderGraph::OrderGraph(const TetMesh& mesh, bool across_gaps, std::span<const TetPair> overlaps)
    : mesh_(mesh),
      signs_(mesh.tets().size()),
      farther_counts_(mesh.tets().size()),
      faces_of_gaps_(mesh.open_faces()) {
    if (!across_gaps) return;
    gaps_ = std::make_unique<OpenFaceConstraints>(mesh);
    if (!overlaps.empty()) {
        overlaps_ = std::make_unique<OverlapConstraints>(mesh, overlaps);
        faces_of_gaps_ = overlaps_->faces();
    }
    first_gap_.resize(mesh.tets().size());
}

void OrderGraph::look_from(const Eye& eye) {
    eye_ = eye;
    const FaceSigner signer(mesh_, eye_);
    const auto neighbors = mesh_.neighbors();
    parallel_for(std::ssize(signs_), tets_per_task, [&](std::size_t tet) {
        FaceSigns shared = 0;
        for (std::size_t face = 0; face < 4; ++face) {
            shared |= FaceSigns{neighbors[tet][face] != TetMesh::no_neighbor} *
                      (nearer_bit(face) | farther_bit(face));
        }
        const FaceSigns signs = signer.signs(tet) & shared;
        signs_[tet] = static_cast<std::uint8_t>(signs);
        std::int32_t farther = 0;
        for (std::size_t face = 0; face < 4; ++face) farther += (signs & farther_bit(face)) != 0;
        farther_counts_[tet] = farther;
    });
    if (!gaps_) return;
    gap_edges_ = gaps_->find(eye);
    if (overlaps_) {
        const auto more = overlaps_->find(eye);
        all_edges_.assign(gap_edges_.begin(), gap_edges_.end());
        all_edges_.insert(all_edges_.end(), more.begin(), more.end());
        gap_edges_ = all_edges_;
    }
    std::fill(first_gap_.begin(), first_gap_.end(), -1);
    next_gap_.resize(gap_edges_.size());
    // Backwards, because each edge is put at the front of its tet's list.
    for (std::size_t i = gap_edges_.size(); i-- > 0;) {
        const auto& [exit, entry] = gap_edges_[i];
        const auto farther = static_cast<std::size_t>(faces_of_gaps_[entry].tet);
        next_gap_[i] = first_gap_[farther];
        first_gap_[farther] = static_cast<std::int32_t>(i);
        ++farther_counts_[faces_of_gaps_[exit].tet];
    }
}

OrderGraph::Passage OrderGraph::passage(std::int32_t tet, std::int32_t edge) const {
    if (edge < faces) {
        const Triangle face = mesh_.corners({tet, edge});
        return {face, face, true, false};
    }
    const auto index = static_cast<std::size_t>(edge - faces);
    const OpenFaceConstraint& gap = gap_edges_[index];
    const auto corners = [&](std::int32_t face) { return mesh_.corners(faces_of_gaps_[face]); };
    Passage passed{corners(gap.exit), corners(gap.entry), false, overlaps_ != nullptr};
    auto& [a, b, c] = passed.exit;
    if (passed.behind && sign_as_seen(eye_, a, b, c) < 0) std::swap(b, c);
    return passed;
}

double OrderGraph::area(std::int32_t tet, std::int32_t edge) const {
    const Passage passed = passage(tet, edge);
    if (passed.shared) return seen_area(eye_, passed.exit);
    return seen_overlap(eye_, passed.exit, passed.entry,
                        passed.behind ? tie_distance(mesh_, eye_) : INFINITY);
}

FarthestFirst::FarthestFirst(const TetMesh& mesh) : mesh_(mesh), next_face_(mesh.tets().size()) {
    starts_.reserve(mesh.open_faces().size());
}

std::int64_t FarthestFirst::sort(const OrderGraph& graph, std::span<std::int32_t> order) {
    starts_.clear();
    for (const TetFace& face : mesh_.open_faces()) {
        const auto [a, b, c] = mesh_.corners(face);
        if (sign_as_seen(graph.eye(), a, b, c) < 0)
            starts_.push_back({view_distance(graph.eye(), (a + b + c) / 3.0), face.tet});
    }
    std::sort(starts_.begin(), starts_.end());
    std::fill(next_face_.begin(), next_face_.end(), unmet);
    drawn_ = 0;
    broken_ = 0;
    for (const Start& start : starts_) draw(graph, start.tet, order);
    // If the eye is inside the mesh, some tets cannot be reached from open faces towards it.
    for (std::size_t tet = 0; tet < order.size(); ++tet)
        draw(graph, static_cast<std::int32_t>(tet), order);
    return broken_;
}

void FarthestFirst::draw(const OrderGraph& graph, std::int32_t root,
                         std::span<std::int32_t> order) {
    if (next_face_[root] != unmet) return;
    // The search's path grows downwards from the end of `order`: no tet is both on it and drawn.
    std::size_t top = order.size();
    order[--top] = root;
    next_face_[root] = first_face;
    while (top < order.size()) {
        const std::int32_t tet = order[top];
        std::uint8_t& state = next_face_[tet];
        const FaceSigns signs = graph.signs(tet);
        while (state < first_face + 4 && !(signs & farther_bit(state - first_face))) ++state;
        if (state == first_face + 4) {
            state = drawn;
            ++top;
            order[drawn_++] = tet;
            continue;
        }
        const auto face = static_cast<std::size_t>(state++ - first_face);
        const std::int32_t farther = mesh_.neighbors()[tet][face];
        std::uint8_t& other = next_face_[farther];
        if (other == unmet) {
            other = first_face;
            order[--top] = farther;
        } else if (other != drawn) {
            ++broken_;
        }
    }
}

}  // namespace lamina
