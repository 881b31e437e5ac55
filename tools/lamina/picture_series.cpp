// SPDX-License-Identifier: Apache-2.0
#include "picture_series.h"

#include <algorithm>
#include <deque>
#include <future>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "git_commit.h"
#include "output_files.h"
#include "scene_files/scene_reader.h"

namespace lamina {
namespace {

std::vector<std::int64_t> numbers_of(const OutputOptions& options, const OutputScene& scene) {
    std::vector<std::int64_t> numbers(
        scene.cameras.empty() ? static_cast<std::size_t>(options.views) : scene.cameras.size());
    std::iota(numbers.begin(), numbers.end(), std::int64_t{0});
    return numbers;
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

bool same_grid(const Grid& a, const Grid& b) {
    return a.size == b.size && a.centering == b.centering && a.origin == b.origin &&
           a.step == b.step;
}

// Returns the files that are read: `read`, and those of all steps.
std::vector<std::filesystem::path> all_files(const DataSeries& series, const Scene& scene,
                                             std::vector<std::filesystem::path> read) {
    for (const std::int64_t step : series.steps())
        for (const auto& file : series.files_of_step(scene, step)) read.push_back(file);
    return read;
}

}  // namespace

void NumberedPictures::check(const OutputOptions& options) {
    picture_format(FrameNames(options.output).name(0), options.format);
}

NumberedPictures::NumberedPictures(const OutputOptions& options, const OutputScene& scene,
                                   std::vector<std::int64_t> numbers, const Words& words,
                                   const Paths& read, const Paths& others)
    : names_(options.output),
      format_(picture_format(names_.name(0), options.format)),
      resume_(options.resume),
      force_(options.force),
      scene_(scene),
      numbers_(std::move(numbers)),
      words_(words) {
    Paths written = others;
    for (const std::string& name : names()) written.push_back(path_of(name));
    expect_different_files(read, written);
    expect_own_folder(folder(), words_.verb, names(), read, force_);
    // Fails at once if the folder cannot be written.
    if (std::filesystem::exists(folder()))
        const AtomicFile unused(path_of(names_.record_name(words_.record)));
}

std::vector<std::string> NumberedPictures::names() const {
    std::vector<std::string> names;
    for (const std::int64_t number : numbers_) names.push_back(name_at(number));
    names.push_back(names_.record_name(words_.record));
    return names;
}

std::vector<std::filesystem::path> NumberedPictures::pictures() const {
    Paths pictures;
    for (const std::int64_t number : numbers_) pictures.push_back(path_of(name_at(number)));
    return pictures;
}

void NumberedPictures::remove_all() const {
    OwnFiles(folder(), words_.verb).remove_all();
}

// Returns a hash of the input that all pictures share; input_of() hashes the rest.
std::string NumberedPictures::key_of(const PictureAttributes& attributes) const {
    ContentHash hash;
    for (const auto& [name, text] : attributes) hash.add(text);
    const Paths own = own_files();
    for (const std::filesystem::path& file : files_of(scene_.scene)) {
        // The text of the scene file, as --set changed it, is among the attributes.
        if (file != scene_.scene.file && std::ranges::count(own, file) == 0)
            hash.add(hash_of_file(file));
    }
    hash.add(scene_.how.omissions.none ? 1.0 : 0.0);
    for (const std::string& name : scene_.how.omissions.kept) hash.add(name);
    hash.add(std::string_view(git_commit));
    add_to_key(hash);
    return hash.hex();
}

std::vector<std::int64_t> NumberedPictures::missing(const SeriesRecord& record) const {
    std::vector<std::int64_t> missing;
    for (const std::int64_t number : numbers_) {
        // Hash the input, which is slow, only if the picture exists.
        const bool there = !force_ && std::filesystem::exists(path_of(name_at(number)));
        if (!there || !record.has(name_at(number), input_of(number))) missing.push_back(number);
    }
    return missing;
}

std::string NumberedPictures::draw(Pipeline& pipeline, RunStatistics& run,
                                   PictureAttributes attributes) {
    OwnFiles(folder(), words_.verb).add(names());
    attributes["renderer"] = pipeline.statistics().renderer;
    SeriesRecord record(path_of(names_.record_name(words_.record)), key_of(attributes));
    if (resume_) record.expect_match();
    const std::vector<std::int64_t> drawn = missing(record);
    const std::size_t all = numbers_.size(), kept = all - drawn.size();
    try {
        draw_missing(drawn, record, pipeline, run, attributes);
    } catch (const Interrupted&) {
        const ClientScope scope(finishing_client());
        record.write();
        throw Interrupted(fmt::format("interrupted: {} of {} {} are there; {}",
                                      all - missing(record).size(), all, words_.pictures,
                                      scene_.goes_on));
    }
    record.write();
    run.picture.counts["kept_views"] = static_cast<std::int64_t>(kept);
    return fmt::format("{} of {} {} as {}{}{}", drawn.size(), all, words_.pictures,
                       path_of(name_at(numbers_.front())).string(),
                       all > 1 ? " .. " + name_at(numbers_.back()) : "",
                       kept > 0 ? fmt::format("; {} were there and are kept", kept) : "");
}

Turntable::Turntable(const OutputOptions& options, const OutputScene& scene, const Paths& read,
                     const Paths& others)
    : NumberedPictures(options, scene, numbers_of(options, scene),
                       scene.cameras.empty() ? Words{"render --turntable", "turntable", "views"}
                                             : Words{"render --path", "path", "views"},
                       read, others) {}

void Turntable::add_to_key(ContentHash& hash) const {
    hash.add(static_cast<double>(numbers().size()));
    for (const Camera& camera : scene().cameras) hash.add(json_text(camera_json(camera)));
}

// Returns the camera of a view. `own`: the scene's.
Camera Turntable::camera_of(const Camera& own, std::int64_t view) const {
    if (!scene().cameras.empty()) return scene().cameras[static_cast<std::size_t>(view)];
    const auto views = static_cast<double>(numbers().size());
    return view == 0 ? own : turned(own, 360.0 * static_cast<double>(view) / views);
}

void Turntable::draw_missing(const std::vector<std::int64_t>& views, SeriesRecord& record,
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
    const auto draw_view = [&](std::int64_t view) {
        check_interrupt();
        const Camera camera = camera_of(own, view);
        PictureFile file = open(view);
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
            begin_to_write(name_at(view), std::move(file), pipeline, std::move(image), attributes));
        if (view != views.front()) return;
        finish_but(0);
        run.first_picture_ms = scene().watch.milliseconds();
    };
    try {
        for (const std::int64_t view : views) draw_view(view);
        finish_but(0);
    } catch (...) {
        record_written(writing, record);
        throw;
    }
    run.picture.counts["clamped_pixels"] = clamped;
}

TimeSeries::TimeSeries(const OutputOptions& options, const OutputScene& scene,
                       const DataSeries& series, const Paths& read, const Paths& others)
    : NumberedPictures(options, scene, series.steps(), {"render --time", "series", "steps"},
                       all_files(series, scene.scene, read), others),
      series_(series) {}

TimeSeries::Paths TimeSeries::own_files() const {
    return series_.files_of_step(scene().scene, series_.steps().front());
}

// Returns a hash of the input that only this step's picture depends on.
std::string TimeSeries::input_of(std::int64_t step) const {
    check_interrupt();
    ContentHash hash;
    hash.add(static_cast<double>(step));
    for (const auto& file : series_.files_of_step(scene().scene, step))
        hash.add(hash_of_file(file));
    return hash.hex();
}

TimeSeries::Loaded TimeSeries::load(const Scene& resolved, std::int64_t step) const {
    PipelineOptions how = scene().how;
    how.adjustments = {};  // the resolved scene has their results
    auto pipeline = std::make_unique<Pipeline>(series_.at(resolved, step), SceneData(), how);
    std::string input = input_of(step);
    pipeline->load();
    return {std::move(pipeline), std::move(input)};
}

void TimeSeries::say_of_grid(Pipeline& of_step, Pipeline& first, std::int64_t step) const {
    if (first.scene().draws_mesh()) return;
    const auto grid_of = [](Pipeline& one) -> const Grid& {
        return one.data().volume(one.scene())->volume.grid();
    };
    if (same_grid(grid_of(of_step), grid_of(first))) return;
    scene().say(fmt::format(
        "step {}: its grid is not that of step {}, whose camera and settings it is drawn with",
        step, series_.steps().front()));
}

void TimeSeries::draw_step(Pipeline& pipeline, const Scene& scene, std::int64_t step,
                           RunStatistics& run, PictureAttributes& attributes) const {
    PictureFile picture = open(step);
    Image image;
    pipeline.draw(image);
    const std::int64_t clamped = run.picture.counts["clamped_pixels"];
    run.add(pipeline.statistics());
    attributes["scene"] = json_text(scene_json(scene), 2);
    attributes["renderer"] = run.picture.renderer;
    run.picture.counts["clamped_pixels"] =
        clamped + write_picture(picture, pipeline, image, attributes);
}

// Draws the steps one by one, while another thread loads the next one. The series' first step has
// been loaded by `pipeline` already.
void TimeSeries::draw_missing(const std::vector<std::int64_t>& steps, SeriesRecord& record,
                              Pipeline& pipeline, RunStatistics& run,
                              PictureAttributes& attributes) const {
    if (numbers().size() > 1 && !steps.empty()) {
        scene().say(fmt::format(
            "transfer function, camera and what is automatic are those of step {}, for all steps",
            series_.steps().front()));
    }
    Progress progress("drawing steps", static_cast<std::int64_t>(steps.size()));
    Scene resolved = pipeline.resolved_scene();
    // All steps are labels, or none.
    if (VolumeFile* const volume = resolved.volume_file(); volume && !resolved.draws_mesh())
        volume->selection.lookup = pipeline.data().volume(resolved)->volume.grid().lookup;
    if (resolved.transfer_function->of_codes()) {
        resolved.transfer_function = resolved.transfer_function->with_codes();  // of any labels
        warn(
            "labels that 16 bits do not hold are numbered anew in each step, so that a label may "
            "change its colour");
    }
    const std::int64_t first = series_.steps().front();
    std::future<Loaded> next;
    const auto read_ahead = [&](std::size_t i) {
        if (i >= steps.size() || steps[i] == first) return;
        next = std::async(std::launch::async,
                          [this, &resolved, step = steps[i], client = ClientScope::current()] {
                              const ClientScope scope(client);
                              return load(resolved, step);
                          });
    };
    read_ahead(0);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        check_interrupt();
        const std::int64_t step = steps[i];
        std::string input;
        if (step == first) {
            read_ahead(i + 1);
            input = input_of(step);
            draw_step(pipeline, resolved, step, run, attributes);
            run.first_picture_ms = scene().watch.milliseconds();
        } else {
            const Loaded loaded = next.get();
            read_ahead(i + 1);
            say_of_grid(*loaded.pipeline, pipeline, step);
            draw_step(*loaded.pipeline, loaded.pipeline->scene(), step, run, attributes);
            input = loaded.input;
        }
        record.add(name_at(step), input);
        progress.advance();
    }
}

std::string TimeSeries::draw(Pipeline& pipeline, RunStatistics& run, PictureAttributes attributes) {
    attributes["scene"] = json_text(scene_json(pipeline.resolved_scene()), 2);
    run.picture.counts["clamped_pixels"] = 0;
    return NumberedPictures::draw(pipeline, run, std::move(attributes));
}

}  // namespace lamina
