// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "facts/drawn_range.h"
#include "mesh/mesh_shape.h"
#include "mesh/tet_mesh.h"
#include "mesh/tet_overlaps.h"
#include "scene/clip.h"
#include "scene/scene.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Tets that share space with others (mesh/tet_overlaps.h).
struct MeshOverlap {
    std::int64_t tets = 0;  // number of tets that overlap others; 0 if too many pairs may
    bool complete = true;   // TetOverlaps::complete
    // TetOverlaps::pairs; null if there are too many, a clip cuts the mesh, or no tets overlap.
    // Shared by plans of one mesh.
    std::shared_ptr<const std::vector<TetPair>> pairs;
    // Sum of the pixels of a view that each tet of the pairs may cover: grows with the time that
    // their order takes.
    std::int64_t covered_pixels = 0;

    // Tells whether surely no tets overlap.
    bool none() const { return tets == 0 && complete; }
};

// Properties of a mesh and its view. They are measured, not taken from files.
struct MeshFacts {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::string scalar;  // name of the scalar
    ValueRange range;    // range of the finite values
    std::int64_t non_finite = 0;
    MeshFindings findings;
    // True: the clip leaves nothing, and all other members describe the mesh before it was cut.
    bool clipped_away = false;

    double shortest_edge = 0, longest_edge = 0;  // world units
    double diagonal = 0;                         // diagonal of the bounding box, world units
    Convexity convexity = Convexity::none;
    MeshOverlap overlap;

    // The following describe the transfer function over `range`.
    bool constant = false;  // one colour, one extinction
    // One colour where extinction > 0; everywhere if the colouring mixes_colors() (scene/scene.h).
    bool single_color = false;
    double max_extinction = 0;          // per world unit
    double max_color = 0;               // largest component of a colour
    std::int64_t transparent_tets = 0;  // these show nothing or have a value that is not finite
    // mesh_window(), and the number of visible tets whose scalars reach beyond it by more than
    // far_for_parts times its width (runs_beyond() in facts/drawn_range.h).
    ValueRange window;
    std::int64_t far_tets = 0;
    // tets_with_surfaces() (facts/surface_rays.h); null if there are none.
    std::shared_ptr<const std::vector<std::int32_t>> surface_tets;
    // Number of visible cell fragments, if all tets are cut at the function's points.
    std::int64_t parts = 0;

    // The following describe the view.
    bool orthographic = false;
    bool in_front = true;      // some point lies in front of the eye's plane
    bool box_in_front = true;  // all of the mesh's box does
    double surface_error = 0;  // surface_ray_error() (facts/surface_rays.h)

    // A segment of a ray inside one tet.
    struct Segment {
        double front, back;  // scalars at the near and the far end
        double length;       // world units
        double edge = 0;     // longest edge of the tet, world units
    };
    // Rays on which methods to integrate segments are tried: rays all over the picture, as segments
    // front to back, and edges of single visible tets. Empty if nothing is integrated.
    std::vector<std::vector<Segment>> trial_rays;
    // Pixels of the picture for each of trial_rays that goes through one. It is 1 if all pixels are
    // tried, as of small pictures whose scene asks for a pre-integration table.
    double pixels_a_trial_ray = 1;
    // Errors found on trial rays, in 1/255.
    struct TrialError {
        double segments = 0;  // error of the method that integrates segments
        double places = 0;    // additional error of faces that are drawn slightly displaced
        std::int64_t rays = 0;

        friend bool operator==(const TrialError&, const TrialError&) = default;
    };
    TrialError last_error;  // found on the rays of an earlier view; counts if this view has none
};

// Tells whether an order is right on every ray. The others err; they exist to be studied.
inline bool is_right_order(const Auto<ProjectOrder>& order) {
    return order.is_automatic() || order == ProjectOrder::exact;
}

// Largest MeshOverlap::covered_pixels that an automatic order solves. More would hold up a viewer
// for seconds a frame.
inline constexpr std::int64_t most_covered_pixels = 15'000'000;

// Tells whether an automatic order would take too long to solve the rings of overlapping tets.
// Without their pairs, most pixels of rings have no right order and are divided one by one.
inline bool orders_slowly(const Auto<ProjectOrder>& order, const MeshOverlap& overlap) {
    return order.is_automatic() && !overlap.none() &&
           (!overlap.pairs || overlap.covered_pixels > most_covered_pixels);
}

// Tells whether pictures show all overlapping tets, if any, as the tracer defines them (EntryRule).
inline bool orders_overlaps(const Auto<ProjectOrder>& order, const MeshOverlap& overlap) {
    return overlap.none() || (overlap.pairs && !orders_slowly(order, overlap));
}

// Measures all facts. Throws Error as check_finite() does.
MeshFacts measure(const Scene& scene, const SceneMesh& mesh);

// Parts of measure(): mesh and transfer function, the view without rays, and trial_rays.
MeshFacts measure_data(const Scene& scene, const SceneMesh& mesh);
// Returns MeshFacts::overlap without pixels, which takes longer and depends on the mesh alone.
// `clipped`: a clip cuts the mesh, so its pairs are not kept: tets that it cuts are several, which
// rays enter at places of their own.
MeshOverlap measure_overlap(const SceneMesh& mesh, Convexity convexity, bool clipped);
void measure_view(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts);
void measure_rays(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts);

// Throws Error if no value is finite, or if some are not while the scene's `nan` is "error".
void check_finite(const Scene& scene, const SceneMesh& mesh, const ScalarRange& found);

// Returns rays of the scene's view, all over the picture, as segments in tets, nearest first. Rays
// that meet no tet are left out, and so are tets with values that are not finite.
std::vector<std::vector<MeshFacts::Segment>> find_view_rays(const Scene& scene,
                                                            const SceneMesh& mesh);

}  // namespace lamina
