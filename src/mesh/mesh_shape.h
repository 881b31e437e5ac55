// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "mesh/tet_mesh.h"

namespace lamina {

struct EdgeLengths {
    double shortest = 0, longest = 0;
    // Infinite where two ends coincide.
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

// Does the mesh fill a convex body? Its boundary must be one closed surface without a concave edge,
// which is then the surface of a convex body (Tietze 1928, Nakajima 1928), and no face may be
// folded or nonmanifold. The tolerance: coordinates that were computed (a turned box, say) are off
// by some 1e-16 of the diagonal, and so are the depths of dents between faces of ordinary shape;
// files with float coordinates are off by 1e-8, and such dents are real.
Convexity convexity(const TetMesh& mesh);

inline bool convex(const TetMesh& mesh) {
    return convexity(mesh) != Convexity::none;
}

}  // namespace lamina
