// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>

#include "base/client.h"
#include "base/profile.h"

namespace lamina::study {

// Predicts how long the rest of a study takes, from the visits to runs so far. First visits, which
// read data, trace, set up and draw the first picture, and later visits are counted apart.
class TimeLeft {
  public:
    // `timing`: the part of `seconds` that timed frames; a later visit does only this.
    void add_first(double seconds, double timing);
    void add_later(double seconds);

    // Returns the seconds that these numbers of visits take. One first visit must have been added.
    double of(std::size_t first_visits, std::size_t later_visits) const;

  private:
    double first_seconds_ = 0, first_timing_ = 0, later_seconds_ = 0;
    std::size_t first_visits_ = 0, later_visits_ = 0;
};

// Returns "8 s", "3 min", "2 h 10 min": about two digits.
std::string duration_text(double seconds);

// Shows the progress of work with few long steps whose times are predicted, and predicted again
// after each step. Between the steps the bar advances by the clock.
class TimedProgress {
  public:
    explicit TimedProgress(const std::string& label);

    void expect(double seconds_left);  // counted from the call

  private:
    void keep_showing(const std::stop_token& stop);
    void show();

    Progress progress_;
    Stopwatch watch_;
    std::mutex mutex_;
    std::condition_variable_any woken_;
    double expected_end_ = 0;  // seconds of `watch_`
    std::int64_t shown_ = 0;
    std::jthread thread_;  // last: it uses the others
};

// Predicts how long it takes to make, draw and trace the meshes of a ladder, a series of decreasing
// tolerances. This is nearly all of the time of a cross-check. The time is proportional to the
// number of tets, which grows with a power of 1 / tolerance.
class LadderCost {
  public:
    struct Step {
        double tolerance;
        std::int64_t most_tets;
        bool last_if_full = false;  // if the mesh has most_tets, no later step follows
    };

    // Adds a mesh that is done. Tolerances decrease from call to call.
    void add(double tolerance, std::int64_t tets, double seconds);

    // Returns about how many seconds of one processor the meshes take if each has as many tets as
    // it may. Tolerances decrease.
    static double most_seconds(std::span<const Step> steps);
    // Returns the seconds to expect for these meshes. At least one mesh must have been added.
    double expected_seconds(std::span<const Step> steps) const;

  private:
    struct Made {
        double tolerance, tets;
    };

    double power_ = 0, seconds_a_tet_ = 0;  // measured on the last meshes
    std::optional<Made> last_;
};

}  // namespace lamina::study
