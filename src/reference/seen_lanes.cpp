// SPDX-License-Identifier: Apache-2.0
// Vector form of seen_segment() (reference/seen_segment.cpp).
#include "reference/seen_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/seen_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/visible_ranges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

// Returns a bit for each lane that shows something.
HWY_INLINE LaneSet find_seen_from(const WalkLanes& walk, const VisibleRanges& visible,
                                  std::size_t lane, SeenLanes& seen) {
    const Lanes d;
    const auto load = [&](const WalkLanes::Row& row)
                          HWY_ATTR { return hn::Load(d, row.data() + lane); };
    const auto store = [&](WalkLanes::Row& row, Doubles values)
                           HWY_ATTR { hn::Store(values, d, row.data() + lane); };
    const Doubles enter = load(walk.in().at), leave = load(walk.out().at);
    const Doubles at_enter = load(walk.in().value), at_leave = load(walk.out().value);
    const Doubles first = load(seen.first), last = load(seen.last);
    const Doubles slope = hn::Div(hn::Sub(at_leave, at_enter), hn::Sub(leave, enter));
    const Mask cut_first = hn::Lt(enter, first), cut_last = hn::Gt(leave, last);
    const Doubles from = hn::IfThenElse(cut_first, first, enter),
                  to = hn::IfThenElse(cut_last, last, leave);
    const Doubles front = hn::IfThenElse(
        cut_first, hn::Add(at_enter, hn::Mul(slope, hn::Sub(first, enter))), at_enter);
    const Doubles back =
        hn::IfThenElse(cut_last, hn::Sub(at_leave, hn::Mul(slope, hn::Sub(leave, last))), at_leave);
    const Doubles least = load(walk.least), most = load(walk.most);
    const Doubles bound = hn::Mul(number(scalar_epsilons * std::numeric_limits<double>::epsilon()),
                                  hn::Max(hn::Abs(least), hn::Abs(most)));
    const Doubles slack = hn::IfThenZeroElse(hn::Eq(least, most), bound);
    store(seen.from, from);
    store(seen.to, to);
    store(seen.front, front);
    store(seen.back, back);
    store(seen.length, hn::Mul(hn::Sub(to, from), load(seen.world_per_z)));
    store(seen.slack, slack);
    const Mask shows =
        visible.meet(hn::Sub(hn::Min(front, back), slack), hn::Add(hn::Max(front, back), slack));
    return set_of(hn::And(shows, hn::Lt(from, to)));
}

}  // namespace reference

inline void find_seen_of(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen) {
    using namespace reference;
    const VisibleRanges visible(intervals);
    seen.shown = 0;
    for (std::size_t lane = 0; lane < WalkLanes::width; lane += hn::Lanes(Lanes()))
        seen.shown |= find_seen_from(walk, visible, lane, seen) << lane;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(find_seen_of);

void find_seen(const WalkLanes& walk, const IntervalColumns& intervals, SeenLanes& seen) {
    HWY_DYNAMIC_DISPATCH(find_seen_of)(walk, intervals, seen);
}

}  // namespace lamina
#endif
