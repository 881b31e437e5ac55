// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "mesh/tet_mesh.h"

namespace lamina {

struct EdgeLengths {
    double shortest = 0, longest = 0;
    // Returns longest edge over shortest edge; infinite if two points coincide.
    double ratio() const {
        return shortest > 0 ? longest / shortest : std::numeric_limits<double>::infinity();
    }
};
EdgeLengths edge_lengths(const TetMesh& mesh);  // parallel

enum class Convexity {
    none,
    within_rounding,  // no boundary edge is concave by more than 1e-12 of the mesh's diagonal
    exact             // no boundary edge is concave at all
};

// Tells whether the mesh fills a convex body: if its boundary is one closed surface without a
// concave edge (Tietze 1928, Nakajima 1928) and no face is folded or nonmanifold. within_rounding
// allows for computed coordinates (a rotated box, for example), which have errors of some 1e-16 of
// the diagonal; so have the depths of dents between faces of ordinary shape. Files with float
// coordinates have errors of 1e-8, and their dents are real.
Convexity convexity(const TetMesh& mesh);

inline bool convex(const TetMesh& mesh) {
    return convexity(mesh) != Convexity::none;
}

// Counts the tets at whose open faces the mesh overlaps itself: faces that other open faces cross,
// folded faces and nonmanifold ones, and parts that lie inside others. Their tets share space, so
// no order of them is right. Touching is no overlap. The count is exact for faces that cross,
// unless that would take too long, as it does among thousands of needles whose boxes all overlap:
// then some may be missed. Parts inside others count one tet each; if there are more than 500
// parts, some of them are looked at. Parallel.
std::int64_t count_overlapping_tets(const TetMesh& mesh);

}  // namespace lamina
