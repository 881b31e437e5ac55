// SPDX-License-Identifier: Apache-2.0
// Series of pictures with numbers in their names: of views, and of steps in time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/content_hash.h"
#include "data_series.h"
#include "render_output.h"
#include "series_record.h"

namespace lamina {

// Pictures of a scene with numbers in their names, and their record. Pictures that an earlier run
// made from the same scene and data are kept.
class NumberedPictures : public SeriesOutput {
  public:
    // Throws UsageError if the options give no file names or no format.
    static void check(const OutputOptions& options);

    std::string draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) override;
    std::vector<std::filesystem::path> pictures() const override;
    void remove_all() const override;

  protected:
    using Paths = std::vector<std::filesystem::path>;
    // Names of a kind of series: its verb, for lists of files; its word in the name of the record;
    // and its pictures, as in "3 of 8 views".
    struct Words {
        const char *verb, *record, *pictures;
    };

    // Throws UsageError if a picture would replace a file of `read` or one of `others`; and, unless
    // options.force, Error if a file exists that no such series wrote.
    NumberedPictures(const OutputOptions& options, const OutputScene& scene,
                     std::vector<std::int64_t> numbers, const Words& words, const Paths& read,
                     const Paths& others);

    const OutputScene& scene() const { return scene_; }
    const std::vector<std::int64_t>& numbers() const { return numbers_; }
    std::string name_at(std::int64_t number) const { return names_.name(static_cast<int>(number)); }
    PictureFile open(std::int64_t number) const { return {path_of(name_at(number)), format_}; }

  private:
    // Returns a hash of the input that only one picture depends on, of the files own_files(), too.
    virtual std::string input_of(std::int64_t /*number*/) const { return {}; }
    virtual Paths own_files() const { return {}; }
    // Adds what all pictures depend on beside the scene and its files.
    virtual void add_to_key(ContentHash& /*hash*/) const {}
    virtual void draw_missing(const std::vector<std::int64_t>& missing, SeriesRecord& record,
                              Pipeline& pipeline, RunStatistics& run,
                              PictureAttributes& attributes) const = 0;

    std::vector<std::string> names() const;  // in the folder; the last one is the record
    std::filesystem::path folder() const { return names_.folder().empty() ? "." : names_.folder(); }
    std::filesystem::path path_of(const std::string& name) const { return names_.folder() / name; }
    std::string key_of(const PictureAttributes& attributes) const;
    std::vector<std::int64_t> missing(const SeriesRecord& record) const;

    FrameNames names_;
    PictureFormat format_;
    bool resume_, force_;
    OutputScene scene_;
    std::vector<std::int64_t> numbers_;
    Words words_;
};

// Pictures of `render --turntable`: views around the camera's axis `up` through its centre, at
// equal angles over 360 degrees, beginning with the scene's own. Or of `render --path`: the views
// of the path's cameras.
class Turntable : public NumberedPictures {
  public:
    Turntable(const OutputOptions& options, const OutputScene& scene, const Paths& read,
              const Paths& others);

  private:
    void add_to_key(ContentHash& hash) const override;
    Camera camera_of(const Camera& own, std::int64_t view) const;
    void draw_missing(const std::vector<std::int64_t>& views, SeriesRecord& record,
                      Pipeline& pipeline, RunStatistics& run,
                      PictureAttributes& attributes) const override;
};

// Pictures of `render --time`: one for each step of the data, with the transfer function, camera
// and settings chosen for the first step. While a step is drawn, the next one is read.
class TimeSeries : public NumberedPictures {
  public:
    TimeSeries(const OutputOptions& options, const OutputScene& scene, const DataSeries& series,
               const Paths& read, const Paths& others);

    std::string draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) override;

  private:
    // A step that was read ahead.
    struct Loaded {
        std::unique_ptr<Pipeline> pipeline;
        std::string input;
    };

    std::string input_of(std::int64_t step) const override;
    Paths own_files() const override;
    Loaded load(const Scene& resolved, std::int64_t step) const;
    void draw_missing(const std::vector<std::int64_t>& steps, SeriesRecord& record,
                      Pipeline& pipeline, RunStatistics& run,
                      PictureAttributes& attributes) const override;
    void draw_step(Pipeline& pipeline, const Scene& scene, std::int64_t step, RunStatistics& run,
                   PictureAttributes& attributes) const;
    void say_of_grid(Pipeline& of_step, Pipeline& first, std::int64_t step) const;

    const DataSeries& series_;
};

}  // namespace lamina
