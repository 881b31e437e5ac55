// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/double_double.h"
#include "scene/camera.h"
#include "scene/half_space.h"

namespace lamina {

// The part from <= z <= to of a viewing ray; none where !(from < to).
struct RaySpan {
    DoubleDouble from, to;
};

// Cuts away what lies outside the half-spaces. The numbers of ray and half-spaces are taken as
// exact. A ray in a plane is kept.
void clip_span(std::span<const HalfSpace> clip, const View::Ray& ray, RaySpan& span);

}  // namespace lamina
