// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "base/profile.h"
#include "base/progress.h"

namespace lamina::study {

// Shows the progress of work with few, long steps whose times are predicted, and predicted anew
// after each. It moves on by itself between them.
class TimedProgress {
  public:
    explicit TimedProgress(const std::string& label);

    void expect(double seconds_left);  // from now

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

}  // namespace lamina::study
