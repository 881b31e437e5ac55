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

// Time and memory of a picture. The stages are those that were done for it, and add up to the
// whole.
struct FrameCost {
    double ms = 0;
    bool moving = false;
    std::vector<std::pair<std::string, double>> stages;  // ms, in the order in which they are done
};

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

// Known errors and times of pictures: of the current one, of earlier ones, and of the one beside
// it.
class PrecisionInSight {
  public:
    Attempts attempts;
    FrameHistory frames;
    Comparison comparison;

    // Takes the pictures that are shown.
    void follow(const Document& document, const Shown& shown);
    // Makes the picture that is shown A. Does nothing if it is not that of the document.
    void pin(const Document& document, const Shown& shown);
    // Continues with other settings, in the current view or in that of the scene.
    static void go_on_with(Document& document, Scene scene, bool keep_view);

  private:
    static bool is_of(const Document& document, const Shown& shown);

    Revisions recorded_;  // of the newest attempt
    std::uint64_t last_frame_ = 0;
};

}  // namespace lamina::view
