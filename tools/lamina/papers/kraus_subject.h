// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "preintegration/table_cache.h"
#include "study/traced_mesh.h"

namespace lamina::papers {

// A mesh with the scenes in which the reproduction of Kraus 2004 shows it: method `project`, target
// float32, and the paper's table (256 x 256 x 16, opacity, 16 bits, exact entries, octaves).
struct KrausSubject {
    std::string name;
    bool measured_data;  // read from a file, not generated
    study::TracedMesh mesh;
    Scene smooth;      // opacity of a ray up to .5
    Scene faint;       // the same with opacity up to .1
    Scene dense;       // the same with opacity up to .95
    Scene isosurface;  // a sharp peak, nearly opaque; its camera may be another one
    // Has the pre-integration tables of its pictures. Subjects of one stage share the stage's.
    std::shared_ptr<TableCache> tables = std::make_shared<TableCache>();
};

// What subjects are made from. The extinctions of the transfer functions are relative: they are
// scaled so that the picture's largest opacity is the intended one.
struct KrausView {
    std::string name;
    Camera camera, isosurface_camera;
    std::vector<TransferKnot> smooth, isosurface;
    double isosurface_opacity = 0.98;
};
// The view of one of the meshes "bluntfin", "combustor", "torso", "graded", "plate" and "box"
// (papers/grid_mesh.h).
KrausView kraus_view(const std::string& name);

KrausSubject make_kraus_subject(study::TracedMesh mesh, const KrausView& view, bool measured_data,
                                int width, int height);

TableSettings paper_table();

}  // namespace lamina::papers
