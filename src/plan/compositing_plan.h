// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/emulation.h"
#include "lamina/order.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// Who computes OVER on what a target holds.
enum class Blending {
    native,   // the blending unit
    fetch,    // the program, which reads its pixel (GL_EXT_shader_framebuffer_fetch)
    barrier,  // the program, which reads the target as a texture, with a barrier between layers
    tiles,    // the native engine, which holds the pixel
};

// Of what is more than a blending unit can do.
Blending programmable_blending(const Capabilities& capabilities);
const char* name_of(Blending blending);

// How fragments are put over one another.
struct CompositingPlan {
    double unit = 1;  // world lengths times this are in the units of renderers (world_unit.h)
    Target target = Target::float32;
    std::optional<Emulation> emulation;  // for Target::emulated
    Blending blending = Blending::native;
    Order order = Order::back_to_front;

    // Bits of a code where fragments are rounded to codes in the program.
    int code_bits() const {
        return emulation ? emulation->bits : target == Target::fixed16 ? 16 : 8;
    }

    friend bool operator==(const CompositingPlan&, const CompositingPlan&) = default;
};

}  // namespace lamina
