// SPDX-License-Identifier: Apache-2.0
#include "reference/clip_span.h"

namespace lamina {

void clip_span(std::span<const HalfSpace> clip, const View::Ray& ray, RaySpan& span) {
    for (const HalfSpace& half : clip) {
        DoubleDouble distance, slope;  // of the ray's origin, and its change with z
        for (int axis = 0; axis < 3; ++axis) {
            const DoubleDouble normal{half.normal[axis], 0};
            distance = distance + normal * exact_sum(ray.origin[axis], -half.point[axis]);
            slope = slope + normal * DoubleDouble{ray.direction[axis], 0};
        }
        if (slope.hi == 0) {
            if (distance < DoubleDouble{}) span.to = span.from;
            continue;
        }
        const DoubleDouble at = -distance / slope;
        if (!at.finite()) {  // the ray as good as runs along the plane
            if (distance < DoubleDouble{}) span.to = span.from;
        } else if (slope.hi > 0) {
            if (span.from < at) span.from = at;
        } else {
            if (at < span.to) span.to = at;
        }
    }
}

}  // namespace lamina
