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

// Kinds of pictures. moving: drawn during a drag, with automatic values kept and mostly fewer
// pixels; full: as `lamina render` draws it; traced: full, with some or all pixels replaced by the
// tracer.
enum class PictureKind { none, moving, full, traced };

// Pixels as a screen shows them: 8-bit sRGB codes, three for each pixel, row 0 at the top.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

// Picture A, which stays while settings are changed; the edited picture beside it is B. When B's
// view changes, A is drawn again in that view.
struct PinnedPicture {
    std::uint64_t number = 0;  // number of the pin; stays when the picture is drawn again
    std::uint64_t data = 0;    // Revisions::data
    Scene scene;               // as given, in the view of `picture`
    Scene resolved;            // with everything automatic written out
    std::shared_ptr<const Image> picture;
    std::shared_ptr<const ScreenPicture> screen;
    FrameStatistics statistics;
    std::optional<double> expected;  // predicted error, in 1/255, if known
};

// The signed difference of two pictures, in 1/255. Each pixel has the difference of the channel in
// which it is largest, or NaN if the pixel is not traced yet. Rows are from the top.
struct PictureDifference {
    int width = 0, height = 0;
    std::vector<float> e;
};

// The pictures to show. Immutable once published, and cheap to copy.
struct Shown {
    PictureKind kind = PictureKind::none;
    Revisions revisions;                                  // of the request that `screen` answers
    std::chrono::steady_clock::time_point asked_at = {};  // DrawRequest::asked_at of that request
    double moving_ms = 0;                                 // time of the last moving picture
    std::shared_ptr<const ScreenPicture> screen;
    std::optional<PointProbe> probe;    // finds visible points of the data at pixels of `screen`
    std::shared_ptr<const Image> full;  // the last full picture, of `full_revisions`
    std::shared_ptr<const ScreenPicture> full_screen;
    Revisions full_revisions;
    // Plan and statistics of `full`. `resolved` has the values of all automatic keys.
    std::shared_ptr<const Scene> resolved;
    FrameStatistics statistics;
    PlanSummary plan;
    std::string explanation;
    // Automatic keys that got another value at rest: "render.slice.samples: 300 -> 320".
    std::vector<std::string> chosen_again;

    double share_traced = 0;                    // share of traced pixels, 0 to 1
    ErrorNorms error;                           // error of `full` in the traced pixels
    std::shared_ptr<const PreciseImage> truth;  // the traced picture once it is complete
    // The full picture minus the traced one; null if no pixel is traced.
    std::shared_ptr<const PictureDifference> missed;
    double trace_error = 0;  // of the traced picture, in 1/255, estimated by the tracer

    // The pinned picture of the last request that had one, as last drawn.
    std::shared_ptr<const PinnedPicture> pinned;

    std::uint64_t frame = 0;           // counts drawn pictures, moving and full
    FrameStatistics frame_statistics;  // statistics of the last of these pictures

    // Number (Revisions::data) of the data that are loaded; 0: none.
    std::uint64_t loaded = 0;
    Grid::Bounds bounds;                              // of the data, world
    std::shared_ptr<const ValueHistogram> histogram;  // null: not counted yet
    // The scene of the request `chosen_of`, with the chosen transfer function and camera if they
    // are automatic.
    std::shared_ptr<const Scene> chosen;
    Revisions chosen_of;

    std::string activity;   // what is being done; empty: nothing
    double share_done = 0;  // share of `activity` that is done, 0 to 1
    std::vector<std::string> warnings;
    // Why the last request has no picture; empty if it has one.
    std::string failure;
    std::uint64_t failed_request = 0;  // DrawRequest::number
};

}  // namespace lamina::view
