// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/process.h"
#include "base/profile.h"
#include "data_series.h"
#include "output_files.h"
#include "render/draw_context.h"
#include "render/pipeline.h"
#include "render_output.h"
#include "render_stats.h"
#include "scene_files/camera_path.h"
#include "scene_files/scene_reader.h"
#include "shared_options.h"
#include "verbs.h"

namespace lamina {
namespace {

using Json = nlohmann::ordered_json;

constexpr int process = 1;

Json metadata(const char* name, int row, const char* key, const Json& value) {
    return {{"name", name}, {"ph", "M"}, {"pid", process}, {"tid", row}, {"args", {{key, value}}}};
}

std::string name_of_row(int row) {
    if (row == Profile::opengl_row) return "OpenGL";
    if (row == Profile::first_row) return "main thread";
    return fmt::format("worker {}", row - Profile::first_row);
}

double microseconds(std::int64_t nanoseconds) {
    return 1e-3 * static_cast<double>(nanoseconds);
}

Json counts_of(const Profile::Span& span) {
    Json counts = Json::object();
    for (const Profile::Count& count : span.counts) {
        if (count.name != nullptr) counts[count.name] = count.value;
    }
    return counts;
}

Json event(const Profile::Span& span, std::int64_t start_ns) {
    return {{"name", span.name},
            {"ph", "X"},
            {"pid", process},
            {"tid", span.row},
            {"ts", microseconds(span.begin_ns - start_ns)},
            {"dur", microseconds(span.end_ns - span.begin_ns)},
            {"args", counts_of(span)}};
}

// A profile of the program, from this object's construction, as a file in Chrome's trace event
// format for Perfetto and chrome://tracing.
class ProfileFile {
  public:
    explicit ProfileFile(const std::string& name) : file_(open_named(name)) {}

    // Writes the file. `title`: name of the process in it; `context`: what draws. Returns the
    // number of spans that were not kept because there were too many; the file has it, too.
    std::int64_t write(const std::string& title, const std::string& context);

  private:
    std::unique_ptr<OutputFile> file_;
    Profile profile_;
    std::int64_t start_ns_ = Stopwatch::now();
};

std::int64_t ProfileFile::write(const std::string& title, const std::string& context) {
    Json other{{"context", context}};
    if (profile_.spans_left_out() > 0) other["spans_left_out"] = profile_.spans_left_out();
    file_->write("{\"displayTimeUnit\":\"ms\",\"otherData\":" + json_text(other) +
                 ",\"traceEvents\":[\n");
    // Events are written one by one: one JSON document of all would take twenty times the spans'
    // memory.
    file_->write(json_text(metadata("process_name", Profile::first_row, "name", title)));
    const auto write_event = [&](const Json& event) { file_->write(",\n" + json_text(event)); };
    const auto has_spans = [&](int row) {
        return std::ranges::any_of(profile_.spans(),
                                   [&](const Profile::Span& span) { return span.row == row; });
    };
    for (int row = 0; row < profile_.row_count(); ++row) {
        if (!has_spans(row)) continue;
        write_event(metadata("thread_name", row, "name", name_of_row(row)));
        // OpenGL's row comes below those of the host's threads.
        const int place = row == Profile::opengl_row ? profile_.row_count() : row;
        write_event(metadata("thread_sort_index", row, "sort_index", place));
    }
    for (const Profile::Span& span : profile_.spans()) write_event(event(span, start_ns_));
    file_->write("\n]}\n");
    file_->commit();
    return profile_.spans_left_out();
}

struct RenderOptions {
    SceneOptions scene;
    ViewOptions view;
    OutputOptions output;
    std::string stats, profile;
    std::vector<std::string> kept;
    std::string context = "auto";
    bool plain = false, explain = false, quiet = false;
};

OmissionSwitch omission_switch(const RenderOptions& options) {
    OmissionSwitch omissions;
    const std::vector<std::string> names = omission_names();
    for (const std::string& name : options.kept) {
        if (name == "all") {
            omissions.none = true;
        } else if (std::find(names.begin(), names.end(), name) != names.end()) {
            omissions.kept.insert(name);
        } else {
            throw UsageError(
                fmt::format("--no-omit={}: expected one of {}", name, fmt::join(names, ", ")));
        }
    }
    return omissions;
}

void message(const RenderOptions& options, const std::string& text) {
    if (!options.quiet) print_message("lamina: {}\n", text);
}

void write_profile(ProfileFile& profile, const RenderOptions& options,
                   const std::string& drawn_by) {
    const auto left_out = profile.write("lamina render " + options.scene.file, drawn_by);
    if (left_out > 0)
        message(options, fmt::format("--profile: the first {} spans are kept, {} are left out",
                                     Profile::most_spans, left_out));
}

// Prints the explanation to stdout or, if stdout carries a file, to stderr, line by line.
void print_explanation(const RenderOptions& options, const std::string& explanation) {
    const bool taken = options.output.piped() || options.stats == standard_stream ||
                       options.profile == standard_stream;
    if (!taken) return write_result(explanation);
    std::istringstream lines(explanation);
    for (std::string line; std::getline(lines, line);) write_message(line + "\n");
}

// The scene that the command line describes, its JSON, and the steps of --time.
struct ReadScene {
    Scene scene;
    nlohmann::json document;
    std::optional<DataSeries> series;
    std::vector<Camera> cameras;  // of --path
};

// Returns the cameras of the frames along --path.
std::vector<Camera> cameras_of(const RenderOptions& options) {
    const Words& words = options.view.words;
    if (words.azimuth != 0 || words.elevation != 0 || words.zoom != 1 || !words.up.empty() ||
        !words.view.empty()) {
        throw UsageError(
            "--path: expected none of --azimuth, --elevation, --zoom, --up and --view beside it");
    }
    const CameraPath path = read_camera_path(options.output.path);
    constexpr double most = 100000;
    const double frames = path.seconds() * options.output.rate();
    if (frames > most)
        fail("{}: lasts {} frames, expected at most {}", options.output.path, frames, most);
    return path.cameras(options.output.rate());
}

ReadScene read(const RenderOptions& options) {
    const Stage reading("scene");
    ReadScene read;
    SceneOptions named = options.scene;
    std::function<void(nlohmann::json&)> edit;
    if (options.output.time) {
        read.series.emplace(named.file, time_range(*options.output.time));
        named.file = read.series->first_file();
        edit = [&](nlohmann::json& of_scene) { read.series->begin(of_scene); };
    }
    if (!options.output.path.empty()) {
        read.cameras = cameras_of(options);
        edit = [&](nlohmann::json& of_scene) {
            if (of_scene.is_object()) of_scene["camera"] = camera_json(read.cameras.front());
        };
    }
    read.scene = load_scene(named, settings_of(options.view), read.document, edit);
    if (read.series) read.series->check(read.scene);
    if (options.plain && read.scene.method != Method::trace)
        throw UsageError(fmt::format("--plain: expected the method trace, found {}",
                                     name_of(read.scene.method)));
    return read;
}

PipelineOptions how_to_draw(const RenderOptions& options, const Scene& scene,
                            const RenderExtras& extras) {
    PipelineOptions how;
    how.omissions = omission_switch(options);
    how.context = context_choice(options.context);
    how.adjustments = adjustments_of(options.view, scene.color_space);
    how.adjustments.all_around = options.output.views > 1;
    how.many_frames =
        options.output.frames > 0 || options.output.views > 0 || !options.output.path.empty();
    how.count_fragments = !options.stats.empty();
    how.trace_plainly = options.plain;
    how.make_frames = extras.make_frames;
    return how;
}

void say_written(const RenderOptions& options, const Scene& scene, const RunStatistics& run,
                 const std::string& written) {
    std::string took;
    if (!run.frames_ms.empty()) {
        const double ms = run.frames_ms.back();
        took = fmt::format(", {:.{}f} ms a frame", ms, ms >= 100 ? 0 : ms >= 10 ? 1 : 2);
    }
    message(options, fmt::format("wrote {} ({} x {}, {}{})", written, scene.width, scene.height,
                                 run.picture.drawn_by, took));
}

void run(const RenderOptions& options, const RenderExtras& extras) {
    std::optional<ProfileFile> profile;
    if (!options.profile.empty()) profile.emplace(options.profile);
    const Stopwatch watch;
    const ReadScene read = lamina::read(options);
    const PipelineOptions how = how_to_draw(options, read.scene, extras);
    restrict_instructions_as_asked();
    const auto say = [&](const std::string& text) { message(options, text); };
    const auto output =
        open_output(options.output, {read.scene, how, watch, say, read.cameras},
                    read.series ? &*read.series : nullptr, {options.stats, options.profile});
    std::unique_ptr<OutputFile> stats_file;
    if (!options.stats.empty()) stats_file = open_named(options.stats);

    Pipeline pipeline(read.scene, {}, how);
    pipeline.load();
    const Scene& scene = pipeline.scene();
    const bool changed = !pipeline.reasons().empty() || how.adjustments.transfer_function() ||
                         how.adjustments.camera();
    const std::string scene_text =
        json_text(changed ? nlohmann::json(document_of(scene, read.document)) : read.document, 2);
    for (const std::string& chosen : pipeline.reasons()) say(chosen);
    if (extras.check) extras.check(scene, how.context);
    const Plan plan = pipeline.plan();
    pipeline.warn_of_plan();
    const std::string explanation = pipeline.explanation();
    // Without a picture, nothing would be ready to draw small ones with.
    if (options.explain)
        print_explanation(options, explanation + (output ? pipeline.light_cost() : ""));
    if (!output) return;
    RunStatistics statistics{.picture = pipeline.statistics()};
    const std::string written = output->draw(
        pipeline, statistics,
        {{"scene", scene_text}, {"plan", explanation}, {"software", "lamina " LAMINA_VERSION}});
    const std::int64_t clamped = statistics.picture.counts["clamped_pixels"];
    if (clamped > 0) {
        say(fmt::format("{} pixels {} and were clamped", clamped,
                        scene.transparent ? "shine more than they cover, beyond straight alpha,"
                                          : "lay outside 0..1"));
    }
    if (stats_file) {
        nlohmann::ordered_json json = to_json(statistics, plan);
        if (extras.add_statistics) extras.add_statistics(json);
        stats_file->write(json_text(json, 2) + "\n");
        stats_file->commit();
    }
    if (profile) write_profile(*profile, options, statistics.picture.drawn_by);
    say_written(options, scene, statistics, written);
}

}  // namespace

void add_render(CLI::App& app, int&) {
    add_render_with(app, {});
}

CLI::App& add_render_with(CLI::App& app, const RenderExtras& extras) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* const verb =
        app.add_subcommand("render", "Render a scene, a volume or a mesh to a picture");
    verb->footer("The shortest: lamina render head.nrrd -o head.png");
    verb->add_option(
            "SCENE", options->scene.file,
            "Scene file (JSON), or a data file: a volume (lamina --version lists the formats; a "
            "folder of slices, FILE.h5:/PATH, or with --raw) or a mesh (.vtu, .pvtu, .pvd, .vtk, "
            ".node, .ele); what a scene leaves open is chosen from the data. - reads a scene from "
            "stdin")
        ->required();
    add_output_options(*verb, options->output);
    verb->add_option("--method", options->scene.method,
                     "slice, project or trace; as --set render.method=...")
        ->option_text("slice|project|trace");
    verb->add_flag("--plain", options->plain,
                   "With the method trace: draw with the tracer's plain twin, which is slow and "
                   "shares no code with it");
    verb->add_option("--set", options->scene.settings,
                     "Set a key of the scene, as in render.slice.samples=512")
        ->option_text("KEY=VALUE")
        ->allow_extra_args(false);
    add_raw_options(*verb, options->scene.raw);
    add_view_options(*verb, options->view);
    verb->add_option("--stats", options->stats,
                     "Write times, counts and the plan to this JSON file; - is stdout")
        ->option_text("FILE");
    verb->add_option(
            "--profile", options->profile,
            "Write when each stage ran to this JSON file, for Perfetto (ui.perfetto.dev) or "
            "chrome://tracing; - is stdout")
        ->option_text("FILE");
    verb->add_flag("--explain", options->explain,
                   "Print what runs and what is left out, and why. With -o also what light costs: "
                   "pictures of a quarter of the edges are drawn twice with and twice without it");
    verb->add_flag("--no-omit{all}", options->kept,
                   "Leave out nothing, or with =NAME keep one thing in");
    verb->add_option(
            "--context", options->context,
            "What draws: auto (a GPU, else cpu), osmesa or egl (OpenGL), cpu (lamina's own engine, "
            "without OpenGL; "
            "LAMINA_INSTRUCTIONS=SSE4, AVX2, AVX3 or NEON keeps it to these instructions, and it "
            "takes as many threads as it may run on processors: taskset -c 0-3 lamina ...)")
        ->option_text("auto|osmesa|egl|cpu");
    add_memory_option(*verb);
    add_only_below_option(*verb);
    verb->add_flag("--quiet", options->quiet, "No messages and no progress on stderr");
    verb->callback([options, extras] {
        if (options->output.output.empty() && !options->explain) {
            throw UsageError("render: expected -o FILE (only --explain works without a picture)");
        }
        options->output.check();
        if (options->output.output.empty() && !options->profile.empty())
            throw UsageError("--profile: expected -o FILE, too");
        Progress::set_quiet(options->quiet);
        run(*options, extras);
    });
    return *verb;
}

}  // namespace lamina
