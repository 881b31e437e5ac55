// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "work/shown.h"

namespace lamina::view {

// Times of the window's frames since start().
class Measurements {
  public:
    Measurements() { start(); }
    void start();
    // Adds the time from an input to its picture on screen.
    void add_latency(double ms) { latencies_.push_back(ms); }
    // Adds the time from the begin of a frame until it is shown.
    void add_frame(double ms) { frames_.push_back(ms); }
    // Returns one line of JSON with the times and the picture's known error.
    std::string text(const std::string& name, const Shown& shown) const;

  private:
    std::vector<double> latencies_, frames_;
    double cpu_seconds_ = 0, seconds_ = 0;  // at start()
};

}  // namespace lamina::view
