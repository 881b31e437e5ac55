// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "model/revisions.h"

namespace lamina::view {

// A picture that is wanted.
struct DrawRequest {
    Scene scene;
    Revisions revisions;  // which parts of the scene differ from the request before
    bool moving = false;  // the camera has not come to rest: a coarse picture serves
    bool coarse = true;   // whether a moving camera may get one
    bool trace = true;    // whether the tracer replaces the picture at rest
};

}  // namespace lamina::view
