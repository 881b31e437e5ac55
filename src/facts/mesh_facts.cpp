// SPDX-License-Identifier: Apache-2.0
#include "facts/mesh_facts.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "facts/surface_rays.h"
#include "facts/volume_facts.h"
#include "mesh/face_tree.h"
#include "mesh/predicates.h"
#include "mesh/ray_walk.h"
#include "scene/camera.h"

namespace lamina {

namespace {

// Largest number of overlapping pairs that are ordered: some 400 tets that all overlap.
constexpr std::size_t most_ordered_pairs = 50'000;

void measure_transfer_function(const Scene& scene, const SceneMesh& mesh, const TetPieces& pieces,
                               MeshFacts& facts) {
    const TransferFunction& transfer_function = *scene.transfer_function;
    const double lo = facts.range.lo, hi = facts.range.hi;
    facts.constant = transfer_function.constant(lo, hi);
    facts.single_color = mixes_colors(scene.project.coloring)
                             ? transfer_function.constant_color(lo, hi)
                             : transfer_function.single_color(lo, hi);
    facts.max_extinction = transfer_function.max_extinction(lo, hi);
    facts.max_color = largest_color(transfer_function, facts.range);
    facts.window = mesh_window(transfer_function, mesh.scalar.values, facts.range);
    for (const Tet& tet : mesh.mesh.tets()) {
        const TetPieces::Span span = pieces.visible(mesh.scalar.values, tet);
        facts.transparent_tets += span.empty();
        facts.parts += pieces.count(span);
        if (!span.empty())
            facts.far_tets +=
                runs_beyond(range_in(mesh.scalar.values, tet), facts.window, far_for_parts);
    }
}

// Trial rays along each side, at most one a pixel: 32 * 32 meet most objects that cover 1/1000 of
// the picture.
constexpr int trial_rays_along_side = 32, most_rays = trial_rays_along_side * trial_rays_along_side;

// Number of segments up to which more rays are tried if the scene asks for a table. Its error is
// large on few rays, beside points of the transfer function that are not nodes of the table. So
// many segments are tried in some .3 s of processor time.
constexpr double most_table_segments = 1 << 18;

// Numbers of trial rays along both sides of a picture.
struct RayGrid {
    int columns, rows;

    friend bool operator==(const RayGrid&, const RayGrid&) = default;
};

RayGrid trial_grid(const View& view) {
    const bool all = view.width * std::int64_t{view.height} <= most_rays;
    return {all ? view.width : std::min(trial_rays_along_side, view.width),
            all ? view.height : std::min(trial_rays_along_side, view.height)};
}

// Returns a grid of all pixels, or of as many as have most_table_segments if these `rays` of the
// grid `tried` are typical.
RayGrid finer_grid(const View& view, const RayGrid& tried,
                   const std::vector<std::vector<MeshFacts::Segment>>& rays) {
    double segments = 1;
    for (const auto& ray : rays) segments += static_cast<double>(ray.size());
    const double pixels = static_cast<double>(view.width) * view.height,
                 segments_a_pixel = segments / (static_cast<double>(tried.columns) * tried.rows);
    const double share =
        std::sqrt(most_table_segments / (std::max(segments_a_pixel, 1.0) * pixels));
    if (share >= 1) return {view.width, view.height};
    return {std::max(tried.columns, static_cast<int>(share * view.width)),
            std::max(tried.rows, static_cast<int>(share * view.height))};
}

double longest_edge(const TetMesh& mesh, std::int32_t tet) {
    const auto corners = mesh.corners(tet);
    double longest = 0;
    for (const auto& [i, j] : tet_edges)
        longest = std::max(longest, glm::distance(corners[i], corners[j]));
    return longest;
}

std::vector<MeshFacts::Segment> segments_of(RayWalk& walk, const View& view, int column, int row,
                                            const TetMesh& mesh, std::span<const double> scalar) {
    const View::Ray ray = view.ray(column, row);
    walk.aim(ray.origin, ray.direction);
    const double length_per_depth = glm::length(ray.direction);
    const double diagonal = glm::distance(mesh.bounds().min, mesh.bounds().max);
    std::vector<TetSegment> segments;
    walk.list(segments);
    std::vector<MeshFacts::Segment> found;
    for (const TetSegment& segment : segments) {
        const double in = std::max(segment.in.at, 0.0), length = segment.out.at - in;
        if (!(length > 0)) continue;
        // In a tet around the eye the segment begins at the near plane, whose distance is a share
        // of the mesh's diagonal. So the diagonal takes the place of the tet's longest edge.
        const bool around_eye = segment.in.at < in;
        const double share = length / (segment.out.at - segment.in.at);
        const double back = segment.out.interpolate(scalar);
        const double front = std::lerp(back, segment.in.interpolate(scalar), share);
        const MeshFacts::Segment trial{front, back, length * length_per_depth,
                                       around_eye ? diagonal : longest_edge(mesh, segment.tet)};
        if (std::isfinite(trial.front) && std::isfinite(trial.back)) found.push_back(trial);
    }
    return found;
}

// Returns the rays of find_view_rays() on a grid. `boundary`: of the open faces.
std::vector<std::vector<MeshFacts::Segment>> rays_of_grid(const View& view, const SceneMesh& mesh,
                                                          const FaceTree& boundary,
                                                          const RayGrid& grid) {
    std::vector<std::vector<MeshFacts::Segment>> rays(static_cast<std::size_t>(grid.columns) *
                                                      static_cast<std::size_t>(grid.rows));
    const auto pixel = [](std::int64_t i, int count, int pixels) {
        return static_cast<int>((2 * i + 1) * pixels / (2 * count));
    };
    parallel_for(grid.rows, 1, [&](std::int64_t row) {
        RayWalk walk(mesh.mesh, boundary);
        for (int column = 0; column < grid.columns; ++column) {
            rays[static_cast<std::size_t>(row * grid.columns + column)] =
                segments_of(walk, view, pixel(column, grid.columns, view.width),
                            pixel(row, grid.rows, view.height), mesh.mesh, mesh.scalar.values);
        }
    });
    std::erase_if(rays, [](const auto& ray) { return ray.empty(); });
    return rays;
}

// Largest number of visible tets tried, evenly chosen, because rays may miss narrow peaks.
constexpr std::size_t most_trial_tets = 20000;

// Appends two rays for each tet: its edge from least to largest scalar, in both directions.
void append_tets(const SceneMesh& mesh, const TetPieces& pieces,
                 std::vector<std::vector<MeshFacts::Segment>>& rays) {
    const auto& values = mesh.scalar.values;
    const auto points = mesh.mesh.points();
    std::vector<const Tet*> seen;
    for (const Tet& tet : mesh.mesh.tets()) {
        if (!pieces.visible(values, tet).empty()) seen.push_back(&tet);
    }
    const std::size_t step = seen.size() / most_trial_tets + 1;
    for (std::size_t i = 0; i < seen.size(); i += step) {
        const auto value = [&](std::int32_t corner) {
            return values[static_cast<std::size_t>(corner)];
        };
        const auto [low, high] = std::ranges::minmax_element(*seen[i], {}, value);
        const double length = glm::distance(points[static_cast<std::size_t>(*low)],
                                            points[static_cast<std::size_t>(*high)]);
        rays.push_back({{value(*low), value(*high), length, length}});
        rays.push_back({{value(*high), value(*low), length, length}});
    }
}

// Returns the pixels of the smallest rectangle around a tet; all if it reaches behind the eye.
double pixels_around(const TetMesh& mesh, std::int32_t tet, const WindowView& window) {
    const glm::dvec2 size(window.view().width, window.view().height);
    glm::dvec2 low = size, high(0);
    for (const glm::dvec3& corner : mesh.corners(tet)) {
        const glm::dvec3 seen = window.see(corner);
        if (window.perspective() && !(seen.z > 0)) return size.x * size.y;
        const glm::dvec2 place = window.to_window(seen);
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    const glm::dvec2 extent = glm::max(glm::min(high, size) - glm::max(low, glm::dvec2(0)), 0.0);
    return extent.x * extent.y;
}

// Returns MeshOverlap::covered_pixels.
std::int64_t covered_pixels(const TetMesh& mesh, std::span<const TetPair> pairs, const View& view) {
    const WindowView window(view);
    double sum = 0;
    for (const std::int32_t tet : tets_of(pairs)) sum += pixels_around(mesh, tet, window);
    return static_cast<std::int64_t>(sum);
}

// Tells whether something shows and its segments are integrated. `facts`: of the data.
bool integrates_segments(const Scene& scene, const MeshFacts& facts) {
    return scene.method == Method::project && facts.parts > 0 &&
           !mixes_colors(scene.project.coloring);
}

}  // namespace

MeshFacts measure(const Scene& scene, const SceneMesh& mesh) {
    MeshFacts facts = measure_data(scene, mesh);
    if (is_right_order(scene.project.order))
        facts.overlap = measure_overlap(mesh, facts.convexity, !half_spaces(scene.clip).empty());
    measure_view(scene, mesh, facts);
    measure_rays(scene, mesh, facts);
    return facts;
}

MeshFacts measure_data(const Scene& scene, const SceneMesh& mesh) {
    MeshFacts facts;
    facts.points = static_cast<std::int64_t>(mesh.mesh.points().size());
    facts.tets = static_cast<std::int64_t>(mesh.mesh.tets().size());
    facts.scalar = mesh.scalar.name;
    facts.findings = mesh.mesh.findings();
    const ScalarRange found = measure_range(mesh.scalar.values);
    facts.range = found.range;
    facts.non_finite = found.non_finite;
    check_finite(scene, mesh, found);
    facts.convexity = convexity(mesh.mesh);
    const EdgeLengths lengths = edge_lengths(mesh.mesh);
    facts.shortest_edge = lengths.shortest;
    facts.longest_edge = lengths.longest;
    facts.diagonal = glm::distance(mesh.mesh.bounds().min, mesh.mesh.bounds().max);
    const TetPieces pieces(*scene.transfer_function,
                           drawn_range(*scene.transfer_function, facts.range));
    measure_transfer_function(scene, mesh, pieces, facts);
    if (!integrates_segments(scene, facts)) return facts;
    auto tets = tets_with_surfaces(scene, mesh, facts);
    if (!tets.empty())
        facts.surface_tets = std::make_shared<const std::vector<std::int32_t>>(std::move(tets));
    return facts;
}

MeshOverlap measure_overlap(const SceneMesh& mesh, Convexity convexity, bool clipped) {
    MeshOverlap overlap;
    if (convexity != Convexity::none) return overlap;
    const Stage searching("overlaps");
    TetOverlaps found = find_overlaps(mesh.mesh, most_ordered_pairs);
    overlap.tets = std::ssize(tets_of(found.pairs));
    overlap.complete = found.complete;
    if (!found.pairs.empty() && !clipped)
        overlap.pairs = std::make_shared<const std::vector<TetPair>>(std::move(found.pairs));
    return overlap;
}

void measure_view(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts) {
    const View view(*scene.camera, scene.width, scene.height);
    facts.orthographic = view.projection == Projection::orthographic;
    facts.in_front = std::ranges::any_of(mesh.mesh.points(), [&](const glm::dvec3& point) {
        return glm::dot(point - view.eye, view.forward) > 0;
    });
    constexpr double margin = 1e-6;  // of the diagonal: far more than rounding
    facts.box_in_front = std::ranges::all_of(
        box_corners(mesh.mesh.bounds().min, mesh.mesh.bounds().max), [&](const glm::dvec3& corner) {
            return glm::dot(corner - view.eye, view.forward) > margin * facts.diagonal;
        });
    facts.overlap.covered_pixels =
        facts.overlap.pairs ? covered_pixels(mesh.mesh, *facts.overlap.pairs, view) : 0;
    facts.surface_error =
        integrates_segments(scene, facts) ? surface_ray_error(scene, mesh, facts) : 0;
}

void measure_rays(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts) {
    facts.trial_rays.clear();
    if (!integrates_segments(scene, facts)) return;
    const TetPieces pieces(*scene.transfer_function,
                           drawn_range(*scene.transfer_function, facts.range));
    const View view(*scene.camera, scene.width, scene.height);
    RayGrid grid = trial_grid(view);
    const FaceTree boundary(mesh.mesh, mesh.mesh.open_faces());
    facts.trial_rays = rays_of_grid(view, mesh, boundary, grid);
    if (scene.project.table.is_given()) {
        const RayGrid finer = finer_grid(view, grid, facts.trial_rays);
        if (finer != grid) facts.trial_rays = rays_of_grid(view, mesh, boundary, finer);
        grid = finer;
    }
    facts.pixels_a_trial_ray = static_cast<double>(view.width) * view.height /
                               (static_cast<double>(grid.columns) * grid.rows);
    append_tets(mesh, pieces, facts.trial_rays);
}

void check_finite(const Scene& scene, const SceneMesh& mesh, const ScalarRange& found) {
    const std::string name = name_of_mesh(scene);
    if (found.range.empty()) {
        fail("{}: all {} values of \"{}\" are NaN or infinite", name, mesh.mesh.points().size(),
             mesh.scalar.name);
    }
    if (found.non_finite > 0 && scene.nan == NanPolicy::error) {
        fail(
            "{}: found {} NaN or infinite values of \"{}\", expected none; \"nan\": "
            "\"transparent\" in the scene (--set nan=transparent; in Python nan=\"transparent\") "
            "draws their tets as transparent",
            name, found.non_finite, mesh.scalar.name);
    }
}

std::vector<std::vector<MeshFacts::Segment>> find_view_rays(const Scene& scene,
                                                            const SceneMesh& mesh) {
    const View view(*scene.camera, scene.width, scene.height);
    return rays_of_grid(view, mesh, FaceTree(mesh.mesh, mesh.mesh.open_faces()), trial_grid(view));
}

}  // namespace lamina
