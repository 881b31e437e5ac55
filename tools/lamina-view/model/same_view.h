// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"

namespace lamina::view {

// Tells whether pictures of both scenes show the same from the same place, pixel by pixel; they do
// not if a camera is not chosen yet.
inline bool same_view(const Scene& a, const Scene& b) {
    if (a.camera.is_automatic() || b.camera.is_automatic()) return false;
    const Camera &from = *a.camera, &to = *b.camera;
    return a.width == b.width && a.height == b.height && from.projection == to.projection &&
           from.eye == to.eye && from.center == to.center && from.up == to.up &&
           from.fov_y == to.fov_y && from.height == to.height;
}

}  // namespace lamina::view
