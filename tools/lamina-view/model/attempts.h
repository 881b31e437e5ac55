// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/attempt.h"

namespace lamina::view {

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
