// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/tet_mesh.h"

namespace lamina {

struct EdgeLengths {
    double shortest = 0, longest = 0;
    // Longest divided by shortest edge; infinite if the ends of an edge coincide.
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

// Tells whether the mesh fills a convex body, each place once: its boundary is one closed surface
// that is convex near each of its points (Tietze 1928, Nakajima 1928), and no face is folded or
// nonmanifold. Dents as deep as the rounding of doubles (1e-16) are within_rounding; those of float
// coordinates (1e-8) are not. Parallel; the time grows with the number of open faces.
Convexity convexity(const TetMesh& mesh);

inline bool convex(const TetMesh& mesh) {
    return convexity(mesh) != Convexity::none;
}

}  // namespace lamina
