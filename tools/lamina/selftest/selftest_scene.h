// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "lamina/mesh_data.h"
#include "lamina/scene.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {

// What a case of the self-test draws: a layered box, both as a volume and as a mesh.
struct SelftestScene {
    std::string name;
    std::string about;  // what is stiff or extreme here
    LayeredBox box;
    Scene scene;  // transfer function, camera, size, number of slabs; no files
    // Makes tets that fill the box. Empty where no mesh is drawn.
    std::function<MeshData(const LayeredBox&)> mesh;
};

}  // namespace lamina::selftest
