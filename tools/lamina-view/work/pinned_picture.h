// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "lamina/frame_statistics.h"
#include "lamina/image.h"
#include "lamina/scene.h"

namespace lamina::view {

struct ScreenPicture;

// Picture A, which is kept while its settings are changed; the edited picture beside it is B. When
// B's view changes, A is drawn again in that view.
struct PinnedPicture {
    std::uint64_t number = 0;  // of pins: a picture drawn again keeps it
    std::uint64_t data = 0;    // Revisions::data
    Scene scene;               // as it was asked for, in the view of `picture`
    Scene resolved;            // with everything automatic written out
    std::shared_ptr<const Image> picture;
    std::shared_ptr<const ScreenPicture> screen;
    FrameStatistics statistics;
    std::optional<double> expected;  // error, in 1/255
};

}  // namespace lamina::view
