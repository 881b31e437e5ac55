// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "choice/field.h"
#include "choice/surfaces.h"
#include "lamina/scene.h"

namespace lamina {

// The answer to whether data are lit, with its reason.
struct LightChoice {
    bool lit = false;
    std::string reason;  // for people
};

// Chooses light if what the scene's transfer function shows are surfaces: if most of it lies where
// gradients are large against noise. Light that a setting of the scene would have refused is not
// chosen. `smallest_gradient`: that of the lighting.
LightChoice choose_light(const Scene& scene, const TransferSubject& subject, const Padding& padding,
                         double smallest_gradient);

}  // namespace lamina
