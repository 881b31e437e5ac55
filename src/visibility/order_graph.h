// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "visibility/face_signs.h"
#include "visibility/open_face_constraints.h"

namespace lamina {

// Which tets hide which, for one eye after the other. It is a graph with an edge from each tet to
// every tet that is nearer and must therefore be drawn after it. Edges lead across shared faces
// and, if wanted, across the gaps between open faces. The mesh must outlive this object.
class OrderGraph {
  public:
    OrderGraph(const TetMesh& mesh, bool across_gaps);

    void look_from(const Eye& eye);  // parallel

    const TetMesh& mesh() const { return mesh_; }
    const Eye& eye() const { return eye_; }

    // The signs of shared faces only; no bit of an open face is set.
    FaceSigns signs(std::int32_t tet) const { return signs_[static_cast<std::size_t>(tet)]; }

    // How many edges lead to each tet. Callers that order the tets may count these numbers down.
    std::span<std::int32_t> farther_counts() { return farther_counts_; }
    std::span<const std::int32_t> farther_counts() const { return farther_counts_; }

    // The edges from a tet. Edges 0 to 3 cross its faces; higher numbers cross gaps.
    static constexpr std::int32_t no_edge = -1;
    std::int32_t first_edge(std::int32_t tet) const { return edge_from(tet, 0); }
    std::int32_t next_edge(std::int32_t tet, std::int32_t edge) const {
        if (edge < faces) return edge_from(tet, edge + 1);
        return shifted(next_gap_[static_cast<std::size_t>(edge - faces)]);
    }
    std::int32_t first_gap_edge(std::int32_t tet) const {
        return first_gap_.empty() ? no_edge : shifted(first_gap_[static_cast<std::size_t>(tet)]);
    }
    std::int32_t nearer(std::int32_t tet,
                        std::int32_t edge) const {  // the tet that the edge leads to
        if (edge < faces)
            return mesh_.neighbors()[static_cast<std::size_t>(tet)][static_cast<std::size_t>(edge)];
        const OpenFaceConstraint& gap = gap_edges_[static_cast<std::size_t>(edge - faces)];
        return mesh_.open_faces()[static_cast<std::size_t>(gap.exit)].tet;
    }
    // The seen area (seen_area.h) of the face, or of the overlap of the two open faces.
    double area(std::int32_t tet, std::int32_t edge) const;
    // The triangles that a ray along the edge passes: the exit of the nearer tet and the entry of
    // the farther one, which are one and the same for a shared face.
    struct Passage {
        Triangle exit, entry;
        bool shared;
    };
    Passage passage(std::int32_t tet, std::int32_t edge) const;

  private:
    static constexpr std::int32_t faces = 4;
    static std::int32_t shifted(std::int32_t gap) { return gap < 0 ? no_edge : gap + faces; }
    std::int32_t edge_from(std::int32_t tet, std::int32_t face) const {
        const FaceSigns bits = signs(tet);
        for (; face < faces; ++face) {
            if (bits & nearer_bit(static_cast<std::size_t>(face))) return face;
        }
        return first_gap_edge(tet);
    }
    void find_signs();
    void link_gaps();

    const TetMesh& mesh_;
    Eye eye_;
    std::vector<std::uint8_t> signs_;
    std::vector<std::int32_t> farther_counts_;
    std::unique_ptr<OpenFaceConstraints> gaps_;  // null for shared faces only
    std::span<const OpenFaceConstraint> gap_edges_;
    std::vector<std::int32_t> first_gap_;  // first gap edge of each tet, or -1; empty without gaps
    std::vector<std::int32_t> next_gap_;   // next gap edge of the same tet, or -1
};

}  // namespace lamina
