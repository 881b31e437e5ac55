// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/report.h"
#include "lamina/sampling.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "model/document.h"

namespace lamina::view {

// moving: drawn while something is dragged, with the automatic values kept, and mostly of fewer
// pixels; full: as `lamina render` draws it; traced: full, and the tracer has replaced some or all
// of it.
enum class PictureKind { none, moving, full, traced };

// Pixels as a screen shows them: 8-bit codes of sRGB, three a pixel, row 0 on top.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

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

// The signed difference of two pictures, in 1/255: of each pixel that of the channel in which it is
// largest. NaN: not known (not traced yet). Row by row from the top.
struct PictureDifference {
    int width = 0, height = 0;
    std::vector<float> e;
};

// The pictures to show. Immutable once published, and cheap to copy.
struct Shown {
    PictureKind kind = PictureKind::none;
    Revisions revisions;                                  // of the request that the picture is of
    std::chrono::steady_clock::time_point asked_at = {};  // of that request
    double moving_ms = 0;                                 // what the last moving picture took
    std::shared_ptr<const ScreenPicture> screen;
    std::optional<PointProbe> probe;    // for the picture: places are pixels of its scene
    std::shared_ptr<const Image> full;  // the last full picture, of `full_revisions`
    std::shared_ptr<const ScreenPicture> full_screen;
    Revisions full_revisions;
    // Plan and statistics of that picture. `resolved` has the values of all automatic keys.
    std::shared_ptr<const Scene> resolved;
    FrameStatistics statistics;
    PlanSummary plan;
    std::string explanation;
    // Automatic keys that got another value at rest: "render.slice.samples: 300 -> 320".
    std::vector<std::string> chosen_again;

    double share_traced = 0;                    // of its pixels, 0 to 1
    ErrorNorms error;                           // of the pixels that are traced
    std::shared_ptr<const PreciseImage> truth;  // once all of them are
    // The full picture less the truth, as far as it is traced; null: nothing is.
    std::shared_ptr<const PictureDifference> missed;
    double trace_error = 0;  // of that, in 1/255, as the tracer estimates it

    // The pinned picture of the last request that had one, as it was drawn last.
    std::shared_ptr<const PinnedPicture> pinned;

    std::uint64_t frame = 0;           // counts pictures that were drawn, moving and full ones
    FrameStatistics frame_statistics;  // of the last of them

    // The data: of Revisions::data `loaded` (0: none yet).
    std::uint64_t loaded = 0;
    Grid::Bounds bounds;                              // of the data, world
    std::shared_ptr<const ValueHistogram> histogram;  // null: not counted yet
    // The scene of the request `chosen_of`, with the transfer function and camera that were chosen
    // if it leaves them open.
    std::shared_ptr<const Scene> chosen;
    Revisions chosen_of;

    std::string activity;  // what is being done; empty: nothing
    double share_done = 0;
    std::vector<std::string> warnings;
    // Reason why a request has no picture; empty if the last one has.
    std::string failure;
    std::uint64_t failed_request = 0;  // DrawRequest::number
};

}  // namespace lamina::view
