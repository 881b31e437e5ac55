// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace lamina::view {

// What the window took since it was last asked.
class Measurements {
  public:
    Measurements() { start(); }
    void start();
    void add_latency(double ms) { latencies_.push_back(ms); }  // from input to picture on screen
    void add_frame(double ms) { frames_.push_back(ms); }       // to make one, until it is shown
    // One line of JSON.
    std::string text(const std::string& name) const;

  private:
    std::vector<double> latencies_, frames_;
    double cpu_seconds_ = 0, seconds_ = 0;  // at the start
};

}  // namespace lamina::view
