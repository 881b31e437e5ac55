// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render_output.h"
#include "series_record.h"

namespace lamina {

// Pictures of `render --turntable`: views around the camera's axis `up` through its centre, at
// equal angles over 360 degrees, beginning with the scene's own. Or of `render --path`: the views
// of the path's cameras. Views that an earlier run made from the same scene and data are kept.
class Turntable : public SeriesOutput {
  public:
    // Throws UsageError if the options give no file names or no format.
    static void check(const OutputOptions& options);

    // Throws UsageError if a picture would replace a file of `read` or one of `others`; and, unless
    // options.force, Error if a file exists that no turntable wrote.
    Turntable(const OutputOptions& options, const OutputScene& scene,
              const std::vector<std::filesystem::path>& read,
              const std::vector<std::filesystem::path>& others);

    std::string draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) override;
    std::vector<std::filesystem::path> pictures() const override;
    void remove_all() const override;

  private:
    Camera camera_of(const Camera& own, int view) const;
    std::vector<std::string> names() const;  // in the folder; the last one is the record
    std::filesystem::path folder() const { return names_.folder().empty() ? "." : names_.folder(); }
    std::filesystem::path path_of(const std::string& name) const { return names_.folder() / name; }
    std::vector<int> missing(const SeriesRecord& record) const;
    void draw_missing(const std::vector<int>& views, SeriesRecord& record, Pipeline& pipeline,
                      RunStatistics& run, PictureAttributes& attributes) const;

    FrameNames names_;
    PictureFormat format_;
    int views_;
    bool resume_, force_;
    OutputScene scene_;
    const char *verb_, *word_;  // of the options, for lists of files and for names
};

}  // namespace lamina
