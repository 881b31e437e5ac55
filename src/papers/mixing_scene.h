// SPDX-License-Identifier: Apache-2.0
// In place of LaMar's Richtmyer-Meshkov data (2004, section 5.2): the generated volume `mixing`.
#pragma once

#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina::papers {

// Heavy liquid, at large x, runs into light liquid.
Volume mixing_volume();

// A square orthographic picture of 1024 slabs along z, x to the right. Density is .023 in the light
// liquid, which then shows 4 of 255 as in the paper, and 1 in the heavy one; colour goes from green
// at density 0 to red at 1. The opacity wanted of a ray is .765 times its density: then the largest
// red is 195, and green cannot exceed 48.8, as in the paper (Table 4, period 1: nothing is drawn,
// so that the largest errors, 195 and 47, are the largest values).
Scene mixing_scene(int pixels);
Scene white_mixing_scene(int pixels);  // for what carries no colour

}  // namespace lamina::papers
