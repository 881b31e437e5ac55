// SPDX-License-Identifier: Apache-2.0
// A pixel shows the point on its ray at which half of the ray's opacity is reached (seen_point()):
//   1. List the ray's segments, each with the optical depths in front of its two ends.
//   2. wanted = -ln(1 - opacity / 2), where `opacity` is the whole ray's.
//   3. Find the first segment whose back has at least that depth, and bisect for the place in it.
#include "reference/scene_tracer.h"

#include <numeric>

#include "optics/opacity.h"
#include "optics/segment_integral.h"
#include "reference/cell_walk.h"
#include "reference/cells.h"
#include "reference/chord.h"
#include "reference/composite.h"
#include "reference/mesh_walk.h"
#include "reference/transfer_intervals.h"

namespace lamina {
namespace {

View view_of(const Scene& scene) {
    return View(*scene.camera, scene.width, scene.height);
}

TraceOptions options_of(const Scene& scene) {
    return {scene.trace_tolerance, copied_lighting(scene.lighting), half_spaces(scene.clip)};
}

// A segment of the ray, with the optical depths in front of its ends.
template <typename Segment>
struct RayStep {
    Segment segment;
    double from, to;  // parameters of the segment's ends
    double depth_before, depth_after;
};

// Returns the parameter in the step at which the ray's optical depth reaches `depth`.
// depth_of(segment, from, to) is the depth of a part of a segment.
template <typename Segment, typename DepthOf>
double place_of_depth(const RayStep<Segment>& step, double depth, const DepthOf& depth_of) {
    double before = step.from, after = step.to;
    for (double middle = std::midpoint(before, after); before < middle && middle < after;
         middle = std::midpoint(before, after)) {
        const double reached = step.depth_before + depth_of(step.segment, step.from, middle);
        (reached < depth ? before : after) = middle;
    }
    return after;
}

// Returns the optical depth with half of the opacity that a ray of depth `whole` has.
double depth_of_half(double whole) {
    return -std::log1p(-opacity_from_depth(whole) / 2);
}

// Finds the point at which half of the ray's opacity is reached. `first_z`: the ray's parameter at
// the steps' parameter 0. value_of(segment, place) returns the data's value.
template <typename Segment, typename DepthOf, typename ValueOf>
std::optional<SeenPoint> point_in(const std::vector<RayStep<Segment>>& steps, const View::Ray& ray,
                                  double first_z, const DepthOf& depth_of,
                                  const ValueOf& value_of) {
    if (steps.empty() || !(steps.back().depth_after > 0)) return {};
    const double depth = depth_of_half(steps.back().depth_after);
    const auto step = std::ranges::lower_bound(
        steps, depth, {}, [](const RayStep<Segment>& a) { return a.depth_after; });
    const RayStep<Segment>& there = step == steps.end() ? steps.back() : *step;
    const double place = place_of_depth(there, depth, depth_of);
    return SeenPoint{ray.origin + (first_z + place) * ray.direction, value_of(there.segment, place),
                     opacity_from_depth(steps.back().depth_after)};
}

template <typename Samples>
std::optional<SeenPoint> seen_in(const Scene& scene, const Grid& grid, const Samples& first_sample,
                                 const View::Ray& ray) {
    const Chord chord = clip_to_box(grid, ray, half_spaces(scene.clip));
    if (!(chord.length_z > 0)) return {};
    const CellSamples<Samples> samples(grid, first_sample);
    const TransferIntervals transfer(*scene.transfer_function);
    const auto integrate = [&](const CellIndex& cell, double from, double to,
                               RayIntegrator& integrator) {
        CellBatch alone;
        alone.add(cell, from, to);
        samples.fetch(alone);
        SegmentBatch segment;
        make_segments(alone, chord, transfer.columns(), segment);
        integrator.add(segment);
    };
    RayIntegrator whole(transfer, scene.trace_tolerance), within(transfer, scene.trace_tolerance);
    whole.begin(chord.world_length());
    std::vector<RayStep<CellIndex>> steps;
    CellWalk(grid, chord).run([&](const CellIndex& cell, double from, double to) {
        const double before = whole.optical_depth();
        integrate(cell, from, to, whole);
        steps.push_back({cell, from, to, before, whole.optical_depth()});
        return !whole.opaque();
    });
    const auto depth_of = [&](const CellIndex& cell, double from, double to) {
        within.begin(chord.world_length());
        integrate(cell, from, to, within);
        return within.optical_depth();
    };
    const auto value_of = [&](const CellIndex& cell, double place) {
        const glm::dvec3 corner(cell[0], cell[1], cell[2]);
        return samples.corners(cell).along(chord.place_in_cell(corner, place), glm::dvec3(0))(0);
    };
    // A chord's parameter is 0 at its entry into the box, a ray's at the ray's origin.
    const glm::dvec3 entry = grid.to_world(chord.entry);
    const double entry_z =
        glm::dot(entry - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
    return point_in(steps, ray, entry_z, depth_of, value_of);
}

}  // namespace

TraceResult trace(const Scene& scene, const Volume& volume, const TileDone& tile_done) {
    return trace_volume(volume, *scene.transfer_function, view_of(scene), options_of(scene),
                        tile_done);
}

TraceResult trace(const Scene& scene, const SceneMesh& mesh, const TileDone& tile_done) {
    return trace(scene, mesh, FaceTree(mesh.mesh, mesh.mesh.open_faces()), tile_done);
}

TraceResult trace(const Scene& scene, const SceneMesh& mesh, const FaceTree& open_faces,
                  const TileDone& tile_done) {
    return trace_mesh(mesh.mesh, open_faces, mesh.scalar.values, *scene.transfer_function,
                      view_of(scene), options_of(scene), tile_done);
}

std::optional<SeenPoint> seen_point(const Scene& scene, const Volume& volume, double column,
                                    double row) {
    return visit_samples(volume, [&](const auto& first_sample) {
        return seen_in(scene, volume.grid(), first_sample, view_of(scene).ray(column, row));
    });
}

std::optional<SeenPoint> seen_point(const Scene& scene, const SceneMesh& mesh,
                                    const FaceTree& open_faces, double column, double row) {
    const View::Ray ray = view_of(scene).ray(column, row);
    const double world_per_z = glm::length(ray.direction);
    const SeenRange seen = seen_range(half_spaces(scene.clip), ray);
    const std::span<const double> scalar = mesh.scalar.values;
    RayWalk walk(mesh.mesh, open_faces);
    walk.aim(ray.origin, ray.direction);
    std::vector<TetSegment> listed;
    walk.list(listed);
    const auto depth_of = [&](const SeenSegment& segment, double from, double to) {
        const double slope = (segment.back - segment.front) / (segment.to - segment.from);
        return integrate_segment(
                   *scene.transfer_function, segment.front + slope * (from - segment.from),
                   segment.front + slope * (to - segment.from), (to - from) * world_per_z)
            .optical_depth;
    };
    std::vector<RayStep<SeenSegment>> steps;
    double depth = 0;
    for (const TetSegment& whole : listed) {
        const SeenSegment segment = seen_segment(whole, seen, scalar);
        // A tet without a value at one of its corners is transparent.
        const Tet& tet = mesh.mesh.tets()[whole.tet];
        const auto finite = [&](std::int32_t corner) { return std::isfinite(scalar[corner]); };
        if (!(segment.from < segment.to) || !std::ranges::all_of(tet, finite)) continue;
        const double before = depth;
        depth += depth_of(segment, segment.from, segment.to);
        steps.push_back({segment, segment.from, segment.to, before, depth});
    }
    const auto value_of = [&](const SeenSegment& segment, double place) {
        return segment.front + (segment.back - segment.front) / (segment.to - segment.from) *
                                   (place - segment.from);
    };
    return point_in(steps, ray, 0, depth_of, value_of);
}

}  // namespace lamina
