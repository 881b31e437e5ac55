// SPDX-License-Identifier: Apache-2.0
// Cases from scenes and ways to draw them.
#pragma once

#include <string>
#include <vector>

#include "selftest/drawing_way.h"
#include "selftest/selftest_case.h"
#include "selftest/selftest_scene.h"

namespace lamina::selftest {

// A mesh by itself, in one colour (picture_bounds.h).
struct MeshScene {
    std::string name, about;
    Scene scene;
    std::function<MeshData()> mesh;
    bool cyclic = false;  // its visibility order has cycles, which must be reported
};

// The scene in each way that it allows: ways that draw meshes where it has one.
std::vector<SelftestCase> cases_of(const std::string& group, const SelftestScene& scene,
                                   const std::vector<DrawingWay>& ways);
SelftestCase case_of(const std::string& group, const MeshScene& scene, const DrawingWay& way);

// Two scenes whose pictures must be the same.
SelftestCase same_picture_case(const std::string& group, const std::string& name,
                               const SelftestScene& a, const SelftestScene& b,
                               const DrawingWay& way);

// Drawing must throw an Error.
SelftestCase refusal_case(const std::string& group, const SelftestScene& scene,
                          const DrawingWay& way, const std::string& reason);

// A box in perspective, all of it in view, 24 x 18 pixels, 64 slabs.
SelftestScene plain_scene(const std::string& name, const std::string& about);
// Looking at the box from the same side as plain_scene() does, at this distance in units of its
// diagonal.
Camera camera_at(const LayeredBox& box, double distance, double fov_y);
TransferFunction optics_of(const std::vector<TransferKnot>& knots);

std::vector<SelftestCase> optics_cases();
std::vector<SelftestCase> depth_cases();
std::vector<SelftestCase> mesh_cases();
std::vector<SelftestCase> view_cases();
std::vector<SelftestCase> number_cases();
std::vector<SelftestCase> metamorphic_cases();

}  // namespace lamina::selftest
