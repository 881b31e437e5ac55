// SPDX-License-Identifier: Apache-2.0
#include "film.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "ffmpeg.h"
#include "image/apng.h"
#include "output_files.h"
#include "series_record.h"

namespace lamina {
namespace {

constexpr std::array formats{FilmFormat{".mp4", "libx264", false},
                             FilmFormat{".webm", "libvpx-vp9", true},
                             FilmFormat{".gif", "gif", false}, FilmFormat{".apng", nullptr, true}};

const FilmFormat* format_of_film(const std::string& output) {
    std::string suffix = std::filesystem::path(output).extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](unsigned char c) { return std::tolower(c); });
    const auto* const found = std::ranges::find(formats, suffix, &FilmFormat::suffix);
    return found == formats.end() ? nullptr : found;
}

// Returns the options of the series that the film shows. Its names have a number alone, so percent
// signs in the film's name are doubled.
OutputOptions options_of_frames(const OutputOptions& film) {
    OutputOptions frames = film;
    frames.output.clear();
    for (const char c : film.output) frames.output += std::string(c == '%' ? 2 : 1, c);
    frames.output += ".frames/frame_%05d.png";
    return frames;
}

OutputScene scene_of_frames(OutputScene scene) {
    scene.goes_on = "--resume goes on";
    return scene;
}

void check_pictures(const FilmFormat& format, const std::string& name, const Scene& scene) {
    if (scene.transparent && !format.alpha) {
        throw UsageError(fmt::format(
            "-o {}: {} has no straight alpha for image.transparent, expected .webm or .apng", name,
            format.suffix));
    }
    const auto even = [](int pixels) { return pixels + pixels % 2; };
    const bool subsampled = std::string_view(format.suffix) == ".mp4";
    if (subsampled && (scene.width % 2 != 0 || scene.height % 2 != 0)) {
        throw UsageError(
            fmt::format("-o {}: found {} x {} pixels, expected even numbers, as in --size {}x{}",
                        name, scene.width, scene.height, even(scene.width), even(scene.height)));
    }
}

// Options of ffmpeg that turn RGB into limited-range Y'CbCr with the matrix of BT.709 (ffmpeg's
// default is that of BT.601), rounded exactly, and say so in the film.
std::vector<std::string> in_bt709(const char* pixels) {
    return {"-vf",
            fmt::format("scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+"
                        "full_chroma_int,format={},setparams=range=tv:color_primaries=bt709:"
                        "color_trc=bt709:colorspace=bt709",
                        pixels),
            "-color_range",
            "tv",
            "-colorspace",
            "bt709",
            "-color_primaries",
            "bt709",
            "-color_trc",
            "bt709"};
}

using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

constexpr const char* output_file = "/proc/self/fd/3";  // first file that Ffmpeg() gets
constexpr const char* second_file = "/proc/self/fd/4";

}  // namespace

bool is_film(const std::string& output) {
    return format_of_film(output) != nullptr;
}

void Film::check(const OutputOptions& options) {
    if (!options.is_series()) {
        throw UsageError(
            fmt::format("-o {}: a film has several frames, expected --turntable N, --time RANGE or "
                        "--path FILE, too",
                        options.output));
    }
    if (!options.format.empty())
        throw UsageError(fmt::format("--format {}: only with -o -", options.format));
    // A GIF's delays are hundredths of a second, and players take those below two for slow ones.
    constexpr int most_of_gif = 50;
    if (options.rate() > most_of_gif &&
        std::string(format_of_film(options.output)->suffix) == ".gif") {
        throw UsageError(fmt::format("--fps {}: expected at most {} in a .gif, or another film",
                                     options.rate(), most_of_gif));
    }
}

Film::Film(const OutputOptions& options, const OutputScene& scene, const DataSeries* series,
           const std::vector<std::filesystem::path>& read,
           std::vector<std::filesystem::path> others)
    : format_(*format_of_film(options.output)),
      name_(options.output),
      rate_(options.rate()),
      transparent_(scene.scene.transparent) {
    check_pictures(format_, name_, scene.scene);
    if (format_.encoder != nullptr) ffmpeg_ = require_ffmpeg(name_, format_.encoder);
    others.emplace_back(name_);
    const std::filesystem::path kept = name_ + ".frames";
    if (std::filesystem::exists(kept / OwnFiles::list_name) && !options.resume && !options.force) {
        fail(
            "{}: holds frames of a film that was stopped: --resume goes on with them, --force "
            "draws them anew",
            kept.string());
    }
    file_ = open_named(name_);  // fails at once if it cannot be written
    frames_ = open_series(options_of_frames(options), scene_of_frames(scene), series, read, others);
}

std::string Film::draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) {
    frames_->draw(pipeline, run, std::move(attributes));
    const std::size_t frames = frames_->pictures().size();
    try {
        encode();
    } catch (const Interrupted&) {
        throw Interrupted(
            fmt::format("interrupted: all {} frames are there; --resume goes on", frames));
    } catch (const Error& error) {
        fail("{}: {}; its frames are kept in {}.frames, with which --resume goes on", name_,
             error.what(), name_);
    }
    file_->commit();
    frames_->remove_all();
    return fmt::format("{}, {} frames, {} a second", name_, frames, rate_);
}

void Film::encode() {
    if (format_.encoder == nullptr) {
        const std::vector<std::filesystem::path> pictures = frames_->pictures();
        AnimatedPng film(*file_, static_cast<std::uint32_t>(pictures.size()), rate_);
        const OwnFilesScope own;
        for (const std::filesystem::path& picture : pictures) {
            check_interrupt();
            film.add(read_file_bytes(picture));
        }
        return film.end();
    }
    const Words input{"-v",   "error", "-f",         "image2pipe",
                      "-c:v", "png",   "-framerate", std::to_string(rate_),
                      "-i",   "pipe:0"};
    const std::string suffix = format_.suffix;
    if (suffix == ".gif") return encode_gif(input);
    Words arguments = joined(input, in_bt709(transparent_ ? "yuva420p" : "yuv420p"));
    // Quality, about that at which an eye sees no difference, by ffmpeg's guides of both encoders.
    if (suffix == ".mp4") {
        arguments = joined(arguments, {"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart",
                                       "-f", "mp4", output_file});
    } else {
        arguments = joined(arguments, {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-cpu-used",
                                       "4", "-row-mt", "1"});
        // With alternative reference frames libvpx encodes no alpha.
        if (transparent_) arguments = joined(arguments, {"-auto-alt-ref", "0"});
        arguments = joined(arguments, {"-f", "webm", output_file});
    }
    run_ffmpeg(arguments, {fileno(file_->stream())});
}

// Makes one palette of all frames, then the film: one run would keep all frames in memory.
void Film::encode_gif(const std::vector<std::string>& input) {
    const TemporaryFile palette;
    run_ffmpeg(joined(input, {"-vf", "palettegen=reserve_transparent=0", "-c:v", "png", "-f",
                              "image2pipe", output_file}),
               {fileno(palette.stream())});
    run_ffmpeg(joined(input, {"-f", "png_pipe", "-i", second_file, "-lavfi", "paletteuse", "-loop",
                              "0", "-f", "gif", output_file}),
               {fileno(file_->stream()), fileno(palette.stream())});
}

void Film::run_ffmpeg(const std::vector<std::string>& arguments, const std::vector<int>& files) {
    const std::vector<std::filesystem::path> pictures = frames_->pictures();
    Progress progress("encoding frames", static_cast<std::int64_t>(pictures.size()));
    const OwnFilesScope own;
    Ffmpeg ffmpeg(ffmpeg_, arguments, files);
    for (const std::filesystem::path& picture : pictures) {
        ffmpeg.write(read_file_bytes(picture));
        progress.advance();
    }
    ffmpeg.finish();
}

}  // namespace lamina
