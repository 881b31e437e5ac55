// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "data_series.h"
#include "lamina/film.h"
#include "lamina/image.h"
#include "output_files.h"
#include "render/pipeline.h"
#include "render_stats.h"

namespace lamina {

// Additions of a program to the verb `render`. Each may be empty.
struct RenderExtras {
    // Throws if the program cannot draw the scene with this --context.
    std::function<void(const Scene& scene, const Auto<ContextChoice>& context)> check;
    FramesMaker make_frames;
    // Adds keys to the JSON of --stats, after the last frame.
    std::function<void(nlohmann::ordered_json&)> add_statistics;
};

CLI::App& add_render_with(CLI::App& app, const RenderExtras& extras);

using PictureAttributes = std::map<std::string, std::string>;  // name and text, for EXR files

// A picture file of `render -o`, or stdout for "-". It is opened before rendering begins, so that a
// path that cannot be written fails at once.
class PictureFile {
  public:
    // Throws Error; UsageError if the output is stdout and stdout is a terminal.
    PictureFile(const std::string& output, PictureFormat format);

    // `space`: that of image and look. Returns the number of clamped pixels (PNG).
    std::size_t write(const Image& image, const PngLook& look, const PictureAttributes& attributes,
                      ImageColorSpace space);
    // Writes a picture in double precision, which NPY keeps; the other formats round it to float32.
    std::size_t write(const PreciseImage& image, const PngLook& look,
                      const PictureAttributes& attributes, ImageColorSpace space);

  private:
    PictureFormat format_;
    std::unique_ptr<OutputFile> file_;
};

// Options of `lamina render` for its output.
struct OutputOptions {
    std::string output;               // -o; empty: no picture, "-": stdout
    std::string format;               // --format
    int frames = 0;                   // --frames; 0: none
    std::optional<double> turn_by;    // --turn-by
    double warm_up = 0;               // --warm-up, in seconds
    int views = 0;                    // --turntable; 0: none
    std::optional<std::string> time;  // --time
    std::string path;                 // --path; empty: none
    std::optional<int> fps;           // --fps
    bool resume = false;              // --resume
    bool force = false;               // --force

    bool piped() const;
    int rate() const { return fps.value_or(frames_a_second); }  // of a film
    // Returns true if the pictures' file names are numbered: there is one for each of several.
    bool is_series() const { return views > 0 || time || !path.empty(); }
    void check() const;  // throws UsageError if options contradict one another
};

void add_output_options(CLI::App& verb, OutputOptions& options);

// A scene and how to draw it. The referenced objects must outlive the output.
struct OutputScene {
    const Scene& scene;  // as read
    const PipelineOptions& how;
    const Stopwatch& watch;                            // started with the program
    std::function<void(const std::string&)> say;       // prints a message for the user
    std::vector<Camera> cameras = {};                  // of --path; empty: none
    const char* goes_on = "the same command goes on";  // what to do after an interrupt
};

// Writes the pictures of one `lamina render`.
class RenderOutput {
  public:
    virtual ~RenderOutput() = default;
    // Draws and writes the pictures, and returns a text that names them. `attributes`: those of the
    // scene's own picture, without the renderer. The pipeline must have planned.
    virtual std::string draw(Pipeline& pipeline, RunStatistics& run,
                             PictureAttributes attributes) = 0;
};

// Writes a series of pictures, from which a film can be made.
class SeriesOutput : public RenderOutput {
  public:
    virtual std::vector<std::filesystem::path> pictures() const = 0;  // in their order
    // Removes the pictures and what was kept about them, and the folder if nothing else is in it.
    virtual void remove_all() const = 0;
};

// Writes the picture that the pipeline drew last: `picture`, or the tracer's in double precision.
// Returns the number of clamped pixels.
std::int64_t write_picture(PictureFile& file, Pipeline& pipeline, const Image& picture,
                           const PictureAttributes& attributes);

// Opens the output, so that paths that cannot be written fail at once; returns null if there is
// none. `others`: further files that are written. Throws UsageError if the scene reads one of the
// written files. `series`: the steps of --time, or null; it must outlive the output.
std::unique_ptr<SeriesOutput> open_series(const OutputOptions& options, const OutputScene& scene,
                                          const DataSeries* series,
                                          const std::vector<std::filesystem::path>& read,
                                          const std::vector<std::filesystem::path>& others);
std::unique_ptr<RenderOutput> open_output(const OutputOptions& options, const OutputScene& scene,
                                          const DataSeries* series,
                                          std::vector<std::filesystem::path> others);

}  // namespace lamina
