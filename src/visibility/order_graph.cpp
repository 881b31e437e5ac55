// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_graph.h"

#include <algorithm>

#include "base/parallel.h"
#include "visibility/seen_area.h"

namespace lamina {
OrderGraph::OrderGraph(const TetMesh& mesh, bool across_gaps)
    : mesh_(mesh), signs_(mesh.tets().size()), farther_counts_(mesh.tets().size()) {
    if (!across_gaps) return;
    gaps_ = std::make_unique<OpenFaceConstraints>(mesh);
    first_gap_.resize(mesh.tets().size());
}

void OrderGraph::look_from(const Eye& eye) {
    eye_ = eye;
    find_signs();
    if (!gaps_) return;
    gap_edges_ = gaps_->find(eye);
    link_gaps();
}

void OrderGraph::find_signs() {
    const FaceSigner signer(mesh_, eye_);
    const auto neighbors = mesh_.neighbors();
    parallel_for(static_cast<std::int64_t>(signs_.size()), tets_per_task, [&](std::int64_t index) {
        const auto tet = static_cast<std::size_t>(index);
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
}

void OrderGraph::link_gaps() {
    std::fill(first_gap_.begin(), first_gap_.end(), -1);
    next_gap_.resize(gap_edges_.size());
    // The loop runs backwards, so that each list runs forwards.
    for (std::size_t i = gap_edges_.size(); i-- > 0;) {
        const auto& [exit, entry] = gap_edges_[i];
        const auto farther =
            static_cast<std::size_t>(mesh_.open_faces()[static_cast<std::size_t>(entry)].tet);
        next_gap_[i] = first_gap_[farther];
        first_gap_[farther] = static_cast<std::int32_t>(i);
        ++farther_counts_[static_cast<std::size_t>(
            mesh_.open_faces()[static_cast<std::size_t>(exit)].tet)];
    }
}

OrderGraph::Passage OrderGraph::passage(std::int32_t tet, std::int32_t edge) const {
    if (edge < faces) {
        const Triangle face = mesh_.corners({tet, edge});
        return {face, face, true};
    }
    const OpenFaceConstraint& gap = gap_edges_[static_cast<std::size_t>(edge - faces)];
    const auto corners = [&](std::int32_t open_face) {
        return mesh_.corners(mesh_.open_faces()[static_cast<std::size_t>(open_face)]);
    };
    return {corners(gap.exit), corners(gap.entry), false};
}

double OrderGraph::area(std::int32_t tet, std::int32_t edge) const {
    const Passage passed = passage(tet, edge);
    return passed.shared ? seen_area(eye_, passed.exit)
                         : seen_overlap(eye_, passed.exit, passed.entry);
}

}  // namespace lamina
