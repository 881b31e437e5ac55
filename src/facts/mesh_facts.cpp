// SPDX-License-Identifier: Apache-2.0
#include "facts/mesh_facts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "facts/drawn_range.h"
#include "facts/far_scalars.h"
#include "facts/finite_check.h"
#include "mesh/mesh_shape.h"
#include "mesh/tet_mesh.h"
#include "scene/camera.h"
#include "scene/coloring.h"

namespace lamina {
namespace {

void measure_edges(const TetMesh& mesh, MeshFacts& facts) {
    const EdgeLengths lengths = edge_lengths(mesh);
    facts.shortest_edge = lengths.shortest;
    facts.longest_edge = lengths.longest;
    facts.diagonal = glm::distance(mesh.bounds().min, mesh.bounds().max);
}

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

}  // namespace

MeshFacts measure(const Scene& scene, const SceneMesh& mesh) {
    MeshFacts facts = measure_data(scene, mesh);
    if (is_right_order(scene.project.order))
        facts.overlapping_tets = measure_overlap(mesh, facts.convexity);
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
    measure_edges(mesh.mesh, facts);
    const TetPieces pieces(*scene.transfer_function,
                           drawn_range(*scene.transfer_function, facts.range));
    measure_transfer_function(scene, mesh, pieces, facts);
    return facts;
}

std::int64_t measure_overlap(const SceneMesh& mesh, Convexity convexity) {
    return convexity == Convexity::none ? count_overlapping_tets(mesh.mesh) : 0;
}

void measure_view(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts) {
    const View view(*scene.camera, scene.width, scene.height);
    facts.orthographic = view.projection == Projection::orthographic;
    facts.in_front = std::ranges::any_of(mesh.mesh.points(), [&](const glm::dvec3& point) {
        return glm::dot(point - view.eye, view.forward) > 0;
    });
}

void measure_rays(const Scene& scene, const SceneMesh& mesh, MeshFacts& facts) {
    facts.trial_rays.clear();
    const bool integrated =
        scene.method == Method::project && facts.parts > 0 && !mixes_colors(scene.project.coloring);
    if (!integrated) return;
    const TetPieces pieces(*scene.transfer_function,
                           drawn_range(*scene.transfer_function, facts.range));
    facts.trial_rays = find_trial_rays(scene, mesh, pieces);
}

}  // namespace lamina
