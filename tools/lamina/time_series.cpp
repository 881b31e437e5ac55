// SPDX-License-Identifier: Apache-2.0
#include "time_series.h"

#include <future>
#include <nlohmann/json.hpp>
#include <optional>

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

constexpr const char* series_verb = "render --time";
constexpr const char* series_word = "series";

bool same_grid(const Grid& a, const Grid& b) {
    return a.size == b.size && a.centering == b.centering && a.origin == b.origin &&
           a.step == b.step;
}

}  // namespace

void TimeSeries::check(const OutputOptions& options) {
    picture_format(FrameNames(options.output).name(0), options.format);
}

TimeSeries::TimeSeries(const OutputOptions& options, const OutputScene& scene,
                       const DataSeries& series, const std::vector<std::filesystem::path>& read,
                       const std::vector<std::filesystem::path>& others)
    : names_(options.output),
      format_(picture_format(names_.name(0), options.format)),
      resume_(options.resume),
      force_(options.force),
      scene_(scene),
      series_(series) {
    std::vector<std::filesystem::path> inputs = read, written = others;
    for (const std::int64_t step : series.steps()) {
        for (const auto& file : series.files_of_step(scene.scene, step)) inputs.push_back(file);
    }
    for (const std::string& name : names()) written.push_back(path_of(name));
    expect_different_files(inputs, written);
    expect_own_folder(folder(), series_verb, names(), inputs, force_);
    // Fails at once if the folder cannot be written.
    if (std::filesystem::exists(folder()))
        const AtomicFile unused(path_of(names_.record_name(series_word)));
}

std::vector<std::string> TimeSeries::names() const {
    std::vector<std::string> names;
    for (const std::int64_t step : series_.steps()) names.push_back(name_at(step));
    names.push_back(names_.record_name(series_word));
    return names;
}

std::vector<std::filesystem::path> TimeSeries::pictures() const {
    std::vector<std::filesystem::path> pictures;
    for (const std::int64_t step : series_.steps()) pictures.push_back(path_of(name_at(step)));
    return pictures;
}

void TimeSeries::remove_all() const {
    OwnFiles(folder(), series_verb).remove_all();
}

// Returns a hash of the input that all pictures share; input_of() hashes the rest.
std::string TimeSeries::key_of(const PictureAttributes& attributes) const {
    ContentHash hash;
    for (const auto& [name, text] : attributes) hash.add(text);
    const auto of_first = series_.files_of_step(scene_.scene, series_.steps().front());
    for (const std::filesystem::path& file : files_of(scene_.scene)) {
        // The text of the scene file, as --set changed it, is among the attributes.
        if (file != scene_.scene.file && std::ranges::count(of_first, file) == 0)
            hash.add(hash_of_file(file));
    }
    hash.add(scene_.how.omissions.none ? 1.0 : 0.0);
    for (const std::string& name : scene_.how.omissions.kept) hash.add(name);
    hash.add(std::string_view(git_commit));
    return hash.hex();
}

// Returns a hash of the input that only this step's picture depends on.
std::string TimeSeries::input_of(std::int64_t step) const {
    ContentHash hash;
    hash.add(static_cast<double>(step));
    for (const auto& file : series_.files_of_step(scene_.scene, step)) hash.add(hash_of_file(file));
    return hash.hex();
}

std::vector<std::int64_t> TimeSeries::missing(const SeriesRecord& record) const {
    std::vector<std::int64_t> steps;
    for (const std::int64_t step : series_.steps()) {
        check_interrupt();
        // Hash the input, which is slow, only if the picture exists.
        const bool there = !force_ && std::filesystem::exists(path_of(name_at(step)));
        if (!there || !record.has(name_at(step), input_of(step))) steps.push_back(step);
    }
    return steps;
}

TimeSeries::Loaded TimeSeries::load(const Scene& resolved, std::int64_t step) const {
    PipelineOptions how = scene_.how;
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
    scene_.say(fmt::format(
        "step {}: its grid is not that of step {}, whose camera and settings it is drawn with",
        step, series_.steps().front()));
}

void TimeSeries::draw_step(Pipeline& pipeline, const Scene& scene, std::int64_t step,
                           RunStatistics& run, PictureAttributes& attributes) const {
    PictureFile picture(path_of(name_at(step)), format_);
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
    Progress progress("drawing steps", static_cast<std::int64_t>(steps.size()));
    Scene resolved = pipeline.resolved_scene();
    // All steps are labels, or none.
    if (VolumeFile* const volume = resolved.volume_file(); volume && !resolved.draws_mesh())
        volume->selection.lookup = pipeline.data().volume(resolved)->volume.grid().lookup;
    if (resolved.transfer_function->of_codes()) {
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
            run.first_picture_ms = scene_.watch.milliseconds();
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
    OwnFiles(folder(), series_verb).add(names());
    attributes["renderer"] = pipeline.statistics().renderer;
    attributes["scene"] = json_text(scene_json(pipeline.resolved_scene()), 2);
    SeriesRecord record(path_of(names_.record_name(series_word)), key_of(attributes));
    if (resume_) record.expect_match();
    const std::vector<std::int64_t> steps = missing(record);
    run.picture.counts["clamped_pixels"] = 0;
    const auto all = static_cast<std::int64_t>(series_.steps().size());
    const std::int64_t kept = all - static_cast<std::int64_t>(steps.size());
    if (all > 1 && !steps.empty()) {
        scene_.say(fmt::format(
            "transfer function, camera and what is automatic are those of step {}, for all steps",
            series_.steps().front()));
    }
    try {
        draw_missing(steps, record, pipeline, run, attributes);
    } catch (const Interrupted&) {
        const ClientScope scope(finishing_client());
        record.write();
        throw Interrupted(fmt::format("interrupted: {} of {} steps are there; {}",
                                      all - static_cast<std::int64_t>(missing(record).size()), all,
                                      scene_.goes_on));
    }
    record.write();
    run.picture.counts["kept_views"] = kept;
    const std::string last = all > 1 ? " .. " + name_at(series_.steps().back()) : "";
    return fmt::format("{} of {} steps as {}{}{}", steps.size(), all,
                       path_of(name_at(series_.steps().front())).string(), last,
                       kept > 0 ? fmt::format("; {} were there and are kept", kept) : "");
}

}  // namespace lamina
