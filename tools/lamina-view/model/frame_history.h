// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lamina/report.h"
#include "model/attempts.h"
#include "model/comparison.h"
#include "model/document.h"

namespace lamina::view {

// Time of a picture, and times of the stages that were done for it. The latter add up to `ms`.
struct FrameCost {
    double ms = 0;
    bool moving = false;
    std::vector<std::pair<std::string, double>> stages;  // ms, in the order of the work
};

// The costs of the last pictures.
class FrameHistory {
  public:
    static constexpr std::size_t most_frames = 240;

    void add(const FrameStatistics& statistics, bool moving);
    const std::deque<FrameCost>& frames() const { return frames_; }  // the oldest first
    double longest_ms() const;                                       // of frames()
    double median_ms(bool moving) const;                             // 0 if there is none

    // Returns the names of all stages, in the order of the work.
    static const std::vector<std::string>& stage_names();

  private:
    std::deque<FrameCost> frames_;
    std::map<std::string, double> last_;  // FrameStatistics::stages_ms
};

// Errors and times of pictures: the current one, earlier ones, and the one compared with.
class PrecisionInSight {
  public:
    Attempts attempts;
    FrameHistory frames;
    Comparison comparison;

    // Takes the pictures that are shown now.
    void follow(const Document& document, const Shown& shown);
    // Pins the picture that is shown as A, if it shows the document.
    void pin(const Document& document, const Shown& shown);
    // Continues with another scene's settings, in the current view or in that scene's.
    static void go_on_with(Document& document, Scene scene, bool keep_view);

  private:
    static bool is_of(const Document& document, const Shown& shown);

    Revisions recorded_;  // revisions of the newest attempt
    std::uint64_t last_frame_ = 0;
};

}  // namespace lamina::view
