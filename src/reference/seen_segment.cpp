// SPDX-License-Identifier: Apache-2.0
#include "reference/seen_segment.h"

#include <cmath>

#include "reference/clip_span.h"

namespace lamina {

SeenRange seen_range(std::span<const HalfSpace> clip, const View::Ray& ray) {
    RaySpan span{{0, 0}, {INFINITY, 0}};
    clip_span(clip, ray, span);
    return {span.from.rounded(), span.to.hi == INFINITY ? INFINITY : span.to.rounded()};
}

SeenSegment seen_segment(const SeenSegment& whole, const SeenRange& seen) {
    if (whole.from >= seen.from && whole.to <= seen.to) return whole;
    if (whole.to <= seen.from || whole.from >= seen.to || seen.from >= seen.to) return {0, 0, 0, 0};
    SeenSegment part = whole;
    const double slope = (part.back - part.front) / (part.to - part.from);
    if (part.to > seen.to) {
        part.back -= slope * (part.to - seen.to);
        part.to = seen.to;
    }
    if (part.from < seen.from) {
        part.front += slope * (seen.from - part.from);
        part.from = seen.from;
    }
    return part;
}

SeenSegment seen_segment(const TetSegment& segment, const SeenRange& seen,
                         std::span<const double> scalar) {
    return seen_segment({segment.in.at, segment.out.at, segment.in.interpolate(scalar),
                         segment.out.interpolate(scalar)},
                        seen);
}

}  // namespace lamina
