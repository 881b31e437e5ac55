// SPDX-License-Identifier: Apache-2.0
#include "gl/pace.h"

#include <glad/gl.h>

#include <algorithm>
#include <utility>

#include "gl/api.h"

namespace lamina::gl {

int WorkPace::next(int left) const {
    int units = std::min(most_, left);
    if (!timed_) return units;
    // What comes first may show nothing, so the first frame goes ahead step by step.
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
    if (!timed_) return;
    wait();
    frame_ended();
}

void WorkPace::wait() {
    api().Finish();
    if (units_ > 0) took(units_, since_waiting_.milliseconds());
    begin_frame();
}

// The slowest units of the first frame are forgotten slowly, because frames have no others to show.
void WorkPace::took(int units, double ms) {
    if (!std::exchange(begun_, true)) return;
    last_units_ = units;
    ms_per_unit_ = std::max(ms / units, known_ ? 0.9 * ms_per_unit_ : ms_per_unit_);
}

}  // namespace lamina::gl
