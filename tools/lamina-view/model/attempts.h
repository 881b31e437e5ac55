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
    Scene scene;     // as it was asked for: to go back to
    Scene resolved;  // with everything automatic written out
    // Camera and size of the picture, counted from 1 on: errors of one view can be compared.
    int view = 0;
    std::optional<double> expected;  // error, in 1/255, where one is known before
    double share_measured = 0;       // of the pixels, 0 to 1
    ErrorNorms error;                // of these pixels, in 1/255
    double draw_ms = 0;              // of the picture, with all that was chosen and made for it
    double frame_ms = 0;  // of that, what each further picture of the same settings takes

    // Short texts of settings of `resolved`.
    std::string method;          // "slice"
    std::string classification;  // of slices; the coloring of tets: "preintegrated, linear"
    std::string target;          // "fixed8"
    std::string tree;            // "32x32"; empty: none
    std::string samples;         // "512"; empty: no slices
};

// Returns an attempt with its settings only.
Attempt attempt_of(const Scene& scene, const Scene& resolved);
// Returns Attempt::frame_ms.
double frame_ms_of(const FrameStatistics& statistics);
// Returns the settings as one line: "slice, exact, fixed8, tree 32x32, 1024 slabs".
std::string short_text(const Scene& scene);

// Settings that have been tried, in the order of their first trial. A scene has one row, which it
// continues when it is drawn again. A row whose error is not yet measured on all pixels keeps its
// place if the view (camera or size) changes but not the settings: else moving the camera would
// fill the table.
class Attempts {
  public:
    const std::vector<Attempt>& rows() const { return rows_; }
    // The row of the last picture; none if rows() is empty.
    std::size_t newest() const { return newest_; }

    // Adds a full picture of the scene. `expected`: its predicted error; `statistics`: its own.
    void add(const Scene& scene, const Scene& resolved, std::optional<double> expected,
             const FrameStatistics& statistics);
    // Takes the share of that picture's pixels that the tracer has done, and their error. If the
    // picture was drawn again, fewer pixels than are measured already change nothing.
    void measured(double share, const ErrorNorms& error);
    void clear();

    // Returns a table (RFC 4180) with a line for each row. Its last column is the resolved scene as
    // JSON: a scene file of the same picture, for data that it can name.
    std::string csv() const;

    // Returns the rows of the newest row's view whose settings are the newest row's, except for the
    // key that `without` removes.
    std::vector<std::size_t> alike(void (*without)(Scene&)) const;

  private:
    int view_of(const Scene& scene);

    std::vector<Attempt> rows_;
    std::vector<std::string> settings_;  // of each row: its scene's text without the view
    std::size_t newest_ = 0;
    std::vector<Scene> views_;  // of which camera and size count
};

}  // namespace lamina::view
