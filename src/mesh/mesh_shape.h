// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "mesh/tet_mesh.h"

namespace lamina {

struct EdgeLengths {
    double shortest = 0, longest = 0;
    // Returns longest edge over shortest edge; infinite if the ends of an edge coincide.
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
// allows for dents that come from rounded coordinates alone (a rotated box, for example). Its
// tolerance of 1e-12 of the diagonal is far above the rounding of doubles (1e-16), and far below
// that of floats (1e-8): dents of files with float coordinates are in the data, and count.
Convexity convexity(const TetMesh& mesh);

inline bool convex(const TetMesh& mesh) {
    return convexity(mesh) != Convexity::none;
}

// Counts the tets at whose open faces the mesh overlaps itself: faces that other open faces cross,
// folded faces and nonmanifold ones, and parts that lie inside others. Their tets share space, so
// no order of them is right. Touching is no overlap. The count is exact for faces that cross,
// unless that would take too long, as it does among thousands of needles whose boxes all overlap:
// then some may be missed. Parts inside others count one tet each; if there are more than 500
// parts, only 500 are tested. Parallel.
std::int64_t count_overlapping_tets(const TetMesh& mesh);

}  // namespace lamina
