// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "data_series.h"
#include "render_job.h"

namespace lamina {

// The options of `lamina render` that say what is written.
struct OutputOptions {
    std::string output;               // -o; empty: nothing, "-": stdout
    std::string format;               // --format
    int frames = 0;                   // --frames; 0: none
    std::optional<double> turn_by;    // --turn-by
    int views = 0;                    // --turntable; 0: none
    std::optional<std::string> time;  // --time
    bool force = false;               // --force

    bool piped() const;
    void check() const;  // throws UsageError where they contradict one another
};

void add_output_options(CLI::App& verb, OutputOptions& options);

// What is drawn; all outlives the output.
struct OutputScene {
    const Scene& scene;
    const OmissionSwitch& omissions;
    const Stopwatch& watch;  // from the start of the run
};

// The pictures that one run writes.
class RenderOutput {
  public:
    using JobMaker = std::function<std::unique_ptr<RenderJob>(const Scene&, const SceneData&)>;
    using Messages = std::function<void(const std::string&)>;

    virtual ~RenderOutput() = default;
    // Draws and writes them, and returns their names in words. `attributes`: of the scene's own
    // picture, but for the renderer. The job has planned.
    virtual std::string draw(RenderJob& job, const Plan& plan, RenderStats& stats,
                             PictureAttributes attributes) = 0;
    // Takes what the pictures of other data need, before draw(). `first`: the scene's own data.
    // `say`: to the user.
    virtual void prepare(const JobMaker& /*make_job*/, const SceneData& /*first*/,
                         const Messages& /*say*/) {}
};

// Opens the output, null where there is none: paths that cannot be written fail at once. `others`:
// files that are written, too. Throws UsageError where one of them or of the output is a file that
// the scene reads. `series`: of --time, else null; it outlives the output.
std::unique_ptr<RenderOutput> open_output(const OutputOptions& options, const OutputScene& scene,
                                          const DataSeries* series,
                                          std::vector<std::filesystem::path> others);

}  // namespace lamina
