// SPDX-License-Identifier: Apache-2.0
#include "film.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "output_files.h"
#include "series_record.h"

namespace lamina {
namespace {

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

}  // namespace

bool is_film(const std::string& output) {
    return film_format_of(output) != nullptr;
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
    if (const auto mistake = mistake_in_rate(*film_format_of(options.output), options.rate()))
        throw UsageError(fmt::format("--fps {}: {}", options.rate(), *mistake));
}

Film::Film(const OutputOptions& options, const OutputScene& scene, const DataSeries* series,
           const std::vector<std::filesystem::path>& read,
           std::vector<std::filesystem::path> others)
    : name_(options.output), rate_(options.rate()) {
    const FilmFormat& format = *film_format_of(name_);
    const FilmLook look{scene.scene.width, scene.scene.height, scene.scene.transparent, rate_};
    if (const auto mistake = mistake_in_look(format, look))
        throw UsageError(fmt::format("-o {}: {}", name_, *mistake));
    film_.emplace(format, look, "-o " + name_);
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
    const auto exists = [](const auto& path) { return std::filesystem::exists(path); };
    const auto some_are_there = [&] { return std::ranges::any_of(frames_->pictures(), exists); };
    try {
        frames_->draw(pipeline, run, std::move(attributes));
    } catch (const Interrupted&) {
        if (some_are_there()) throw;
        const ClientScope scope(finishing_client());
        // Frees the name: the same command would ask for --resume otherwise.
        if (exists(name_ + ".frames")) frames_->remove_all();
        throw Interrupted("interrupted, nothing written");
    } catch (const Error& error) {
        if (!some_are_there()) throw;
        fail("{}; the frames that are there are kept in {}.frames, with which --resume goes on",
             error.what(), name_);
    }
    const std::size_t frames = frames_->pictures().size();
    try {
        film_->write(*file_, frames, [pictures = frames_->pictures()](std::size_t i) {
            const OwnFilesScope own;
            return read_file_bytes(pictures[i]);
        });
    } catch (const Interrupted&) {
        throw Interrupted(
            fmt::format("interrupted: all {} frames are there; --resume goes on", frames));
    } catch (const Error& error) {
        fail("{}: {}; its frames are kept in {}.frames, with which --resume goes on", name_,
             error.what(), name_);
    }
    file_->commit();
    frames_->remove_all();
    return fmt::format("{}, {} frame{}, {} a second", name_, frames, frames == 1 ? "" : "s", rate_);
}

}  // namespace lamina
