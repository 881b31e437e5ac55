// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "lamina/scene.h"
#include "model/revisions.h"
#include "work/pinned_picture.h"

namespace lamina::view {

// A request for a picture.
struct DrawRequest {
    Scene scene;
    Revisions revisions;  // which parts of the scene differ from the request before
    bool moving = false;  // something is being dragged: a coarse picture serves
    bool coarse = true;   // whether it may get one
    bool trace = true;    // whether the tracer replaces the picture at rest
    std::shared_ptr<const PinnedPicture> pinned = {};  // to be kept in the view of the scene
    std::uint64_t number = 0;
    using Clock = std::chrono::steady_clock;
    Clock::time_point asked_at = {};  // of the input, for measurements
};

}  // namespace lamina::view
