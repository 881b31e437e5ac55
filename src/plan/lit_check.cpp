// SPDX-License-Identifier: Apache-2.0
#include "plan/lit_check.h"

#include "base/error.h"
#include "scene/coloring.h"

namespace lamina {

namespace {

void check_smallest_gradient(const Scene& scene) {
    if (scene.lighting->smallest_gradient.is_given()) return;
    fail("{}: lighting.smallest_gradient: has not been chosen from the data", scene.file.string());
}

}  // namespace

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
