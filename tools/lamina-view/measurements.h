// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "work/shown.h"

namespace lamina::view {

// Times of the window's frames since they were last asked for.
class Measurements {
  public:
    Measurements() { start(); }
    void start();
    void add_latency(double ms) { latencies_.push_back(ms); }  // from input to picture on screen
    void add_frame(double ms) { frames_.push_back(ms); }       // to make one, until it is shown
    // One line of JSON, with what is known of the picture's error.
    std::string text(const std::string& name, const Shown& shown) const;

  private:
    std::vector<double> latencies_, frames_;
    double cpu_seconds_ = 0, seconds_ = 0;  // at the start
};

}  // namespace lamina::view
