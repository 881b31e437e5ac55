// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "visibility/open_face_constraints.h"
#include "visibility/overlap_constraints.h"

namespace lamina {

inline constexpr std::int64_t tets_per_task = 4096;

// On which side of a tet's faces the eye is. Bit f: outside of face f, so the tet across is nearer;
// bit 4 + f: inside, so it is farther. Faces seen edge-on have neither bit.
using FaceSigns = std::uint32_t;
constexpr FaceSigns nearer_bit(std::size_t face) {
    return FaceSigns{1} << face;
}
constexpr FaceSigns farther_bit(std::size_t face) {
    return FaceSigns{16} << face;
}

// Tells whether sorting a face's corners reverses its orientation: true for one of its two tets.
// `tet`: the places of its corners (TetMesh::place()), as for is_front().
inline bool turned_by_sorting(const Tet& tet, std::size_t face) {
    const auto [a, b, c] = corners_of_face(tet, face);
    return (a > b) != ((b > c) != (a > c));
}

// Tells whether the eye is in front of a tet's face. Edge-on faces are front faces of one tet only.
inline bool is_front(const Tet& tet, std::size_t face, FaceSigns signs) {
    const bool nearer = (signs & nearer_bit(face)) != 0, farther = (signs & farther_bit(face)) != 0;
    return nearer || (!farther && turned_by_sorting(tet, face));
}

// Returns the exact sign of the seen area: positive if the eye sees a, b, c clockwise.
inline int sign_as_seen(const Eye& eye, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c) {
    const glm::dvec3& e = eye.position;
    if (eye.at_infinity) return sign_of_determinant(e, glm::dvec3(0), b, a, c, a);
    return sign_of_determinant(a, e, b, e, c, e);
}

// Computes the exact FaceSigns of tets, so the two tets of a face always agree. Thread-safe.
class FaceSigner {
  public:
    FaceSigner(const TetMesh& mesh, const Eye& eye)
        : points_(mesh.points()), tets_(mesh.tets()), eye_(eye) {}

    FaceSigns signs(std::size_t tet) const;

  private:
    struct Rounded {
        std::array<double, 4> determinants;
        double error;
    };
    Rounded rounded(const Tet& tet) const;
    Rounded rounded_at_infinity(const Tet& tet) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    Eye eye_;
};

// The graph of which tets hide which. An edge leads from a tet to a nearer one, to be drawn after
// it: across a shared face or, if `across_gaps`, across a gap. The mesh must outlive this object.
class OrderGraph {
  public:
    // `overlaps`: pairs of tets that overlap, which also get edges if there are gaps' edges
    // (OverlapConstraints). Without them nothing is ordered by such pairs.
    OrderGraph(const TetMesh& mesh, bool across_gaps, std::span<const TetPair> overlaps = {});

    void look_from(const Eye& eye);  // parallel

    const TetMesh& mesh() const { return mesh_; }
    const Eye& eye() const { return eye_; }
    bool orders_overlaps() const { return overlaps_ != nullptr; }

    // Returns the signs of shared faces; no bit of an open face is set.
    FaceSigns signs(std::int32_t tet) const { return signs_[tet]; }

    // Returns for each tet the number of edges that lead to it. Callers may count these down.
    std::span<std::int32_t> farther_counts() { return farther_counts_; }
    std::span<const std::int32_t> farther_counts() const { return farther_counts_; }

    // The number of a tet's edge: 0 to 3 across its face of that number; higher ones across gaps.
    static constexpr std::int32_t no_edge = -1;
    std::int32_t first_edge(std::int32_t tet) const { return edge_from(tet, 0); }
    std::int32_t next_edge(std::int32_t tet, std::int32_t edge) const {
        if (edge < faces) return edge_from(tet, edge + 1);
        return shifted(next_gap_[edge - faces]);
    }
    std::int32_t first_gap_edge(std::int32_t tet) const {
        return first_gap_.empty() ? no_edge : shifted(first_gap_[tet]);
    }
    std::int32_t nearer(std::int32_t tet, std::int32_t edge) const {
        if (edge < faces) return mesh_.neighbors()[tet][edge];
        const OpenFaceConstraint& gap = gap_edges_[edge - faces];
        return faces_of_gaps_[gap.exit].tet;
    }
    // Returns the seen area of the shared face, or of the overlap of the gap's two open faces.
    double area(std::int32_t tet, std::int32_t edge) const;
    // The exit of the nearer tet and the entry of the farther one. A shared face is both. If tets
    // overlap, the faces may cross, and the exit, which may be the nearer tet's front face, hides
    // only what is `behind` it.
    struct Passage {
        Triangle exit, entry;
        bool shared, behind;
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

    const TetMesh& mesh_;
    Eye eye_;
    std::vector<std::uint8_t> signs_;
    std::vector<std::int32_t> farther_counts_;
    std::unique_ptr<OpenFaceConstraints> gaps_;     // null for shared faces only
    std::unique_ptr<OverlapConstraints> overlaps_;  // null if no overlapping tets are ordered
    std::span<const TetFace> faces_of_gaps_;        // faces that gap_edges_ are indices of
    std::span<const OpenFaceConstraint> gap_edges_;
    std::vector<OpenFaceConstraint> all_edges_;  // memory of gap_edges_ if tets overlap
    std::vector<std::int32_t> first_gap_;  // first gap edge of each tet, or -1; empty without gaps
    std::vector<std::int32_t> next_gap_;   // next gap edge of the same tet, or -1
};

// Returns a number that grows with distance: its square or, at infinity, the place along the view.
inline double view_distance(const Eye& eye, const glm::dvec3& point) {
    if (eye.at_infinity) return glm::dot(eye.position, point);
    const glm::dvec3 ray = point - eye.position;
    return glm::dot(ray, ray);
}

// MPVO for nonconvex meshes (Williams, Visibility ordering meshed polyhedra, 1992; Kraus et al.
// 2004): draws a tet when all behind it across shared faces are drawn. Starts at open faces that
// look towards the eye, the farthest centroid first, which is a guess at the order across gaps.
class FarthestFirst {
  public:
    explicit FarthestFirst(const TetMesh& mesh);

    // Fills `order`, back to front. Returns how many edges it breaks, because there are cycles.
    std::int64_t sort(const OrderGraph& graph, std::span<std::int32_t> order);

  private:
    struct Start {
        double distance;
        std::int32_t tet;
        bool operator<(const Start& other) const {  // farthest first
            return distance != other.distance ? distance > other.distance : tet < other.tet;
        }
    };
    void draw(const OrderGraph& graph, std::int32_t root, std::span<std::int32_t> order);

    const TetMesh& mesh_;
    std::vector<Start> starts_;
    // The state of each tet in the search (states: order_graph.cpp).
    std::vector<std::uint8_t> next_face_;
    std::size_t drawn_ = 0;
    std::int64_t broken_ = 0;
};

}  // namespace lamina
