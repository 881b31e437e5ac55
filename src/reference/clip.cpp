// SPDX-License-Identifier: Apache-2.0
#include "reference/clip.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/clip.cpp"
#include "simd/foreach_target.h"

#include "reference/transfer_intervals-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Cuts a vector of segments as seen_segment() does. Returns a bit for each lane that is visible.
LAMINA_INLINE LaneSet find_seen_from(const WalkLanes& walk, const VisibleRanges& visible,
                                     std::size_t lane, SeenLanes& seen) {
    const auto get = [&](const WalkLanes::Row& row)
                         LAMINA_LAMBDA { return load<Double>(row.data() + lane); };
    const auto put = [&](WalkLanes::Row& row, Double values)
                         LAMINA_LAMBDA { store(values, row.data() + lane); };
    const Double enter = get(walk.in().at), leave = get(walk.out().at);
    const Double at_enter = get(walk.in().value), at_leave = get(walk.out().value);
    const Double first = get(seen.first), last = get(seen.last);
    const Double slope = (at_leave - at_enter) / (leave - enter);
    const DoubleMask cut_first = (enter < first), cut_last = (leave > last);
    const Double from = select(cut_first, first, enter), to = select(cut_last, last, leave);
    const Double front = select(cut_first, at_enter + slope * (first - enter), at_enter);
    const Double back = select(cut_last, at_leave - slope * (leave - last), at_leave);
    const Double least = get(walk.least), most = get(walk.most);
    const Double bound =
        scalar_epsilons * std::numeric_limits<double>::epsilon() * max(abs(least), abs(most));
    const Double slack = zero_if(least == most, bound);
    put(seen.from, from);
    put(seen.to, to);
    put(seen.front, front);
    put(seen.back, back);
    put(seen.length, (to - from) * get(seen.world_per_z));
    put(seen.slack, slack);
    const DoubleMask shows = visible.meet(min(front, back) - slack, max(front, back) + slack);
    return bits_of(shows & (from < to));
}

}  // namespace reference

inline void find_seen_of(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen) {
    using namespace reference;
    const VisibleRanges visible(intervals);
    seen.shown = 0;
    for (std::size_t lane = 0; lane < WalkLanes::width; lane += Double::lanes)
        seen.shown |= find_seen_from(walk, visible, lane, seen) << lane;
}

LAMINA_SIMD_END

#if LAMINA_ONCE
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
        if (!at.finite()) {  // the ray is nearly parallel to the plane
            if (distance < DoubleDouble{}) span.to = span.from;
        } else if (slope.hi > 0) {
            if (span.from < at) span.from = at;
        } else {
            if (at < span.to) span.to = at;
        }
    }
}

SeenRange seen_range(std::span<const HalfSpace> clip, const View::Ray& ray) {
    RaySpan span{{0, 0}, {INFINITY, 0}};
    clip_span(clip, ray, span);
    return {span.from.rounded(), span.to.hi == INFINITY ? INFINITY : span.to.rounded()};
}

SeenSegment seen_segment(const SeenSegment& whole, const SeenRange& seen) {
    if (whole.from >= seen.from && whole.to <= seen.to) return whole;
    if (whole.to <= seen.from || whole.from >= seen.to || seen.from >= seen.to) return {0, 0, 0, 0};
    SeenSegment cut = whole;
    const double slope = (cut.back - cut.front) / (cut.to - cut.from);
    if (cut.to > seen.to) {
        cut.back -= slope * (cut.to - seen.to);
        cut.to = seen.to;
    }
    if (cut.from < seen.from) {
        cut.front += slope * (seen.from - cut.from);
        cut.from = seen.from;
    }
    return cut;
}

SeenSegment seen_segment(const TetSegment& segment, const SeenRange& seen,
                         std::span<const double> scalar) {
    return seen_segment({segment.in.at, segment.out.at, segment.in.interpolate(scalar),
                         segment.out.interpolate(scalar)},
                        seen);
}

LAMINA_EXPORT(find_seen_of);

void find_seen(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen) {
    LAMINA_DISPATCH(find_seen_of)(walk, intervals, seen);
}

}  // namespace lamina
#endif
