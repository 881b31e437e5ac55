// SPDX-License-Identifier: Apache-2.0
#include "turntable.h"

#include <algorithm>
#include <deque>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "git_commit.h"
#include "output_files.h"
#include "scene_files/scene_reader.h"

namespace lamina {
namespace {

// Returns a hash of everything that the pictures depend on.
std::string key_of(const OutputScene& of, const PictureAttributes& attributes, int views) {
    ContentHash hash;
    for (const auto& [name, text] : attributes) hash.add(text);
    for (const std::filesystem::path& file : files_of(of.scene)) {
        // The text of the scene file, as --set changed it, is among the attributes.
        if (file != of.scene.file) hash.add(hash_of_file(file));
    }
    hash.add(of.how.omissions.none ? 1.0 : 0.0);
    for (const std::string& name : of.how.omissions.kept) hash.add(name);
    hash.add(std::string_view(git_commit));
    hash.add(static_cast<double>(views));
    for (const Camera& camera : of.cameras) hash.add(json_text(camera_json(camera)));
    return hash.hex();
}

// Returns the text of the scene with a view's camera, for the picture's attributes.
std::string scene_text_of(const std::string& scene, const Camera& camera) {
    nlohmann::json document = parse_json(scene);
    document["camera"] = camera_json(camera);
    return json_text(document, 2);
}

// Returns the number of pictures that are written at once, each by a thread, while the next one is
// drawn: one thread takes longer to encode a picture than many cores or a GPU take to draw it. The
// pictures take at most 256 MiB, or there is one.
std::size_t most_written_at_once(const Scene& scene) {
    const double bytes = 4.0 * sizeof(double) * scene.width * scene.height;
    const double threads = std::clamp(std::thread::hardware_concurrency(), 1u, 16u);
    return static_cast<std::size_t>(std::clamp(0x1p28 / bytes, 1.0, threads));
}

// A picture that another thread writes.
struct PictureBeingWritten {
    std::string name;
    std::future<std::int64_t> clamped;  // its clamped pixels, once it is there
};

// Waits for pictures after an error, and records those that are complete. Their own errors count
// less than the one that ended the others.
void record_written(std::deque<PictureBeingWritten>& writing, SeriesRecord& record) {
    const ClientScope scope(finishing_client());
    for (PictureBeingWritten& picture : writing) {
        try {
            picture.clamped.get();
            record.add(picture.name);
        } catch (const std::exception&) {  // Error, or Interrupted
        }
    }
}

// Begins to write the picture that the pipeline drew last.
PictureBeingWritten begin_to_write(std::string name, PictureFile file, Pipeline& pipeline,
                                   Image picture, const PictureAttributes& attributes) {
    const auto begin = [&](auto image) {
        return std::async(std::launch::async, [file = std::move(file), image = std::move(image),
                                               attributes, look = pipeline.scene().png_look(),
                                               space = pipeline.scene().color_space,
                                               client = ClientScope::current()]() mutable {
            const ClientScope scope(std::move(client));
            return static_cast<std::int64_t>(file.write(image, look, attributes, space));
        });
    };
    const bool traced = pipeline.scene().method == Method::trace;
    return {std::move(name), traced ? begin(pipeline.traced()->image) : begin(std::move(picture))};
}

}  // namespace

void Turntable::check(const OutputOptions& options) {
    picture_format(FrameNames(options.output).name(0), options.format);
}

Turntable::Turntable(const OutputOptions& options, const OutputScene& scene,
                     const std::vector<std::filesystem::path>& read,
                     const std::vector<std::filesystem::path>& others)
    : names_(options.output),
      format_(picture_format(names_.name(0), options.format)),
      views_(scene.cameras.empty() ? options.views : static_cast<int>(scene.cameras.size())),
      resume_(options.resume),
      force_(options.force),
      scene_(scene),
      verb_(scene.cameras.empty() ? "render --turntable" : "render --path"),
      word_(scene.cameras.empty() ? "turntable" : "path") {
    std::vector<std::filesystem::path> written = others;
    for (const std::string& name : names()) written.push_back(path_of(name));
    expect_different_files(read, written);
    expect_own_folder(folder(), verb_, names(), read, force_);
    // Fails at once if the folder cannot be written.
    if (std::filesystem::exists(folder()))
        const AtomicFile unused(path_of(names_.record_name(word_)));
}

std::vector<std::string> Turntable::names() const {
    std::vector<std::string> names;
    for (int view = 0; view < views_; ++view) names.push_back(names_.name(view));
    names.push_back(names_.record_name(word_));
    return names;
}

std::vector<std::filesystem::path> Turntable::pictures() const {
    std::vector<std::filesystem::path> pictures;
    for (int view = 0; view < views_; ++view) pictures.push_back(path_of(names_.name(view)));
    return pictures;
}

void Turntable::remove_all() const {
    OwnFiles(folder(), verb_).remove_all();
}

// Returns the camera of a view. `own`: the scene's.
Camera Turntable::camera_of(const Camera& own, int view) const {
    if (!scene_.cameras.empty()) return scene_.cameras[static_cast<std::size_t>(view)];
    return view == 0 ? own : turned(own, 360.0 * view / views_);
}

std::vector<int> Turntable::missing(const SeriesRecord& record) const {
    std::vector<int> views;
    for (int view = 0; view < views_; ++view) {
        if (force_ || !record.has(names_.name(view))) views.push_back(view);
    }
    return views;
}

void Turntable::draw_missing(const std::vector<int>& views, SeriesRecord& record,
                             Pipeline& pipeline, RunStatistics& run,
                             PictureAttributes& attributes) const {
    Progress progress("drawing views", static_cast<std::int64_t>(views.size()));
    const std::string scene_text = attributes.at("scene");
    const Camera own = *pipeline.scene().camera;
    std::int64_t clamped = 0;
    std::deque<PictureBeingWritten> writing;
    const std::size_t most = most_written_at_once(pipeline.scene());
    const auto finish_but = [&](std::size_t count) {
        while (writing.size() > count) {
            PictureBeingWritten first = std::move(writing.front());
            writing.pop_front();
            clamped += first.clamped.get();
            record.add(first.name);
            progress.advance();
        }
    };
    const auto draw_view = [&](int view) {
        check_interrupt();
        const std::string name = names_.name(view);
        const Camera camera = camera_of(own, view);
        PictureFile file(path_of(name), format_);
        pipeline.set_camera(camera);
        Image image;
        if (view == views.front())
            pipeline.draw(image);
        else
            pipeline.draw_quietly(image);
        run.add(pipeline.statistics());
        attributes["scene"] = scene_text_of(scene_text, camera);
        attributes["renderer"] = run.picture.renderer;
        finish_but(most - 1);
        writing.push_back(
            begin_to_write(name, std::move(file), pipeline, std::move(image), attributes));
        if (view != views.front()) return;
        finish_but(0);
        run.first_picture_ms = scene_.watch.milliseconds();
    };
    try {
        for (const int view : views) draw_view(view);
        finish_but(0);
    } catch (...) {
        record_written(writing, record);
        throw;
    }
    run.picture.counts["clamped_pixels"] = clamped;
}

std::string Turntable::draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) {
    OwnFiles(folder(), verb_).add(names());
    attributes["renderer"] = pipeline.statistics().renderer;
    SeriesRecord record(path_of(names_.record_name(word_)), key_of(scene_, attributes, views_));
    if (resume_) record.expect_match();
    const std::vector<int> views = missing(record);
    try {
        draw_missing(views, record, pipeline, run, attributes);
    } catch (const Interrupted&) {
        const ClientScope scope(finishing_client());
        record.write();
        const auto missing_now = static_cast<int>(missing(record).size());
        throw Interrupted(fmt::format("interrupted: {} of {} views are there; {}",
                                      views_ - missing_now, views_, scene_.goes_on));
    }
    record.write();
    const int drawn = static_cast<int>(views.size()), kept = views_ - drawn;
    run.picture.counts["kept_views"] = kept;
    const std::string written =
        fmt::format("{} of {} views as {}", drawn, views_, path_of(names_.name(0)).string());
    const std::string last = views_ > 1 ? " .. " + names_.name(views_ - 1) : "";
    return written + last + (kept > 0 ? fmt::format("; {} were there and are kept", kept) : "");
}

}  // namespace lamina
