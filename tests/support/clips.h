// SPDX-License-Identifier: Apache-2.0
// Clips for tests, and the length of a ray that a clip keeps.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <vector>

#include "lamina/settings.h"
#include "scene/camera.h"

namespace lamina::test {

struct NamedClip {
    std::string name;
    Clip clip;
};

inline std::vector<NamedClip> clips_of_unit_box() {
    const glm::dvec3 middle(.5);
    return {
        {"oblique", {{{{.55, .4, .5}, {3, -1.7, .9}}}, {}}},
        {"a tiny normal", {{{{.3, .4, .5}, {-3e-200, 1e-200, 2e-200}}}, {}}},
        {"through corners and edges", {{{{0, 0, 0}, {-1, 1, 0}}}, {}}},
        {"along a face of cells", {{{{.5, .5, .5}, {0, 0, 1}}}, {}}},
        {"a wedge", {{{middle, {1, .2, 0}}, {middle, {-1, .3, .4}}}, {}}},
        {"a thin slice", {{{{.5, .5, .5}, {1, 1, 1}}, {{.503, .5, .5}, {-1, -1, -1}}}, {}}},
        {"a box", {{}, ClipBox{{.2, .31, -1}, {.83, .6, .71}}}},
        {"a box and a plane", {{{{.4, .4, .4}, {1, -1, 1}}}, ClipBox{{.1, .1, .1}, {.9, 2, .9}}}},
        {"all of it", {{{{.5, .5, 1}, {0, 0, -1}}}, ClipBox{{0, 0, 0}, {1, 1, 1}}}},
        {"nothing, beside it", {{{{1.5, .5, .5}, {1, 0, 0}}}, {}}},
        {"nothing, between two", {{{{.6, .5, .5}, {1, .1, 0}}, {{.4, .5, .5}, {-1, -.1, 0}}}, {}}}};
}

// Returns the world length that the clip keeps of a ray in an axis-aligned box. It intersects the
// ray's intervals in all half-spaces, in long double.
inline double kept_length(const Clip& clip, const View::Ray& ray, const glm::dvec3& min,
                          const glm::dvec3& max) {
    using Real = long double;
    Real from = 0, to = 1e30L;
    const auto keep = [&](const glm::dvec3& normal, const glm::dvec3& point) {
        Real distance = 0, slope = 0;
        for (int axis = 0; axis < 3; ++axis) {
            distance += Real{normal[axis]} * (Real{ray.origin[axis]} - Real{point[axis]});
            slope += Real{normal[axis]} * Real{ray.direction[axis]};
        }
        if (slope == 0) {
            if (distance < 0) to = from;
        } else if (slope > 0) {
            from = from < -distance / slope ? -distance / slope : from;
        } else {
            to = to > -distance / slope ? -distance / slope : to;
        }
    };
    const auto keep_box = [&](const glm::dvec3& low, const glm::dvec3& high) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 normal(0);
            normal[axis] = 1;
            keep(normal, low);
            keep(-normal, high);
        }
    };
    keep_box(min, max);
    for (const ClipPlane& plane : clip.planes) keep(plane.normal, plane.point);
    if (clip.box) keep_box(clip.box->min, clip.box->max);
    return to > from ? static_cast<double>((to - from) * Real{glm::length(ray.direction)}) : 0;
}

}  // namespace lamina::test
