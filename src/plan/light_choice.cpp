// SPDX-License-Identifier: Apache-2.0
#include "plan/light_choice.h"

#include <algorithm>

#include "base/error.h"
#include "optics/ray_lights.h"
#include "scene/coloring.h"

namespace lamina {
namespace {

// Shares of max_error: for kinks and bends, and for light as a whole, including pieces that are too
// faint to be examined.
constexpr double bend_share = 0.5, light_share = 0.75;
// Share of a bend that the rule of three nodes misses of a kink between them (docs/numerics.md,
// section 10.4).
constexpr double missed_of_kink = 0.045;

// Returns the bend that a piece may have (docs/numerics.md, equation (10.4)). A ray's opacity is at
// most 1: if each of its pieces misses no more than its share of what it shows, so does the ray.
double most_bend(const Scene& scene, double max_color) {
    return bend_share * scene.max_error / 255 / missed_of_kink / std::max(max_color, 1.0);
}

void check_smallest_gradient(const Scene& scene) {
    if (scene.lighting->smallest_gradient.is_given()) return;
    fail("{}: lighting.smallest_gradient: has not been chosen from the data", scene.file.string());
}

}  // namespace

LightPlan plan_light(const Scene& scene, double max_color, bool cuts_rays) {
    if (!scene.lighting || !cuts_rays) return {scene.lighting};
    return {scene.lighting, most_bend(scene, max_color), light_share * scene.max_error};
}

// Returns the bound of docs/numerics.md, equation (10.6).
double light_rounds(const Scene& scene, double max_color) {
    if (!scene.lighting) return 0;
    const glm::dvec3 anywhere(0, 0, 1);
    const RayLights lights(*scene.lighting, anywhere);
    const double most = 4 * std::max(lights.largest_effect(1), 1.0) * 2.52 * lights.effect_span() /
                        most_bend(scene, max_color);
    return (3 * 8 + 10) * most;
}

double largest_drawn_color(const Scene& scene, double max_color) {
    if (!scene.lighting) return max_color;
    const glm::dvec3 anywhere(0, 0, 1);
    return RayLights(*scene.lighting, anywhere).brightest_lit(max_color);
}

void check_lit_slicing(const Scene& scene) {
    if (!scene.lighting) return;
    check_smallest_gradient(scene);
}

// The two colourings interpolate colours, or one opacity, between the vertices of a fan: they have
// no place for a gradient. Neither has a table of segments.
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
    check_smallest_gradient(scene);
}

}  // namespace lamina
