// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "facts/drawn_range.h"
#include "optics/ray_lights.h"
#include "scene/scene.h"

namespace lamina {
namespace {

// Shares of max_error that light may take: for kinks and bends alone, and in all, including pieces
// of rays too faint to be examined.
constexpr double bend_share = 0.5, light_share = 0.75;
// Largest share of a kink's bend that Gauss' rule of three nodes misses if the kink lies between
// nodes (docs/numerics.md, section 10.4).
constexpr double missed_of_kink = 0.045;
const glm::dvec3 anywhere(0, 0, 1);  // a direction to the eye

// Returns the bend of light that a piece of a ray may have (docs/numerics.md, equation (10.4)). A
// ray's opacity is at most 1: if each piece misses only this share of its colour, so does the ray.
double most_bend(const Scene& scene, double max_color) {
    return bend_share * scene.max_error / 255 / missed_of_kink / std::max(max_color, 1.0);
}

constexpr int most_iterations = 65535;  // iterations of llvmpipe's loops (plan/choices.h)
constexpr int spare_iterations = 64;    // iterations for everything else that a fragment does
constexpr int search_cells = 1024;  // equal parts of the range; each knows where a search begins
// Bound on the iterations that cut deep cells (shaders/slicing/cut_cell.glsl). Cells deeper than an
// optical depth of .75 are cut, and rays end at 20.7. A piece at least half as deep takes up to 20
// iterations to find; if extinction rises from 0, up to 20 shallower pieces come before it.
constexpr int deep_cell_iterations = 8192;

bool is_unlimited(const Capabilities& capabilities) {
    return !capabilities.software || capabilities.cpu;
}

// Returns the largest number of iterations of a search for the interval of a scalar: the number of
// knots in the fullest of the search_cells, and one more to find that the search is done.
int search_iterations(const Scene& scene, const Facts& facts) {
    const ValueRange range = drawn_range(*scene.transfer_function, facts.range);
    assert(range.hi > range.lo);
    std::vector<int> knots(search_cells, 0);
    for (const TransferKnot& knot : scene.transfer_function->knots()) {
        if (knot.value < range.lo || knot.value > range.hi) continue;
        const double share = (knot.value - range.lo) / (range.hi - range.lo);
        ++knots[static_cast<std::size_t>(std::min<double>(share * search_cells, search_cells - 1))];
    }
    return 1 + *std::ranges::max_element(knots);
}

// Returns the loop iterations of a slab: counts the slab, a leap, light in the middle or at up to
// two ends, and for tables four searches and up to three pieces (shaders/slicing/slab_march.glsl,
// slab_light.glsl, shaders/preintegration/knot_table.glsl).
int iterations_of_slab(const Scene& scene, const Facts& facts) {
    const int search = search_iterations(scene, facts);
    const bool table = scene.slice.classification == Classification::preintegrated;
    const int light = !scene.lighting ? 0 : table ? 2 : 1;
    return 2 + light + (table ? 4 * search + 4 : search);
}

// Returns the loop iterations of a cell: counts the cell, a leap, its light, two searches, and if
// there are knots one for the cell and up to three crossings of each (a cubic has three monotone
// pieces).
double iterations_of_cell(const Scene& scene, const Facts& facts) {
    const auto pieces = 3 * (static_cast<double>(facts.knots) + 1);
    const int light = scene.lighting ? 1 : 0;
    return 2 + light + 2 * search_iterations(scene, facts) + (facts.knots > 0 ? 1 + pieces : 0);
}

// Bounds the number of cells that a ray crosses between two planes `depth` apart: one for each grid
// plane, and the first. A direction's component sum is bounded by its length (Cauchy and Schwarz).
double most_cells(const Facts& facts, double depth) {
    const glm::dvec3 box = facts.occupied.max - facts.occupied.min;
    glm::dvec3 cells_per_unit;
    for (int axis = 0; axis < 3; ++axis)
        cells_per_unit[axis] = 1 / glm::length(facts.grid.step[static_cast<std::size_t>(axis)]);
    const double along = depth * facts.max_length_per_depth * glm::length(cells_per_unit);
    return std::min(box.x + box.y + box.z, along) + 4;
}

double iterations_at_any_length(const Scene& scene, const Facts& facts) {
    const bool cuts_deep_cells = !facts.single_color || scene.lighting;
    return spare_iterations + (cuts_deep_cells ? deep_cell_iterations : 0) +
           light_iterations(scene, facts.max_color);
}

double exact_iterations(const Scene& scene, const Facts& facts, double share) {
    const double depth = share * (facts.far_depth - facts.near_depth);
    return iterations_at_any_length(scene, facts) +
           most_cells(facts, depth) * iterations_of_cell(scene, facts);
}

// Returns the number of slabs of a scene with exact segments: the scene's own, that of its tree, or
// `least`, which the context's loops need.
int slabs_of(const Scene& scene, int least) {
    const SliceSettings& slice = scene.slice;
    if (slice.samples.is_given()) return *slice.samples;
    const TreeSettings* const tree = given_tree(slice.tree);
    if (tree == nullptr) return least;
    std::int64_t leaves = 1;
    for (const int factor : tree->factors)
        leaves = std::min<std::int64_t>(leaves * factor, max_slabs);
    return static_cast<int>(leaves);
}

void check_exact(const Scene& scene, const Facts& facts, int least,
                 const Capabilities& capabilities) {
    if (scene.slice.filter == Filter::hardware) {
        fail(
            "{}: render.slice.filter: found \"hardware\", expected \"exact\" with classification "
            "\"exact\"",
            scene.file.string());
    }
    const double least_error = least_lit_error(scene, facts, capabilities);
    if (scene.max_error < least_error) {
        fail(
            "{}: render.max_error: found {}, expected at least {:.2g} with lighting and {}, which "
            "ends the loops of rays that are cut where light bends; or use --context cpu",
            scene.file.string(), scene.max_error, least_error, capabilities.renderer);
    }
    if (slabs_of(scene, least) < least) {
        fail(
            "{}: render.slice.samples: found {} with classification \"exact\", expected at least "
            "{} with {}, which ends the loops of longer segments; or use --context cpu",
            scene.file.string(), slabs_of(scene, least), least, capabilities.renderer);
    }
}

}  // namespace

LightPlan plan_light(const Scene& scene, double max_color, bool cuts_rays) {
    if (!scene.lighting || !cuts_rays) return {copied_lighting(scene.lighting)};
    return {copied_lighting(scene.lighting), most_bend(scene, max_color),
            light_share * scene.max_error};
}

// Returns the bound of docs/numerics.md, equation (10.6).
double light_iterations(const Scene& scene, double max_color) {
    if (!scene.lighting) return 0;
    const RayLights lights(**scene.lighting, anywhere);
    const double most = 4 * std::max(lights.largest_effect(1), 1.0) * 2.52 * lights.effect_span() /
                        most_bend(scene, max_color);
    return (3 * 8 + 10) * most;
}

double largest_drawn_color(const Scene& scene, double max_color) {
    if (!scene.lighting) return max_color;
    return RayLights(**scene.lighting, anywhere).brightest_lit(max_color);
}

void check_lit_slicing(const Scene& scene) {
    if (!scene.lighting) return;
    if (scene.lighting->is_automatic())
        fail("{}: lighting: has not been chosen from the data", scene.file.string());
    if ((*scene.lighting)->smallest_gradient.is_given()) return;
    fail("{}: lighting.smallest_gradient: has not been chosen from the data", scene.file.string());
}

// The colourings that mix colours interpolate colours, or one opacity, between the vertices of a
// fan: they have no place for a gradient. Neither has a table of segments.
void check_lit_projection(const Scene& scene) {
    if (!scene.lighting) return;
    const ProjectSettings& project = scene.project;
    const std::string file = scene.file.string();
    if (mixes_colors(project.coloring)) {
        fail(
            "{}: render.project.coloring: found \"{}\", expected \"preintegrated\" or \"analytic\" "
            "with lighting",
            file, name_of(project.coloring));
    }
    if (project.geometry == ProjectGeometry::triangles ||
        project.interpolation == Interpolation::linear) {
        fail(
            "{}: render.project: found geometry \"{}\" and interpolation \"{}\", expected "
            "silhouettes and perspective with lighting: gradients are found where rays enter and "
            "leave a tet",
            file, name_of(project.geometry), name_of(project.interpolation));
    }
    if (project.table.is_given()) {
        fail(
            "{}: render.project.table: found a table, expected none with lighting: it knows no "
            "gradients",
            file);
    }
    if (project.tree) {
        fail(
            "{}: render.project.tree: found a tree, expected none with lighting: its nodes have "
            "one colour (LaMar 2004, section 6), and light makes many of it",
            file);
    }
    check_lit_slicing(scene);
}

int most_marched_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                       int slabs) {
    if (is_unlimited(capabilities)) return std::numeric_limits<int>::max();
    if (scene.slice.classification == Classification::exact)
        return std::max(1, slabs / least_exact_slabs(scene, facts, capabilities));
    return std::max(1, (most_iterations - spare_iterations) / iterations_of_slab(scene, facts));
}

int most_coded_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                     int slabs) {
    const bool exact = scene.slice.classification == Classification::exact;
    if (is_unlimited(capabilities) || !exact || facts.occupied.empty() || facts.constant)
        return most_marched_slabs(scene, facts, capabilities, slabs);
    const double each = 1 + exact_iterations(scene, facts, 1.0 / slabs);
    return std::max(1, static_cast<int>(most_iterations / each));
}

int least_exact_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities) {
    if (is_unlimited(capabilities) || facts.occupied.empty()) return 1;
    if (facts.constant && !scene.lighting) return 1;
    const auto fits = [&](int slabs) {
        return exact_iterations(scene, facts, 1.0 / slabs) <= most_iterations;
    };
    int slabs = 1;
    while (!fits(slabs) && slabs < max_slabs) slabs *= 2;
    return slabs;
}

double least_lit_error(const Scene& scene, const Facts& facts, const Capabilities& capabilities) {
    if (is_unlimited(capabilities) || !scene.lighting) return 0;
    const double light = light_iterations(scene, facts.max_color);
    const double others = iterations_at_any_length(scene, facts) - light;
    const double cells = most_cells(facts, 0) * iterations_of_cell(scene, facts);
    return scene.max_error * light / std::max(most_iterations - others - cells, 1.0);
}

ClassificationChoice choose_classification(const Scene& scene, const Facts& facts,
                                           const Capabilities& capabilities,
                                           const SampleTrials& trials) {
    check_lit_slicing(scene);
    const Auto<Classification>& asked = scene.slice.classification;
    if (asked.is_given() && asked != Classification::exact) return {*asked, 1, {}};
    const int least = least_exact_slabs(scene, facts, capabilities);
    if (asked == Classification::exact || scene.lighting) {
        check_exact(scene, facts, least, capabilities);
        return {Classification::exact, least,
                asked == Classification::exact ? "" : "light needs the gradient in every cell"};
    }
    if (scene.slice.filter == Filter::hardware)
        return {Classification::post, 1, "exact segments have no use for the hardware's filter"};
    // If the scene asks for neither samples nor a tree, segments get as short as they must be. A
    // tree's leaves may be longer than a slab.
    if (slabs_of(scene, least) < least || (scene.slice.tree && least > 1)) {
        return {Classification::post, 1,
                fmt::format("rays may cross so many cells and points of the transfer function that "
                            "exact segments need {} slabs in this context",
                            least)};
    }
    const auto quicker = std::ranges::find_if(trials.exact, &SlabTrial::keeps_goal);
    if (may_be_quicker(scene) && quicker != trials.exact.end()) {
        return {Classification::post, 1,
                fmt::format("of many frames each is quicker: {} slabs, less than {:.2g} a voxel, "
                            "keep the error",
                            quicker->slabs, quicker_slabs_per_voxel)};
    }
    return {Classification::exact, least,
            "a ray is integrated cell by cell: no number of slabs has to be tried"};
}

bool may_be_quicker(const Scene& scene) {
    return !scene.lighting && scene.slice.classification.is_automatic() &&
           scene.slice.samples.is_automatic() && !scene.slice.tree && !scene.slice.dither &&
           scene.target == Target::float32;
}

Scene with_classification(Scene scene, const ClassificationChoice& choice) {
    scene.slice.classification = choice.classification;
    if (choice.classification == Classification::exact)
        scene.slice.samples = slabs_of(scene, choice.slabs);
    return scene;
}

}  // namespace lamina
