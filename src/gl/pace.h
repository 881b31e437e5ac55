// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/profile.h"

namespace lamina::gl {

// Chooses how much work a GPU does in one dispatch, by the time that dispatches took before:
// drivers end programs that take seconds, and a desktop stands still until a dispatch is done. Work
// is counted in units: rows of a picture, or entries of each tile's list. Software is given
// dispatches of a fixed size, and needs no clock.
class WorkPace {
  public:
    // Most that a dispatch should take, in milliseconds. Half of that is aimed at, because the next
    // view may show more.
    static constexpr double most_ms = 100, wanted_ms = most_ms / 2;

    // `most`: units in one dispatch. `step`: a dispatch does a multiple of it, or all that is left.
    // `timed`: false for dispatches of a fixed size.
    WorkPace(int most, int step, bool timed) : most_(most), step_(step), timed_(timed) {}

    // Returns the number of units to do next, of `left` that remain. Must be called right before a
    // dispatch: time does not count in which the host works and the GPU has nothing to do.
    int next(int left);

    // Must be called around the dispatches of a frame and behind each. The GPU is waited for behind
    // each dispatch of the first frame, which begins with few units; later where most_ms have
    // passed since the last wait; and at a frame's end, always.
    void begin_frame();
    void dispatched(int units);
    void end_frame();

    // Tells whether the dispatches that were begun this long ago must be waited for.
    bool wants_time(double ms) const { return timed_ && (!known_ || ms > most_ms); }
    // Learns from the time of dispatches. The first of all is ignored: the program's first use may
    // have cost more.
    void took(int units, double ms);
    void frame_ended() { known_ = true; }

  private:
    void wait();

    int most_, step_;
    bool timed_, known_ = false;
    bool begun_ = false;       // the first dispatch of all is done
    int last_units_ = 0;       // in the first frame
    double ms_per_unit_ = 0;   // of the slowest units so far
    int units_ = 0;            // since the last wait
    Stopwatch since_waiting_;  // for the GPU, or since it had nothing to do
};

}  // namespace lamina::gl
