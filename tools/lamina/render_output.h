// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "data_series.h"
#include "lamina/image.h"
#include "output_files.h"
#include "render/pipeline.h"
#include "render_stats.h"

namespace lamina {

// Additions of a program to the verb `render`; all of them may be empty.
struct RenderExtras {
    // Throws if the program cannot draw the scene with that --context.
    std::function<void(const Scene& scene, const Auto<ContextChoice>& context)> check;
    FramesMaker make_frames;
    // Adds to what --stats writes, after the last frame.
    std::function<void(nlohmann::ordered_json&)> add_statistics;
};

CLI::App& add_render_with(CLI::App& app, const RenderExtras& extras);

using PictureAttributes = std::map<std::string, std::string>;  // of an EXR file

// A picture that `render -o` writes: a file, or stdout for "-". Made before rendering begins, so
// that a path that cannot be written fails at once.
class PictureFile {
  public:
    // Throws Error, and UsageError if stdout is a terminal.
    PictureFile(const std::string& output, PictureFormat format);

    // `space`: of image and background. Returns how many pixels had to be clamped (PNG).
    std::size_t write(const Image& image, const glm::dvec3& background,
                      const PictureAttributes& attributes, ImageColorSpace space);
    // Writes a picture in double precision, which NPY keeps.
    std::size_t write(const PreciseImage& image, const glm::dvec3& background,
                      const PictureAttributes& attributes, ImageColorSpace space);

  private:
    PictureFormat format_;
    std::unique_ptr<OutputFile> file_;
};

// Options of `lamina render` for its output.
struct OutputOptions {
    std::string output;               // -o; empty: nothing, "-": stdout
    std::string format;               // --format
    int frames = 0;                   // --frames; 0: none
    std::optional<double> turn_by;    // --turn-by
    int views = 0;                    // --turntable; 0: none
    std::optional<std::string> time;  // --time
    bool force = false;               // --force

    bool piped() const;
    void check() const;  // throws UsageError if they contradict one another
};

void add_output_options(CLI::App& verb, OutputOptions& options);

// A scene to be drawn, with the settings of drawing. All of it outlives the output.
struct OutputScene {
    const Scene& scene;  // as it was read
    const PipelineOptions& how;
    const Stopwatch& watch;                       // from the start of the run
    std::function<void(const std::string&)> say;  // to the user
};

// The pictures that one run writes.
class RenderOutput {
  public:
    virtual ~RenderOutput() = default;
    // Draws and writes the pictures, and returns their names in words. `attributes`: those of the
    // scene's own picture, except for the renderer. The pipeline has planned.
    virtual std::string draw(Pipeline& pipeline, RunStatistics& run,
                             PictureAttributes attributes) = 0;
};

// Writes the picture that the pipeline has drawn last: `picture`, or the tracer's, in double
// precision. Returns the number of pixels that were clamped.
std::int64_t write_picture(PictureFile& file, Pipeline& pipeline, const Image& picture,
                           const PictureAttributes& attributes);

// Opens the output, null if there is none: paths that cannot be written fail at once. `others`:
// files that are written, too. Throws UsageError if one of them or of the output is a file that
// the scene reads. `series`: of --time, else null; it outlives the output.
std::unique_ptr<RenderOutput> open_output(const OutputOptions& options, const OutputScene& scene,
                                          const DataSeries* series,
                                          std::vector<std::filesystem::path> others);

}  // namespace lamina
