// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/report.h"
#include "lamina/scene.h"

namespace lamina::view {

// Settings that were tried, with their error and time.
struct Attempt {
    Scene scene;     // as given; drawn again when the user goes back to it
    Scene resolved;  // with everything automatic written out
    // Number, from 1, of the view (camera and size). Errors of pictures of one view are comparable.
    int view = 0;
    std::optional<double> expected;  // predicted error, in 1/255, if known
    double share_measured = 0;       // share of the pixels with a measured error, 0 to 1
    ErrorNorms error;                // of these pixels, in 1/255
    double draw_ms = 0;              // time of the picture, with choices and set-up
    double frame_ms = 0;             // part of draw_ms that each further frame takes

    // Short texts of settings of `resolved`.
    std::string method;          // "slice"
    std::string classification;  // for tets: the coloring, "preintegrated, linear"
    std::string target;          // "fixed8"
    std::string tree;            // "32x32"; empty: none
    std::string samples;         // "512"; empty: no slices
};

// Returns an attempt with the settings of the scenes; other members are unset.
Attempt attempt_of(const Scene& scene, const Scene& resolved);
// Returns the value for Attempt::frame_ms.
double frame_ms_of(const FrameStatistics& statistics);
// Returns the settings as one line: "slice, exact, fixed8, tree 32x32, 1024 slabs".
std::string short_text(const Scene& scene);

// Settings that were tried, in the order of their first trial. Drawing a scene again updates its
// row. If only the view (camera or size) changes, a row whose error is not measured on all pixels
// is updated, too; otherwise moving the camera would fill the table.
class Attempts {
  public:
    const std::vector<Attempt>& rows() const { return rows_; }
    // Returns the row of the last picture; rows() must not be empty.
    std::size_t newest() const { return newest_; }

    // Adds a full picture of the scene. `expected`: its predicted error; `statistics`: its own.
    void add(const Scene& scene, const Scene& resolved, std::optional<double> expected,
             const FrameStatistics& statistics);
    // Takes the share of the last picture's pixels that the tracer has done, and their error. It is
    // ignored while the share is smaller than one that was measured before.
    void measured(double share, const ErrorNorms& error);
    void clear();

    // Returns a table (RFC 4180) with a line for each row. Its last column is the resolved scene as
    // JSON, a scene file of the picture if data files are named.
    std::string csv() const;

    // Returns the rows with the newest row's view and settings, compared without the key that
    // `without` removes.
    std::vector<std::size_t> alike(void (*without)(Scene&)) const;

  private:
    int view_of(const Scene& scene);

    std::vector<Attempt> rows_;
    std::vector<std::string> settings_;  // of each row: its scene's text without the view
    std::size_t newest_ = 0;
    std::vector<Scene> views_;  // one scene for each view number; only camera and size count
};

}  // namespace lamina::view
