// SPDX-License-Identifier: Apache-2.0
#include "executors/light_cuts.h"

#include <algorithm>
#include <cmath>

#include "optics/ray_lights.h"

namespace lamina {
namespace {

// With this growth the gradient is nowhere shorter than .3 of what it is in the middle.
constexpr double most_growth = 0.7;
// Width of a highlight's peak, in units of 1 / sqrt(power), the angle at which it falls to
// exp(-1/2). Three nodes on six of these units have one within 1.2 units of any peak.
constexpr double peak_widths = 3;

}  // namespace

LightCuts light_cuts(const Lighting& lighting) {
    LightCuts cuts;
    cuts.most_turn = cuts.most_plain_turn = most_growth;
    if (lighting.specular > 0)
        cuts.most_turn = std::min(most_growth, peak_widths / std::sqrt(lighting.power));
    const glm::dvec3 anywhere(0, 0, 1);
    const RayLights lights(lighting, anywhere);
    cuts.plain_effect = lights.largest_effect(1) - lights.largest_effect(0);
    cuts.highlight_effect = lights.largest_effect(0);
    return cuts;
}

}  // namespace lamina
