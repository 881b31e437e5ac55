// SPDX-License-Identifier: Apache-2.0
// The remedies of Kraus 2004, one switched off at a time in a scene that has them all.
#pragma once

#include "lamina/scene.h"

namespace lamina::papers {

// Changes only scenes that have a table of their own.
inline Scene with_table_format(Scene scene, TableFormat format) {
    scene.project.table->format = format;
    return scene;
}
inline Scene with_mapping(Scene scene, LengthMapping mapping) {
    scene.project.table->mapping = mapping;
    return scene;
}
inline Scene with_default_integration(Scene scene) {
    scene.project.table = automatic;
    return scene;
}

inline Scene with_linear_interpolation(Scene scene) {
    scene.project.interpolation = Interpolation::linear;
    return scene;
}
inline Scene with_depth_as_thickness(Scene scene) {
    scene.project.thickness = Thickness::dz;
    return scene;
}
inline Scene with_coloring(Scene scene, Coloring coloring) {
    scene.project.coloring = coloring;
    return scene;
}
inline Scene with_target(Scene scene, Target target, ProjectDither dither = ProjectDither::none) {
    scene.target = target;
    scene.project.dither = dither;
    return scene;
}
inline Scene with_geometry(Scene scene, const Auto<ProjectGeometry>& geometry) {
    scene.project.geometry = geometry;
    return scene;
}
inline Scene with_order(Scene scene, ProjectOrder order) {
    scene.project.order = order;
    return scene;
}

}  // namespace lamina::papers
