// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh_shape.h"
#include "scene/scene_mesh.h"
#include "facts/tet_pieces.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// What a mesh really contains: measured, not declared.
struct MeshFacts {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::string scalar;  // its name
    ValueRange range;    // of the finite values
    std::int64_t non_finite = 0;
    MeshFindings findings;

    double shortest_edge = 0, longest_edge = 0;  // world units
    double diagonal = 0;                         // of the bounds
    Convexity convexity = Convexity::none;

    // The transfer function over `range`.
    bool constant = false;              // one colour, one extinction
    bool single_color = false;          // one colour wherever there is extinction; where colours
                                        // are interpolated, everywhere
    double max_extinction = 0;          // per world unit
    std::int64_t transparent_tets = 0;  // that show nothing; with them those with a value that is
                                        // no finite number
    std::int64_t parts = 0;  // of the others, cut at the transfer function's points: what shows
                             // something

    // The view.
    bool orthographic = false;
    bool in_front = true;  // some point lies in front of the eye's plane

    // Rays through pixels all over the picture, as runs through tets, nearest first, and single
    // tets that show something: what ways to integrate segments are tried on. None where the
    // scene leaves no choice.
    struct Run {
        double front, back;  // scalars
        double length;       // world units
    };
    std::vector<std::vector<Run>> trial_rays;
};

// MeshFacts::trial_rays: rays of the view, and tets of the mesh one by one.
std::vector<std::vector<MeshFacts::Run>> find_trial_rays(const Scene& scene, const SceneMesh& mesh,
                                                         const TetPieces& pieces);

// Throws Error when the scalar has values that are no finite numbers and the scene does not say
// what to do with them, or has none but such.
MeshFacts measure(const Scene& scene, const SceneMesh& mesh);

// The same in parts: what the mesh and the transfer function say; what the view says, but for rays;
// trial_rays.
MeshFacts measure_data(const Scene& scene, const SceneMesh& mesh);
void measure_view(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts);
void measure_rays(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts);

}  // namespace lamina
