// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "compositing/codes.h"
#include "lamina/scene.h"
#include "lamina/settings.h"
#include "plan/capabilities.h"

namespace lamina {

// Throws Error if the picture does not fit the context's render targets.
void check_limits(const Scene& scene, const Capabilities& capabilities);

// The part of the context that computes OVER on the target's pixels.
enum class Blending {
    native,     // the blending unit
    registers,  // the compute program, which holds the pixel
    tiles,      // the cpu engine, which holds the pixel
};

// Returns how a context composites codes, which its blending unit cannot.
Blending code_blending(const Capabilities& capabilities);
const char* name_of(Blending blending);

// Returns the dithering for `slabs` slabs, with its period chosen if that is automatic.
Dither dither_of(const DitherSettings& settings, int slabs);

struct CompositingPlan {
    double unit = 1;  // world lengths times this are in the plan's units (scene/camera.h)
    Target target = Target::float32;
    std::optional<Emulation> emulation;  // for Target::emulated
    Blending blending = Blending::native;
    Order order = Order::back_to_front;

    // Bits of a code, if the program rounds fragments to codes.
    int code_bits() const {
        return emulation ? emulation->bits : target == Target::fixed16 ? 16 : 8;
    }

    friend bool operator==(const CompositingPlan&, const CompositingPlan&) = default;
};

}  // namespace lamina
