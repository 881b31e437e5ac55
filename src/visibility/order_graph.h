// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include "lamina/tet.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "visibility/open_face_constraints.h"

namespace lamina {

// Number of tets that one task looks at.
inline constexpr std::int64_t tets_per_task = 4096;

// The sides of a tet's faces on which the eye is. Bit f: the eye is on the outer side of face f, so
// the tet across that face is nearer to the eye. Bit 4 + f: the eye is on the inner side, so the
// tet across is farther. A face that is seen edge-on has neither bit and hides nothing.
using FaceSigns = std::uint32_t;
constexpr FaceSigns nearer_bit(std::size_t face) {
    return FaceSigns{1} << face;
}
constexpr FaceSigns farther_bit(std::size_t face) {
    return FaceSigns{16} << face;
}

// Tells whether sorting the corners of a face by their numbers reverses its orientation: so it is
// for one of the two tets that share the face.
inline bool turned_by_sorting(const Tet& tet, std::size_t face) {
    const auto [a, b, c] = corners_of_face(tet, face);
    return (a > b) != ((b > c) != (a > c));
}

// Tells whether the eye is in front of a face. If the face is seen edge-on, the eye counts as in
// front for one of its two tets.
inline bool is_front(const Tet& tet, std::size_t face, FaceSigns signs) {
    const bool nearer = (signs & nearer_bit(face)) != 0, farther = (signs & farther_bit(face)) != 0;
    return nearer || (!farther && turned_by_sorting(tet, face));
}

// Returns the exact sign of the solid angle (for an eye at infinity, of the projected area) of the
// triangle a, b, c. It is positive if the eye sees the corners clockwise: for a face whose corners
// are counter-clockwise from outside its tet, if the eye is on the inner side.
inline int sign_as_seen(const Eye& eye, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c) {
    const glm::dvec3& e = eye.position;
    if (eye.at_infinity) return sign_of_determinant(e, glm::dvec3(0), b, a, c, a);
    return sign_of_determinant(a, e, b, e, c, e);
}

// Finds the signs of a mesh's tets for one eye, in floating point if an error bound decides them,
// else exactly, so that the two tets of a face always agree. Safe from many threads.
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
    int exact(const Tet& tet, std::size_t face) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    Eye eye_;
};

// The graph of which tets hide which, for one eye after the other. An edge leads from each tet to
// every tet that is nearer and must therefore be drawn after it: across shared faces and, if
// wanted, across the gaps between open faces. The mesh must outlive this object.
class OrderGraph {
  public:
    OrderGraph(const TetMesh& mesh, bool across_gaps);

    void look_from(const Eye& eye);  // parallel

    const TetMesh& mesh() const { return mesh_; }
    const Eye& eye() const { return eye_; }

    // Returns the signs of shared faces; no bit of an open face is set.
    FaceSigns signs(std::int32_t tet) const { return signs_[static_cast<std::size_t>(tet)]; }

    // Returns how many edges lead to each tet. Callers that order the tets may count these numbers
    // down.
    std::span<std::int32_t> farther_counts() { return farther_counts_; }
    std::span<const std::int32_t> farther_counts() const { return farther_counts_; }

    // Numbers of the edges from a tet: edges 0 to 3 cross its faces; higher numbers cross gaps.
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
    // Returns the seen area (seen_area() in visibility/seen_shapes.h) of the face, or of the
    // overlap of the two open faces.
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

// Returns a number that grows with the distance of a point from the eye, for comparisons: the
// squared distance, or for an eye at infinity the distance along the view.
inline double view_distance(const Eye& eye, const glm::dvec3& point) {
    if (eye.at_infinity) return glm::dot(eye.position, point);
    const glm::dvec3 ray = point - eye.position;
    return glm::dot(ray, ray);
}

// MPVO for nonconvex meshes (Williams, Visibility ordering meshed polyhedra, 1992; Kraus et al.
// 2004 draw with it): a depth-first search that draws a tet when all tets behind it across shared
// faces are drawn. It starts at the tets with open faces towards the eye, in descending order of
// the distance of the face's centroid, which is a guess at the order across gaps. It takes its
// memory once.
class FarthestFirst {
  public:
    explicit FarthestFirst(const TetMesh& mesh);

    // Fills `order`, one place a tet, back to front. Returns how many edges of the graph it breaks,
    // because there is no order without cycles.
    std::int64_t sort(const OrderGraph& graph, std::span<std::int32_t> order);

  private:
    struct Start {
        double distance;
        std::int32_t tet;
        bool operator<(const Start& other) const {  // farthest first
            return distance != other.distance ? distance > other.distance : tet < other.tet;
        }
    };
    void find_starts(const Eye& eye);
    void draw(const OrderGraph& graph, std::int32_t root, std::span<std::int32_t> order);

    const TetMesh& mesh_;
    std::vector<Start> starts_;
    // Next face of each tet to look across (see order_graph.cpp).
    std::vector<std::uint8_t> next_face_;
    std::size_t drawn_ = 0;
    std::int64_t broken_ = 0;
};

}  // namespace lamina
