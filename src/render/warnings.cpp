// SPDX-License-Identifier: Apache-2.0
#include "render/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/vector_relational.hpp>

#include "mesh/scalar_range.h"

namespace lamina {
namespace {

void add_cells(const CellCounts& cells, Warnings& to) {
    if (cells.merged_points > 0) {
        to.push_back(fmt::format("{} points that pieces of the mesh share are one each",
                                 cells.merged_points));
    }
    if (cells.skipped > 0)
        to.push_back(fmt::format("{} cells have no volume and are not drawn", cells.skipped));
    if (cells.straightened > 0) {
        to.push_back(
            fmt::format("{} quadratic cells are drawn with straight edges", cells.straightened));
    }
}

void add_made(const Scene& scene, const MeshReport& report, Warnings& to) {
    const MeshSettings wanted = scene.mesh_request.value_or(MeshSettings{});
    if (report.within_tolerance || wanted.kuhn) return;
    to.push_back(fmt::format(
        "the mesh stopped {} with {} tets: it differs from the volume by up to {:.3g} of the "
        "range of values, wanted {:.3g}",
        report.stopped_by_max_tets ? "at max_tets" : "where points would lie too close",
        report.tets, report.relative_error(), wanted.tolerance));
}

void add_clamped_colors(const Scene& scene, Warnings& to) {
    const std::int64_t count = clamped_colors(scene);
    if (count == 0) return;
    to.push_back(
        fmt::format("{} transfer-function points have a colour above 1, which the target {} clamps",
                    count, name_of(scene.target)));
}

std::string why_not_kept(const SlicePlan& plan, double wanted, double error) {
    if (plan.integrates_cells()) {
        return fmt::format(
            "exact segments in {} are off by up to {:.2g} / 255{}", name_of(plan.target), error,
            plan.segment_error > exact_segment_error ? ", in proportion to the brightest colour"
                                                     : "");
    }
    if (plan.table.error > wanted) {
        return fmt::format(
            "the pre-integration table is off by up to {:.2g} / 255 "
            "(render.slice.classification \"post\" does without)",
            plan.table.error);
    }
    if (plan.slab_trial) {
        return fmt::format(
            "of the numbers of slabs that were tried, {} are taken, with an error of {:.2g} / 255 "
            "(render.slice.samples sets another)",
            plan.slabs, error);
    }
    return fmt::format("{} slabs composited in {} are off by up to {:.2g} / 255", plan.slabs,
                       name_of(plan.target), error);
}

}  // namespace

Warnings data_warnings(const VolumeData& data) {
    if (data.bricks.non_finite == 0) return {};
    return {fmt::format("{} samples are NaN or infinite: their cells are drawn transparent",
                        data.bricks.non_finite)};
}

Warnings data_warnings(const Scene& scene, const SceneMesh& mesh) {
    Warnings warnings;
    add_cells(mesh.mesh.findings().cells, warnings);
    if (mesh.averaged)
        warnings.push_back(
            fmt::format("\"{}\" is cell data: averaged to points", mesh.scalar.name));
    if (const std::int64_t count = measure_range(mesh.scalar.values).non_finite; count > 0) {
        warnings.push_back(
            fmt::format("{} values are NaN or infinite: their tets are drawn transparent", count));
    }
    if (mesh.report) add_made(scene, *mesh.report, warnings);
    return warnings;
}

Warnings plan_warnings(const Scene& scene, const SlicePlan& plan) {
    Warnings warnings;
    add_clamped_colors(scene, warnings);
    const double wanted = scene.max_error;
    const double error = plan.found_error() + plan.error_bound.value_or(0);
    const auto& trial = plan.slab_trial;
    if (error > wanted) {
        warnings.push_back(fmt::format("render.max_error: {:.4g} is not kept: {}", wanted,
                                       why_not_kept(plan, wanted, error)));
    } else if (trial && trial->doubtful) {
        warnings.push_back(
            fmt::format("render.max_error: {:.4g} is not sure to be kept: {} slabs are off by "
                        "{:.2g} / 255 on {} traced rays of {}, and others may be off by more",
                        wanted, plan.slabs, error, trial->traced, trial->rays));
    }
    return warnings;
}

Warnings plan_warnings(const Scene& scene, std::int64_t overlapping_tets) {
    Warnings warnings;
    add_clamped_colors(scene, warnings);
    if (overlapping_tets > 0) {
        warnings.push_back(
            fmt::format("{}: {} tets overlap others: these have no right order, and the error of "
                        "a picture is unknown where a ray meets them",
                        name_of_mesh(scene), overlapping_tets));
    }
    return warnings;
}

Warnings frame_warnings(const OrderReport& order) {
    if (order.broken == 0) return {};
    return {
        fmt::format("{} tets hide one another in {} rings: {} pairs are drawn in the wrong order",
                    order.cyclic_tets, order.cycles, order.broken)};
}

Warnings trace_warnings(std::int64_t overlapping_rays) {
    if (overlapping_rays == 0) return {};
    return {
        fmt::format("the mesh overlaps itself on the rays of {} pixels: its tets are "
                    "composited there one after the other, as the ray enters them",
                    overlapping_rays)};
}

std::int64_t clamped_colors(const Scene& scene) {
    if (!is_fixed_point(scene.target)) return 0;
    return std::ranges::count_if(scene.transfer_function.knots(), [](const TransferKnot& knot) {
        return glm::any(glm::greaterThan(knot.optics.color, glm::dvec3(1)));
    });
}

}  // namespace lamina
