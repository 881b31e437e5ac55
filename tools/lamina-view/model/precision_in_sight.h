// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "model/attempts.h"
#include "model/comparison.h"
#include "model/document.h"
#include "model/frame_history.h"

namespace lamina::view {

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
