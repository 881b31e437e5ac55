// SPDX-License-Identifier: Apache-2.0
#include "study/timed_progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lamina::study {
namespace {

constexpr double steps = 1e6;  // the line from 0 to 100 % has so many
constexpr std::chrono::milliseconds pause(500);

// Work that goes on takes at least this share of its time so far, whatever was predicted.
constexpr double least_left = 0.02;

}  // namespace

TimedProgress::TimedProgress(const std::string& label)
    : progress_(label, static_cast<std::int64_t>(steps)),
      thread_([this](const std::stop_token& stop) { keep_showing(stop); }) {}

void TimedProgress::expect(double seconds_left) {
    const std::scoped_lock lock(mutex_);
    expected_end_ = watch_.seconds() + seconds_left;
    show();
}

void TimedProgress::keep_showing(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        woken_.wait_for(lock, stop, pause, [] { return false; });
        if (!stop.stop_requested()) show();
    }
}

// Progress predicts the time left from the share that is done.
void TimedProgress::show() {
    const double now = watch_.seconds();
    const double left = std::max(expected_end_ - now, least_left * now);
    const auto done = std::llround(steps * now / std::max(now + left, 1e-9));
    progress_.advance(done - shown_);
    shown_ = done;
}

}  // namespace lamina::study
