// SPDX-License-Identifier: Apache-2.0
#include "image/film_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "base/client.h"
#include "base/error.h"
#include "image/apng.h"
#include "image/ffmpeg.h"
#include "image/picture.h"

namespace lamina {
namespace {

constexpr std::array formats{FilmFormat{".mp4", "libx264", false},
                             FilmFormat{".webm", "libvpx-vp9", true},
                             FilmFormat{".gif", "gif", false}, FilmFormat{".apng", nullptr, true}};

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

using Arguments = std::vector<std::string>;

Arguments joined(Arguments arguments, const Arguments& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

constexpr const char* output_file = "/proc/self/fd/3";  // first file that Ffmpeg() gets
constexpr const char* second_file = "/proc/self/fd/4";

// Lets the owner read and write an open file while this object exists: ffmpeg opens the film by its
// name in /proc, and the film may have the mode of a read-only one that it replaces.
class OwnerMayWrite {
  public:
    explicit OwnerMayWrite(int file) : file_(file) {
        struct stat found = {};
        if (fstat(file_, &found) != 0) return;
        mode_ = found.st_mode & static_cast<mode_t>(S_IRWXU | S_IRWXG | S_IRWXO);
        fchmod(file_, *mode_ | S_IRUSR | S_IWUSR);
    }
    ~OwnerMayWrite() {
        if (mode_) fchmod(file_, *mode_);
    }
    OwnerMayWrite(const OwnerMayWrite&) = delete;
    OwnerMayWrite& operator=(const OwnerMayWrite&) = delete;

  private:
    int file_;
    std::optional<mode_t> mode_;
};

}  // namespace

const FilmFormat* film_format_of(const std::string& file) {
    const auto* const found = std::ranges::find(formats, lower_suffix(file), &FilmFormat::suffix);
    return found == formats.end() ? nullptr : found;
}

FilmLook look_of_png(const std::string& png) {
    // Signature, then the chunk IHDR: length, type, width, height, depth, colour type.
    constexpr std::size_t width = 16, height = 20, color = 25, whole = 33;
    constexpr int has_alpha = 4;
    if (png.size() < whole || png.substr(1, 3) != "PNG" || png.substr(12, 4) != "IHDR")
        fail("a frame is no PNG file");
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = at; i < at + 4; ++i)
            value = value << 8 | static_cast<unsigned char>(png[i]);
        return static_cast<int>(value);
    };
    FilmLook look{number(width), number(height)};
    look.transparent = (static_cast<unsigned char>(png[color]) & has_alpha) != 0;
    return look;
}

std::optional<std::string> mistake_in_rate(const FilmFormat& format, int rate) {
    // A GIF's delays are hundredths of a second, and players take those below two for slow ones.
    constexpr int most_of_gif = 50;
    if (rate <= most_of_gif || std::string_view(format.suffix) != ".gif") return std::nullopt;
    return fmt::format("expected at most {} frames a second in a .gif, or another film",
                       most_of_gif);
}

std::optional<std::string> mistake_in_look(const FilmFormat& format, const FilmLook& look) {
    if (look.transparent && !format.alpha) {
        return fmt::format(
            "{} has no straight alpha for image.transparent, expected .webm or .apng",
            format.suffix);
    }
    const auto even = [](int pixels) { return pixels + pixels % 2; };
    const bool subsampled = std::string_view(format.suffix) == ".mp4";
    if (!subsampled || (look.width % 2 == 0 && look.height % 2 == 0)) return std::nullopt;
    return fmt::format(
        "found {} x {} pixels, expected even numbers, as in --size {}x{} (in Python size)",
        look.width, look.height, even(look.width), even(look.height));
}

FilmFile::FilmFile(const FilmFormat& format, const FilmLook& look, const std::string& name)
    : format_(format), look_(look) {
    if (format_.encoder != nullptr) ffmpeg_ = require_ffmpeg(name, format_.encoder);
}

void FilmFile::write(OutputFile& file, std::size_t frames, const Frame& frame) const {
    if (format_.encoder == nullptr) {
        AnimatedPng film(file, static_cast<std::uint32_t>(frames), look_.rate);
        for (std::size_t i = 0; i < frames; ++i) {
            check_interrupt();
            film.add(frame(i));
        }
        return film.end();
    }
    const OwnerMayWrite writable(fileno(file.stream()));
    const Arguments input{"-v",   "error", "-f",         "image2pipe",
                          "-c:v", "png",   "-framerate", std::to_string(look_.rate),
                          "-i",   "pipe:0"};
    const std::string_view suffix = format_.suffix;
    if (suffix == ".gif") return write_gif(file, input, frames, frame);
    Arguments arguments = joined(input, in_bt709(look_.transparent ? "yuva420p" : "yuv420p"));
    // Quality, about that at which an eye sees no difference, by ffmpeg's guides of both encoders.
    if (suffix == ".mp4") {
        arguments = joined(arguments, {"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart",
                                       "-f", "mp4", output_file});
    } else {
        arguments = joined(arguments, {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-cpu-used",
                                       "4", "-row-mt", "1"});
        // With alternative reference frames libvpx encodes no alpha.
        if (look_.transparent) arguments = joined(arguments, {"-auto-alt-ref", "0"});
        arguments = joined(arguments, {"-f", "webm", output_file});
    }
    run_ffmpeg(arguments, {fileno(file.stream())}, frames, frame);
}

// Makes one palette of all frames, then the film: one run would keep all frames in memory.
void FilmFile::write_gif(OutputFile& file, const Arguments& input, std::size_t frames,
                         const Frame& frame) const {
    const TemporaryFile palette;
    run_ffmpeg(joined(input, {"-vf", "palettegen=reserve_transparent=0", "-c:v", "png", "-f",
                              "image2pipe", output_file}),
               {fileno(palette.stream())}, frames, frame);
    run_ffmpeg(joined(input, {"-f", "png_pipe", "-i", second_file, "-lavfi", "paletteuse", "-loop",
                              "0", "-f", "gif", output_file}),
               {fileno(file.stream()), fileno(palette.stream())}, frames, frame);
}

void FilmFile::run_ffmpeg(const Arguments& arguments, const std::vector<int>& files,
                          std::size_t frames, const Frame& frame) const {
    Progress progress("encoding frames", static_cast<std::int64_t>(frames));
    Ffmpeg ffmpeg(ffmpeg_, arguments, files);
    for (std::size_t i = 0; i < frames; ++i) {
        ffmpeg.write(frame(i));
        progress.advance();
    }
    ffmpeg.finish();
}

}  // namespace lamina
