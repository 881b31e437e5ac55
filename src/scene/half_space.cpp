// SPDX-License-Identifier: Apache-2.0
#include "scene/half_space.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lamina {
namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Checks clips that programs make: those of scene files were checked when they were read.
void check(const Clip& clip) {
    for (const ClipPlane& plane : clip.planes) {
        const glm::dvec3& n = plane.normal;
        if (!finite(plane.point) || !finite(n) || n == glm::dvec3(0))
            fail("clip.planes: found the normal ({}, {}, {}), expected a direction", n.x, n.y, n.z);
    }
    if (clip.box && !(finite(clip.box->min) && finite(clip.box->max)))
        fail("clip.box: found a number that is not finite");
}

}  // namespace

std::vector<HalfSpace> half_spaces(const Clip& clip) {
    check(clip);
    std::vector<HalfSpace> found;
    for (const ClipPlane& plane : clip.planes) {
        const glm::dvec3& n = plane.normal;
        const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        glm::dvec3 scaled(0);
        for (int axis = 0; axis < 3; ++axis)
            scaled[axis] = std::scalbn(n[axis], -std::ilogb(largest));
        found.push_back({plane.point, scaled});
    }
    if (!clip.box) return found;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0);
        normal[axis] = 1;
        found.push_back({clip.box->min, normal});
        found.push_back({clip.box->max, -normal});
    }
    return found;
}

}  // namespace lamina
