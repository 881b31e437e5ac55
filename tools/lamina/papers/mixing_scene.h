// SPDX-License-Identifier: Apache-2.0
// The generated volume `mixing`, which replaces LaMar's Richtmyer-Meshkov data (2004, section 5.2).
// Heavy liquid, at large x, flows into light liquid.
#pragma once

#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina::papers {

// Heavy liquid, at large x, runs into light liquid.
Volume mixing_volume();

// A square orthographic picture of 1024 slabs along z, with x to the right. Density is .023 in the
// light liquid, which then shows 4 of 255 as in the paper, and 1 in the heavy liquid. Colour goes
// from green at density 0 to red at 1. The intended opacity of a ray is .765 times its density.
// Then the largest red is 195, and green cannot exceed 48.8, as in the paper (Table 4, period 1:
// nothing is drawn, so that the largest errors, 195 and 47, are the largest values).
Scene mixing_scene(int pixels);
Scene white_mixing_scene(int pixels);  // for techniques that carry no colour

}  // namespace lamina::papers
