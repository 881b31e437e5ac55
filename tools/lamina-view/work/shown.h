// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lamina/error_norms.h"
#include "lamina/frame_statistics.h"
#include "lamina/grid.h"
#include "lamina/image.h"
#include "lamina/plan_summary.h"
#include "lamina/scene.h"
#include "lamina/value_histogram.h"
#include "model/revisions.h"

namespace lamina::view {

// coarse: of fewer pixels, while the camera moves; full: as `lamina render` draws it; traced: full,
// and the tracer has replaced some or all of it.
enum class PictureKind { none, coarse, full, traced };

// Pixels as a screen shows them: 8-bit codes of sRGB, three a pixel, row 0 on top.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

// What there is to see. Immutable once it is published, and cheap to copy.
struct Shown {
    PictureKind kind = PictureKind::none;
    Revisions revisions;  // of the request that the picture is of
    std::shared_ptr<const ScreenPicture> screen;
    std::shared_ptr<const Image> full;  // the last full picture, of `full_revisions`
    Revisions full_revisions;
    // Of that picture. `resolved` has everything automatic written out.
    std::shared_ptr<const Scene> resolved;
    FrameStatistics statistics;
    PlanSummary plan;
    std::string explanation;
    std::vector<std::string> chosen_again;  // automatic keys that got another value at rest

    double share_traced = 0;                    // of its pixels, 0 to 1
    ErrorNorms error;                           // of the pixels that are traced
    std::shared_ptr<const PreciseImage> truth;  // once all of them are

    // The data: of Revisions::data `loaded` (0: none yet).
    std::uint64_t loaded = 0;
    // The scene of the request `chosen_of`, with transfer function and camera as they were chosen
    // where it leaves them open.
    std::shared_ptr<const Scene> chosen;
    Revisions chosen_of;

    std::shared_ptr<const ValueHistogram> histogram;  // null: not counted yet
    Grid::Bounds bounds;                              // of the data, world

    std::string activity;  // what is being done; empty: nothing
    double share_done = 0;
    std::vector<std::string> warnings;
    // Why the last request has no picture; empty where it has. `failed`: of the request.
    std::string failure;
    Revisions failed;
};

}  // namespace lamina::view
