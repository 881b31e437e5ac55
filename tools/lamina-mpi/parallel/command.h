// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "lamina/camera.h"
#include "parallel/wire.h"

namespace lamina {

// A command of rank 0 to the others, which is sent as bytes.
struct Command {
    enum class Kind { open, draw, close, end };

    Kind kind = Kind::end;
    int scene = 0;                        // its number
    Wire wire = Wire::float32;            // open
    unsigned long long memory_limit = 0;  // open; bytes, 0: as it is
    bool many_frames = false;             // open
    bool turned = false;                  // draw: with another camera
    Camera camera{};                      // draw
};
static_assert(std::is_trivially_copyable_v<Command>);

}  // namespace lamina
