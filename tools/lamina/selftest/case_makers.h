// SPDX-License-Identifier: Apache-2.0
// Makes cases from scenes and ways to draw them.
#pragma once

#include <string>
#include <vector>

#include "selftest/drawing_way.h"
#include "selftest/layered_box.h"
#include "selftest/selftest.h"

namespace lamina::selftest {

// A mesh without a volume, in one colour (one_color_picture() in picture_bounds.h bounds it).
struct MeshScene {
    std::string name, about;
    Scene scene;
    std::function<MeshData()> mesh;
    bool cyclic = false;  // its visibility order has cycles; a renderer that sorts must report them
};

// Returns one case for each way to draw that a scene allows; ways that draw meshes need a mesh.
std::vector<SelftestCase> cases_of(const std::string& group,
                                   const std::vector<SelftestScene>& scenes,
                                   const std::vector<DrawingWay>& ways);
SelftestCase case_of(const std::string& group, const MeshScene& scene, const DrawingWay& way);

SelftestCase same_picture_case(const std::string& group, const std::string& name,
                               const SelftestScene& a, const SelftestScene& b,
                               const DrawingWay& way);

// Returns a case in which drawing must throw Error, whose message contains `reason`.
SelftestCase refusal_case(const std::string& group, const SelftestScene& scene,
                          const DrawingWay& way, const std::string& reason);

// Returns a box in perspective that is entirely in view, with 24 x 18 pixels and 64 slabs.
SelftestScene plain_scene(const std::string& name, const std::string& about);
// Returns a camera that sees the box from the direction of plain_scene(). `distance` is in units of
// the box's diagonal.
Camera camera_at(const LayeredBox& box, double distance, double fov_y);
TransferFunction optics_of(const std::vector<TransferKnot>& knots);

std::vector<SelftestCase> optics_cases();
std::vector<SelftestCase> cell_cases();
std::vector<SelftestCase> depth_cases();
std::vector<SelftestCase> mesh_cases();
std::vector<SelftestCase> view_cases();
std::vector<SelftestCase> number_cases();
std::vector<SelftestCase> clip_cases();
std::vector<SelftestCase> light_cases();
std::vector<SelftestCase> metamorphic_cases();

}  // namespace lamina::selftest
