// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <stop_token>
#include <string>

#include "lamina/error.h"

namespace lamina {

inline constexpr int frames_a_second = 25;  // of films, unless something else is asked for

// Writes a film of these frames, PNG files of one size and kind (picture_png()), as `lamina render`
// does (docs/films.md): .mp4, .webm and .gif by the program ffmpeg, .apng without it. Frames with
// alpha make a transparent film. The film appears under its name when it is complete. Throws Error
// for other suffixes, for frames that the format cannot hold, and if the file cannot be written;
// Interrupted once a stop is requested.
LAMINA_API void save_film(std::span<const std::string> frames, const std::filesystem::path& file,
                          int rate = frames_a_second, std::stop_token stop = {},
                          const ProgressCallback& progress = {});

// Returns the bytes of the .apng file that save_film() writes.
LAMINA_API std::string animated_png(std::span<const std::string> frames,
                                    int rate = frames_a_second);

}  // namespace lamina
