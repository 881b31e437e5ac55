// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/output_file.h"
#include "lamina/film.h"

namespace lamina {

// A kind of film, by the suffix of its file.
struct FilmFormat {
    const char* suffix;
    const char* encoder;  // ffmpeg's name of it; null: lamina writes the file itself
    bool alpha;           // can be transparent
};

inline constexpr const char* film_suffixes = ".mp4, .webm, .gif or .apng";

// Returns the format of a file's name, in any case, or null if it does not end as films do.
const FilmFormat* film_format_of(const std::string& file);

// Holds for all frames of a film.
struct FilmLook {
    int width = 0, height = 0;  // pixels
    bool transparent = false;   // they have straight alpha
    int rate = frames_a_second;
};

// Returns the look of a frame, the bytes of a PNG file. Throws Error if it is none.
FilmLook look_of_png(const std::string& png);

// Return why the format holds no film of this rate or look, and what it would hold; nothing if it
// does.
std::optional<std::string> mistake_in_rate(const FilmFormat& format, int rate);
std::optional<std::string> mistake_in_look(const FilmFormat& format, const FilmLook& look);

// A film that is made of PNG files: by the program ffmpeg or, as APNG, by lamina.
class FilmFile {
  public:
    // Returns the bytes of frame number i, a PNG file.
    using Frame = std::function<std::string(std::size_t i)>;

    // Throws Error if ffmpeg or its encoder is missing. `name`: of the film, for messages.
    FilmFile(const FilmFormat& format, const FilmLook& look, const std::string& name);

    // Writes the film; each frame may be asked for twice. The caller commits the file. Throws
    // Error, Interrupted.
    void write(OutputFile& file, std::size_t frames, const Frame& frame) const;

  private:
    void write_gif(OutputFile& file, const std::vector<std::string>& input, std::size_t frames,
                   const Frame& frame) const;
    // Runs ffmpeg, which reads all frames. `files`: as Ffmpeg() takes them.
    void run_ffmpeg(const std::vector<std::string>& arguments, const std::vector<int>& files,
                    std::size_t frames, const Frame& frame) const;

    FilmFormat format_;
    FilmLook look_;
    std::filesystem::path ffmpeg_;  // the program; empty if the format needs none
};

}  // namespace lamina
