// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <new>
#include <tuple>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/output_file.h"
#include "image/apng.h"
#include "image/film_file.h"
#include "lamina/film.h"

namespace lamina {
namespace {

// A file in memory.
class MemoryFile : public OutputFile {
  public:
    MemoryFile() : OutputFile("film") {
        stream_ = open_memstream(&bytes_, &size_);
        if (stream_ == nullptr) throw std::bad_alloc();
    }
    ~MemoryFile() override {
        std::fclose(stream_);
        std::free(bytes_);
    }

    void commit() override {
        if (std::fflush(stream_) != 0) throw std::bad_alloc();
    }
    std::string text() const { return {bytes_, size_}; }  // after commit()

  private:
    char* bytes_ = nullptr;
    std::size_t size_ = 0;
};

void check_film(std::span<const std::string> frames, int rate) {
    constexpr int most_rate = 240;
    if (frames.empty()) fail("film: found no frames, expected 1 or more");
    if (rate < 1 || rate > most_rate)
        fail("film: found {} frames a second, expected 1 to {}", rate, most_rate);
}

}  // namespace

void save_film(std::span<const std::string> frames, const std::filesystem::path& file, int rate,
               std::stop_token stop, const ProgressCallback& progress) {
    check_film(frames, rate);
    const std::string name = file.string();
    const FilmFormat* const format = film_format_of(name);
    if (format == nullptr) {
        fail("{}: found the suffix \"{}\", expected {}", name, file.extension().string(),
             film_suffixes);
    }
    FilmLook look = look_of_png(frames.front());
    // ffmpeg itself would scale frames of other sizes, and drop their alpha.
    for (const std::string& frame : frames) {
        const FilmLook other = look_of_png(frame);
        if (std::tie(other.width, other.height, other.transparent) !=
            std::tie(look.width, look.height, look.transparent))
            fail("{}: its frames differ in size, or only some of them are transparent", name);
    }
    look.rate = rate;
    for (const auto& mistake : {mistake_in_rate(*format, rate), mistake_in_look(*format, look)})
        if (mistake) fail("{}: {}", name, *mistake);
    ProgressListener listener{progress};
    const ClientScope scope({.stop = std::move(stop), .progress = &listener});
    AtomicFile output(file);
    FilmFile(*format, look, name).write(output, frames.size(), [&](std::size_t i) {
        return frames[i];
    });
    output.commit();
}

std::string animated_png(std::span<const std::string> frames, int rate) {
    check_film(frames, rate);
    MemoryFile file;
    AnimatedPng film(file, static_cast<std::uint32_t>(frames.size()), rate);
    for (const std::string& frame : frames) film.add(frame);
    film.end();
    file.commit();
    return file.text();
}

}  // namespace lamina
