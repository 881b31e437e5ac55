// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "data_series.h"
#include "render_output.h"
#include "series_record.h"

namespace lamina {

// Pictures of `render --time`: one for each step of the data, with the transfer function, camera
// and settings chosen for the first step. While a step is drawn, the next one is read. Pictures
// that an earlier run made from the same scene and data are kept.
class TimeSeries : public SeriesOutput {
  public:
    // Throws UsageError if the options give no file names or no format.
    static void check(const OutputOptions& options);

    // Throws as Turntable() does.
    TimeSeries(const OutputOptions& options, const OutputScene& scene, const DataSeries& series,
               const std::vector<std::filesystem::path>& read,
               const std::vector<std::filesystem::path>& others);

    std::string draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) override;
    std::vector<std::filesystem::path> pictures() const override;
    void remove_all() const override;

  private:
    // A step that was read ahead.
    struct Loaded {
        std::unique_ptr<Pipeline> pipeline;
        std::string input;
    };

    std::vector<std::string> names() const;  // in the folder; the last one is the record
    std::string name_at(std::int64_t step) const { return names_.name(static_cast<int>(step)); }
    std::filesystem::path folder() const { return names_.folder().empty() ? "." : names_.folder(); }
    std::filesystem::path path_of(const std::string& name) const { return names_.folder() / name; }
    std::string key_of(const PictureAttributes& attributes) const;
    std::string input_of(std::int64_t step) const;
    std::vector<std::int64_t> missing(const SeriesRecord& record) const;
    Loaded load(const Scene& resolved, std::int64_t step) const;
    void draw_missing(const std::vector<std::int64_t>& steps, SeriesRecord& record,
                      Pipeline& pipeline, RunStatistics& run, PictureAttributes& attributes) const;
    void draw_step(Pipeline& pipeline, const Scene& scene, std::int64_t step, RunStatistics& run,
                   PictureAttributes& attributes) const;
    void say_of_grid(Pipeline& of_step, Pipeline& first, std::int64_t step) const;

    FrameNames names_;
    PictureFormat format_;
    bool resume_, force_;
    OutputScene scene_;
    const DataSeries& series_;
};

}  // namespace lamina
