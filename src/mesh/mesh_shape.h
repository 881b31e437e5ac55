// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "mesh/tet_mesh.h"

namespace lamina {

struct EdgeLengths {
    double shortest = 0, longest = 0;
    // Longest edge over shortest edge; infinite where two points coincide.
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

// Whether the mesh fills a convex body. This is so where its boundary is one closed surface without
// a concave edge (Tietze 1928, Nakajima 1928) and no face is folded or nonmanifold. within_rounding
// allows for computed coordinates (a rotated box, for example). These have errors of some 1e-16 of
// the diagonal, and so have the depths of dents between faces of ordinary shape. Files with float
// coordinates have errors of 1e-8, and their dents are real.
Convexity convexity(const TetMesh& mesh);

inline bool convex(const TetMesh& mesh) {
    return convexity(mesh) != Convexity::none;
}

}  // namespace lamina
