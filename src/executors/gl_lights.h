// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "gl/program.h"
#include "lamina/lighting.h"

namespace lamina {

// Sets the definitions that specialise shaders/optics/lighting.glsl.
void set_light_defines(const Lighting& lighting, gl::Defines& defines);

// Sets the uniforms of shaders/optics/lighting.glsl. `axes`: those of the shader's vectors,
// orthogonal, of any length, in world space.
void set_lights(const Lighting& lighting, const std::array<glm::dvec3, 3>& axes,
                gl::Program& program);
// Sets the thresholds at which lit pieces of rays are cut.
void set_light_cuts(const Lighting& lighting, gl::Program& program);

}  // namespace lamina
