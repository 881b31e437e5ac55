// SPDX-License-Identifier: Apache-2.0
// Which tets a line passes, and where: from open face to open face through the neighbours, with
// exact decisions about every face, so that no line leaks between two tets, through an edge or
// through a point.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/face_tree.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// Where a line crosses a face.
struct FaceCrossing {
    std::array<std::int32_t, 3> corners;  // counter-clockwise seen along the line
    std::array<double, 3> weights;        // of the corners, >= 0, adding up to 1
    double at = 0;                        // parameter on the line

    // Linear interpolation of one value a point; constant values stay exactly what they are.
    double interpolate(std::span<const double> values) const {
        const double first = values[static_cast<std::size_t>(corners[0])];
        return first + (weights[1] * (values[static_cast<std::size_t>(corners[1])] - first) +
                        weights[2] * (values[static_cast<std::size_t>(corners[2])] - first));
    }
};

// The part of a line inside one tet.
struct TetSegment {
    std::int32_t tet;
    FaceCrossing in, out;  // in.at <= out.at
};

// A line, origin + t * direction for all real t, taken as exact; where it meets an edge or a point,
// it is moved aside by an infinitesimal amount, the same for all tets (simulation of simplicity,
// Edelsbrunner and Muecke 1990). One object a thread: it keeps its memory from line to line.
class RayWalk {
  public:
    RayWalk(const TetMesh& mesh, const FaceTree& open_faces) : mesh_(mesh), tree_(open_faces) {}

    // Finds where the line enters and leaves the mesh.
    void aim(const glm::dvec3& origin, const glm::dvec3& direction);

    struct Entry {
        TetFace face;
        double at;
    };
    std::span<const Entry> entries() const { return entries_; }  // ascending
    // Parts of the mesh overlap along this line: it enters again before it has left.
    bool overlapping() const { return overlapping_; }

    // Calls visit(TetSegment) from the entry on until the line leaves; stops when visit returns
    // false.
    template <typename Visit>
    void follow(const Entry& entry, const Visit& visit) const {
        Front front = front_of(entry.face);
        TetSegment segment{entry.face.tet, crossing(front), {}};
        // Each tet is passed at most once: the limit ends walks in what is no proper mesh.
        for (std::size_t steps = 0; steps < mesh_.tets().size(); ++steps) {
            const std::int32_t next = step(segment, front);
            if (!visit(segment) || next == TetMesh::no_neighbor) return;
            segment.tet = next;
            segment.in = segment.out;
        }
    }

    // All segments of all entries in ascending order of their entry.
    void list(std::vector<TetSegment>& segments) const;

  private:
    // A point seen along the line: its place in the plane across, and its parameter.
    struct Seen {
        std::int32_t point;
        double x, y, at;
        double reach;  // bounds the rounding of x and y
    };
    // On which side of the line the edge from a to b passes, and twice the area of line, a, b.
    struct Side {
        double area;  // of the sign below, or 0 where rounding gave the other one
        int sign;     // exact, never 0
        Side turned() const { return {-area, -sign}; }
    };
    // A face that the line comes in through: sides of the edges 01, 12, 20, all positive.
    struct Front {
        std::array<Seen, 3> corners;
        std::array<Side, 3> sides;
    };

    Seen see(std::int32_t point) const;
    Side side(const Seen& a, const Seen& b) const;
    int exact_side(const glm::dvec3& p, const glm::dvec3& q) const;
    Front front_of(const TetFace& face) const;
    static FaceCrossing crossing(const Front& front);
    bool meets(const FaceTree::Box& box) const;
    void find_crossings();
    std::int32_t step(TetSegment& segment, Front& front) const;

    const TetMesh& mesh_;
    const FaceTree& tree_;
    glm::dvec3 origin_{0}, direction_{0};
    glm::dvec3 across_x_{0}, across_y_{0};  // unit vectors; x, y, direction are right-handed
    double direction_square_ = 1;
    std::vector<Entry> entries_;
    std::vector<double> exits_;
    bool overlapping_ = false;
};

}  // namespace lamina
