// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"

namespace lamina::test {

// Returns a scene whose transfer function and camera are automatic; without lighting.
inline Scene open_scene(int width = 64, int height = 48) {
    Scene scene;
    scene.width = width;
    scene.height = height;
    scene.transfer_function = automatic;
    scene.camera = automatic;
    return scene;
}

}  // namespace lamina::test
