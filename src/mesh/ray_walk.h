// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/mesh.h"
#include "mesh/face_tree.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// A line origin + t * direction for all real t, its numbers taken as exact, and two axes across it.
struct LineFrame {
    glm::dvec3 origin{0}, direction{0};
    glm::dvec3 across_x{0}, across_y{0};  // unit vectors; with the direction, right-handed axes
    double direction_square = 1;
};

// A face through which a line enters a tet, as seen along the line.
struct RayFront {
    // A corner: its place (x, y) relative to the line, and the line's parameter next to it.
    struct Corner {
        std::int32_t point;
        double x, y, at;
        double reach;  // bounds the rounding of x and y
    };
    std::array<Corner, 3> corners;  // counter-clockwise
    // Twice the areas of the triangles of the line's place (0, 0) and edges 01, 12, 20; >= 0.
    std::array<double, 3> areas;
};

// Returns the corner of a tet that is not one of three given corners.
inline std::int32_t corner_opposite(const Tet& tet, std::int32_t a, std::int32_t b,
                                    std::int32_t c) {
    return tet[0] ^ tet[1] ^ tet[2] ^ tet[3] ^ a ^ b ^ c;  // the others cancel
}

struct FaceCrossing {
    std::array<std::int32_t, 3> corners;  // counter-clockwise seen along the line
    std::array<double, 3> weights;  // barycentric weights of the corners, >= 0; their sum is 1
    double at = 0;                  // parameter of the line

    // Interpolates `values`, one for each point of the mesh. Constant values stay exactly the same.
    double interpolate(std::span<const double> values) const {
        const double first = values[corners[0]];
        return first + (weights[1] * (values[corners[1]] - first) +
                        weights[2] * (values[corners[2]] - first));
    }
};

struct TetSegment {
    std::int32_t tet;
    FaceCrossing in, out;  // in.at <= out.at
};

// Walks along a line from tet to tet. Decides exactly on which side it passes each edge, so no line
// leaks between tets; one that meets an edge or a point is displaced by an infinitesimal amount
// (simulation of simplicity, Edelsbrunner and Muecke 1990). Each thread needs its own object.
class RayWalk {
  public:
    RayWalk(const TetMesh& mesh, const FaceTree& open_faces) : mesh_(mesh), tree_(open_faces) {}

    // Bounds the error of Corner's x and y, as a share of its distance from the origin (1-norm):
    // half an ulp for each difference, three products and two sums, and axes across to 4 ulps.
    static constexpr double place_error = 8 * std::numeric_limits<double>::epsilon();

    // Sets the line and finds all places at which it enters and leaves the mesh.
    void aim(const glm::dvec3& origin, const glm::dvec3& direction);
    // Tests only `faces`: indices of open faces, among them all that the line meets.
    void aim(const glm::dvec3& origin, const glm::dvec3& direction,
             std::span<const std::int32_t> faces);
    const LineFrame& line() const { return line_; }

    // An open face by which the line enters the mesh, and the line's parameter at which it does.
    struct Entry {
        TetFace face;
        double at;
    };
    std::span<const Entry> entries() const { return entries_; }  // ascending
    // Tells whether the mesh overlaps itself on the line: it enters again before it has left.
    bool overlapping() const { return overlapping_; }

    // Calls visit(TetSegment) for each tet from an entry to the next exit, until it returns false.
    template <typename Visit>
    void follow(const Entry& entry, const Visit& visit) const {
        RayFront front = front_of(entry.face);
        TetSegment segment{entry.face.tet, crossing(front), {}};
        // Each tet is passed at most once. The limit ends walks in meshes that are not valid.
        for (std::size_t steps = 0; steps < mesh_.tets().size(); ++steps) {
            const std::int32_t next = step(segment, front);
            if (!visit(segment) || next == TetMesh::no_neighbor) return;
            segment.tet = next;
            segment.in = segment.out;
            if (!mesh_.has_copies()) continue;
            for (std::size_t i = 0; i < 3; ++i) segment.in.corners[i] = front.corners[i].point;
        }
    }

    RayFront front_of(const TetFace& face) const;
    static FaceCrossing crossing(const RayFront& front);
    // Sets segment.out, where the line leaves segment.tet, and makes `front` that face, seen from
    // the tet behind, with that tet's corners. Returns the tet behind, or no_neighbor.
    std::int32_t step(TetSegment& segment, RayFront& front) const;

    // Lists the segments from all entries, by ascending parameter at which the line enters the tet.
    void list(std::vector<TetSegment>& segments) const;

  private:
    using Corner = RayFront::Corner;
    // The side of the line on which the edge from corner a to corner b passes.
    struct Side {
        double area;  // twice the triangle's area, with `sign`; 0 if rounding gave the other sign
        int sign;     // exact, never 0
    };

    Corner see(std::int32_t point) const;
    Side side(const Corner& a, const Corner& b) const;
    int exact_side(const glm::dvec3& p, const glm::dvec3& q) const;
    std::array<Corner, 3> see_face(const TetFace& face) const;
    std::array<Side, 3> sides_of(const std::array<Corner, 3>& corners) const;
    static bool passes(const std::array<Corner, 3>& corners);
    bool meets(const FaceTree::Box& box) const;
    void set_line(const glm::dvec3& origin, const glm::dvec3& direction);
    void test_face(std::int32_t index);  // an open face
    void sort_crossings();

    const TetMesh& mesh_;
    const FaceTree& tree_;
    LineFrame line_;
    // How far a unit along each axis extends across the line: |across_x| and |across_y|.
    glm::dvec3 extent_x_{0}, extent_y_{0};
    double origin_norm_ = 0;
    std::vector<Entry> entries_;
    std::vector<double> exits_;
    bool overlapping_ = false;
};

}  // namespace lamina
