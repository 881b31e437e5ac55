// SPDX-License-Identifier: Apache-2.0
#include "render_output.h"

#include <fmt/format.h>
#include <unistd.h>

#include <type_traits>

#include "base/client.h"
#include "base/error.h"
#include "base/profile.h"
#include "film.h"
#include "image/exr.h"
#include "image/npy.h"
#include "image/png.h"
#include "picture_series.h"

namespace lamina {
namespace {

// Checks a number as CLI::Range does, with a message of lamina's form.
template <typename Number>
CLI::Validator within(Number least, Number most) {
    const auto check = [=](const std::string& text) -> std::string {
        if (CLI::Range(least, most)(text).empty()) return {};
        return fmt::format("found {}, expected a {} from {:.9g} to {:.9g}", shortened(text),
                           std::is_integral_v<Number> ? "whole number" : "number",
                           static_cast<double>(least), static_cast<double>(most));
    };
    return {check, "", ""};
}

std::unique_ptr<OutputFile> open_file(const std::string& output) {
    if (output == standard_stream && isatty(STDOUT_FILENO) != 0)
        throw UsageError("-o -: stdout is a terminal, expected a pipe or a file");
    return open_named(output);
}

template <typename Real>
void warn_of_annotations(const RgbaImage<Real>& image) {
    if (image.annotations != nullptr)
        warn("image.annotations: NPY holds the picture's numbers alone; PNG and EXR have them");
}

// Output of one picture: the scene's own. With --frames it also times further frames.
class SinglePicture : public RenderOutput {
  public:
    SinglePicture(const OutputOptions& options, const OutputScene& scene)
        : name_(options.piped() ? "stdout" : options.output),
          frames_(options.frames),
          degrees_(options.turn_by.value_or(degrees_per_frame)),
          warm_up_(options.warm_up),
          scene_(scene),
          picture_(options.output, picture_format(options.output, options.format)) {}

    std::string draw(Pipeline& pipeline, RunStatistics& run,
                     PictureAttributes attributes) override {
        Image image;
        pipeline.draw(image);
        run.add(pipeline.statistics());
        run.first_picture_ms = scene_.watch.milliseconds();
        if (frames_ > 0) time_frames(pipeline, run);
        Stage writing("write");
        attributes["renderer"] = run.picture.renderer;
        run.picture.counts["clamped_pixels"] = write_picture(picture_, pipeline, image, attributes);
        run.picture.stages_ms["write"] = writing.end();
        // The picture is the first frame, so writing it counts in first_picture_ms.
        run.first_picture_ms += run.picture.stages_ms["write"];
        return name_;
    }

  private:
    // Times frames_ frames, between which the camera turns, after warm_up_ seconds of others.
    void time_frames(Pipeline& pipeline, RunStatistics& run) const {
        const auto current = pipeline.make_current();
        run.frames_ms.clear();  // the scene's own frame was the warm-up
        const Camera own = *pipeline.scene().camera;
        int turns = 0;
        const auto draw_next = [&] {
            check_interrupt();
            pipeline.set_camera(turned(own, degrees_ * ++turns));
            pipeline.draw_frame();
        };
        for (const Stopwatch warming; warming.seconds() < warm_up_;) draw_next();
        Progress progress("timing frames", frames_);
        for (int i = 1; i <= frames_; ++i) {
            Stage frame("frame");
            frame.count("frame", i);
            draw_next();
            run.frames_ms.push_back(frame.end());
            progress.advance();
        }
    }

    std::string name_;
    int frames_;
    double degrees_, warm_up_;
    OutputScene scene_;
    PictureFile picture_;
};

}  // namespace

PictureFile::PictureFile(const std::string& output, PictureFormat format)
    : format_(format), file_(open_file(output)) {}

std::size_t PictureFile::write(const Image& image, const PngLook& look,
                               const PictureAttributes& attributes, ImageColorSpace space) {
    std::size_t clamped = 0;
    switch (format_) {
        case PictureFormat::exr:
            write_exr(*file_, image, attributes, space);
            break;
        case PictureFormat::png:
            clamped = write_png(*file_, image, look, space);
            break;
        case PictureFormat::npy:
            warn_of_annotations(image);
            write_npy(*file_, image);
            break;
    }
    file_->commit();
    return clamped;
}

std::size_t PictureFile::write(const PreciseImage& image, const PngLook& look,
                               const PictureAttributes& attributes, ImageColorSpace space) {
    if (format_ != PictureFormat::npy) return write(to_float(image), look, attributes, space);
    warn_of_annotations(image);
    write_npy(*file_, image);
    file_->commit();
    return 0;
}

bool OutputOptions::piped() const {
    return output == standard_stream;
}

void OutputOptions::check() const {
    if (views > 0 && frames > 0) throw UsageError("--turntable and --frames: expected one of them");
    if (views > 0 && output.empty()) throw UsageError("--turntable: expected -o FILE, too");
    if (time && (views > 0 || frames > 0))
        throw UsageError("--time: expected neither --turntable nor --frames beside it");
    if (time) time_range(*time);  // throws UsageError
    if (!path.empty() && output.empty()) throw UsageError("--path: expected -o FILE, too");
    if (!path.empty() && (views > 0 || frames > 0 || time))
        throw UsageError("--path: expected neither --turntable, --time nor --frames beside it");
    if (force && !is_series())
        throw UsageError("--force: expected --turntable N, --time or --path, too");
    const bool film = is_film(output);
    if (fps && !film && path.empty())
        throw UsageError("--fps: expected --path FILE, or a film as in -o film.mp4, too");
    if (resume && !film) throw UsageError("--resume: expected a film as in -o film.mp4, too");
    if (resume && force) throw UsageError("--resume and --force: expected one of them");
    if (turn_by && frames == 0) throw UsageError("--turn-by: expected --frames N, too");
    if (warm_up > 0 && frames == 0) throw UsageError("--warm-up: expected --frames N, too");
    if (!format.empty() && output.empty()) throw UsageError("--format: expected -o -, too");
    if (film) {
        Film::check(*this);
    } else if (views > 0 || !path.empty() || (!output.empty() && time)) {
        NumberedPictures::check(*this);
    } else if (!output.empty()) {
        picture_format(output, format);
    }
}

void add_output_options(CLI::App& verb, OutputOptions& options) {
    constexpr int most_frames = 1000000, most_views = 100000;
    verb.add_option("-o,--output", options.output,
                    "Picture to write: .exr, .png or .npy; - writes to stdout, for a pipe. Film of "
                    "--turntable, --time or --path: .mp4, .webm or .gif, by the program ffmpeg, or "
                    ".apng")
        ->option_text("FILE");
    verb.add_option("--format", options.format, "With -o -: png, exr or npy")
        ->option_text("png|exr|npy");
    verb.add_option("--frames", options.frames,
                    "Time this many frames, the camera turning a little")
        ->check(within(1, most_frames))
        ->option_text("N");
    verb.add_option("--turn-by", options.turn_by,
                    fmt::format("With --frames: turn the camera by this from frame to frame, "
                                "-180 to 180; {} by default. 10 shows what frames take whose views "
                                "have little in common",
                                degrees_per_frame))
        ->check(within(-180.0, 180.0))
        ->option_text("DEGREES");
    verb.add_option("--warm-up", options.warm_up,
                    "With --frames: first draw frames for this long that are not timed, until a "
                    "GPU's clock has risen")
        ->check(within(0.0, 3600.0))
        ->option_text("SECONDS");
    verb.add_option("--turntable", options.views,
                    "Write this many views around the camera's centre, from -o out_%04d.png; views "
                    "that are there from an earlier run of the same scene are kept")
        ->check(within(1, most_views))
        ->option_text("N");
    verb.add_option(
            "--time", options.time,
            "Write a picture of each of these steps, as out_%04d.png: of files with a number "
            "in their name (head_%04d.nrrd), of a .pvd, or of a file with several times; all "
            "look as the first does, and those that are there from an earlier run are kept")
        ->option_text("FIRST:LAST[:STEP]");
    verb.add_option("--path", options.path,
                    "Write views along a camera path (JSON: keyframes with times and cameras), "
                    "--fps of them a second, as a film or as out_%04d.png")
        ->option_text("FILE");
    verb.add_option("--fps", options.fps, "Frames a second, of films and of --path; 25 by default")
        ->check(within(1, 240))
        ->option_text("N");
    verb.add_flag("--resume", options.resume,
                  "Go on with a film that was stopped: keep the frames that are there");
    verb.add_flag(
        "--force", options.force,
        "With --turntable, --time and --path: draw pictures that are there, too, and replace "
        "files that it did not write, but never one that it reads");
}

std::int64_t write_picture(PictureFile& file, Pipeline& pipeline, const Image& picture,
                           const PictureAttributes& attributes) {
    const Scene& scene = pipeline.scene();
    const auto write = [&](const auto& image) {
        return static_cast<std::int64_t>(
            file.write(image, scene.png_look(), attributes, scene.color_space));
    };
    return scene.method == Method::trace ? write(pipeline.traced()->image) : write(picture);
}

std::unique_ptr<SeriesOutput> open_series(const OutputOptions& options, const OutputScene& scene,
                                          const DataSeries* series,
                                          const std::vector<std::filesystem::path>& read,
                                          const std::vector<std::filesystem::path>& others) {
    if (series != nullptr)
        return std::make_unique<TimeSeries>(options, scene, *series, read, others);
    return std::make_unique<Turntable>(options, scene, read, others);
}

std::unique_ptr<RenderOutput> open_output(const OutputOptions& options, const OutputScene& scene,
                                          const DataSeries* series,
                                          std::vector<std::filesystem::path> others) {
    std::vector<std::filesystem::path> read = files_of(scene.scene);
    if (!options.path.empty()) read.emplace_back(options.path);
    if (is_film(options.output))
        return std::make_unique<Film>(options, scene, series, read, std::move(others));
    if (options.is_series() && !options.output.empty())
        return open_series(options, scene, series, read, others);
    others.emplace_back(options.output);
    expect_different_files(read, others);
    if (options.output.empty()) return nullptr;
    return std::make_unique<SinglePicture>(options, scene);
}

}  // namespace lamina
