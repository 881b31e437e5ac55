// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "image/film_file.h"
#include "render_output.h"

namespace lamina {

// Returns true if the name of an output has the suffix of a film.
bool is_film(const std::string& output);

// Film of `render -o film.mp4`: the pictures of a series, which are drawn as PNG into the folder
// film.mp4.frames, then encoded by the program ffmpeg or, as APNG, by lamina. The folder goes when
// the film is whole; after a stop it stays, for --resume.
class Film : public RenderOutput {
  public:
    // Throws UsageError if the options name no series.
    static void check(const OutputOptions& options);

    // Throws UsageError if the format cannot hold the pictures or the film would replace a file
    // that is read; Error if ffmpeg or its encoder is missing, or frames of a stopped film are
    // there and neither --resume nor --force is given.
    Film(const OutputOptions& options, const OutputScene& scene, const DataSeries* series,
         const std::vector<std::filesystem::path>& read, std::vector<std::filesystem::path> others);

    std::string draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) override;

  private:
    std::string name_;
    int rate_;
    std::optional<FilmFile> film_;
    std::unique_ptr<SeriesOutput> frames_;
    std::unique_ptr<OutputFile> file_;
};

}  // namespace lamina
