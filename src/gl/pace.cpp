// SPDX-License-Identifier: Apache-2.0
#include "gl/pace.h"

#include <glad/gl.h>

#include <algorithm>
#include <utility>

#include "gl/api.h"

namespace lamina::gl {

int WorkPace::next(int left) {
    if (units_ == 0) since_waiting_ = {};
    int units = std::min(most_, left);
    if (!timed_) return units;
    // The first units may show nothing, so the first frame goes ahead step by step.
    if (!known_) units = std::min(units, std::max(4 * last_units_, step_));
    if (ms_per_unit_ > 0) {
        const double fitting = std::min<double>(wanted_ms / ms_per_unit_, units);
        units = std::min(units, std::max(static_cast<int>(fitting) / step_ * step_, step_));
    }
    return units;
}

void WorkPace::begin_frame() {
    units_ = 0;
    since_waiting_ = {};
}

void WorkPace::dispatched(int units) {
    units_ += units;
    if (wants_time(since_waiting_.milliseconds())) wait();
}

void WorkPace::end_frame() {
    wait();
    frame_ended();
}

void WorkPace::wait() {
    api().Finish();
    if (units_ > 0) took(units_, since_waiting_.milliseconds());
    begin_frame();
}

// Slow units of a frame are forgotten slowly, because others of its dispatches may show nothing.
// But a unit of a short dispatch may have waited more than it worked: if none can have been long,
// the next ones may have twice the units.
void WorkPace::took(int units, double ms) {
    if (!std::exchange(begun_, true)) return;
    last_units_ = units;
    const double kept = ms < wanted_ms ? .5 : .9;
    ms_per_unit_ = std::max(ms / units, known_ ? kept * ms_per_unit_ : ms_per_unit_);
}

}  // namespace lamina::gl
