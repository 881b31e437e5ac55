// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "facts/drawn_range.h"
#include "mesh/mesh_shape.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Properties of a mesh and its view. They are measured, not taken from files.
struct MeshFacts {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::string scalar;  // name of the scalar
    ValueRange range;    // range of the finite values
    std::int64_t non_finite = 0;
    MeshFindings findings;
    // True: the clip leaves nothing of the mesh, and all else describes the mesh before it was cut.
    bool clipped_away = false;

    double shortest_edge = 0, longest_edge = 0;  // world units
    double diagonal = 0;                         // diagonal of the bounding box, world units
    Convexity convexity = Convexity::none;
    std::int64_t overlapping_tets = 0;  // tets that share space with others (mesh/mesh_shape.h)

    // The following describe the transfer function over `range`.
    bool constant = false;  // one colour, one extinction
    // One colour wherever extinction is > 0 or, if vertices interpolate colours, everywhere.
    bool single_color = false;
    double max_extinction = 0;  // per world unit
    double max_color = 0;       // largest component of a colour
    // number of tets that show nothing, including those with a value that is not finite
    std::int64_t transparent_tets = 0;
    // The window of whole tets, and the number of visible ones far outside (facts/drawn_range.h).
    ValueRange window;
    std::int64_t far_tets = 0;
    // Number of visible cell fragments if the other tets are cut at the transfer function's points.
    std::int64_t parts = 0;

    // The following describe the view.
    bool orthographic = false;
    bool in_front = true;  // some point lies in front of the eye's plane

    // Rays on which methods to integrate segments are tried: all over the picture, as segments in
    // tets, nearest first; and single visible tets. Empty if the scene leaves no choice.
    struct Run {
        double front, back;  // scalars
        double length;       // world units
        double edge = 0;     // longest edge of the tet, world units
    };
    std::vector<std::vector<Run>> trial_rays;
    // Errors found on trial rays, in 1/255.
    struct TrialError {
        double segments = 0;  // of integrating segments
        double places = 0;    // additional ones, of faces that are not quite in their places
        std::int64_t rays = 0;

        friend bool operator==(const TrialError&, const TrialError&) = default;
    };
    TrialError last_error;  // as found on the rays of an earlier view, if this one has none
};

// Tells whether an order is right on every ray; others exist to be studied, mistakes and all.
inline bool is_right_order(const Auto<ProjectOrder>& order) {
    return order.is_automatic() || order == ProjectOrder::exact;
}

// Measures all facts. Throws Error as check_finite() does.
MeshFacts measure(const Scene& scene, const SceneMesh& mesh);

// These measure in steps: mesh and transfer function; view without rays; trial_rays.
MeshFacts measure_data(const Scene& scene, const SceneMesh& mesh);
// Returns MeshFacts::overlapping_tets, which takes longer and depends on the mesh alone.
std::int64_t measure_overlap(const SceneMesh& mesh, Convexity convexity);
void measure_view(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts);
void measure_rays(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts);

// Throws Error if no value of `found` is finite, or if some are not and `nan` is "error".
void check_finite(const Scene& scene, const SceneMesh& mesh, const ScalarRange& found);

// Returns rays of the scene's view, all over the picture, as segments in tets, nearest first. Rays
// that meet no tet are left out, and so are tets with values that are not finite.
std::vector<std::vector<MeshFacts::Run>> find_view_rays(const Scene& scene, const SceneMesh& mesh);

}  // namespace lamina
