// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "lamina/frame_statistics.h"
#include "model/frame_cost.h"

namespace lamina::view {

// The cost of the last pictures.
class FrameHistory {
  public:
    static constexpr std::size_t most_frames = 240;

    void add(const FrameStatistics& statistics, bool moving);
    const std::deque<FrameCost>& frames() const { return frames_; }  // the oldest first
    double longest_ms() const;                                       // of frames()
    double median_ms(bool moving) const;                             // 0 if there are none

    // Returns the names of all stages, in the order in which they run.
    static const std::vector<std::string>& stage_names();

  private:
    std::deque<FrameCost> frames_;
    std::map<std::string, double> last_;  // FrameStatistics::stages_ms
};

}  // namespace lamina::view
