// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <glm/vector_relational.hpp>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "context_kind.h"
#include "gl/context.h"
#include "gl/memory.h"
#include "picture_file.h"
#include "reference/volume_tracer.h"
#include "render_stats.h"
#include "scene/json_reader.h"
#include "scene/scene_reader.h"
#include "slicing/gl_slice_renderer.h"
#include "verbs.h"

namespace lamina {
namespace {

constexpr double degrees_per_frame = 0.1;

struct RenderOptions {
    std::string scene, output, method, stats;
    std::vector<std::string> settings, kept;
    int frames = 0;
    std::string context = "auto";
    bool explain = false, quiet = false;
};

// A mistake in --set or --method is one of usage (exit 2), one in the file is not.
Scene load_scene(const RenderOptions& options, std::string& document_text) {
    nlohmann::json document = load_json(options.scene);
    std::vector<std::string> keys;
    const auto apply = [&](const std::string& key, const std::string& value) {
        set_key(document, key, value);
        keys.push_back(key);
    };
    for (const std::string& setting : options.settings) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos) {
            throw UsageError(
                fmt::format("--set {}: expected KEY=VALUE, as in render.target=fixed8", setting));
        }
        apply(setting.substr(0, equals), setting.substr(equals + 1));
    }
    if (!options.method.empty()) apply("render.method", options.method);
    document_text = document.dump(2);
    try {
        return read_scene(document, options.scene);
    } catch (const KeyError& error) {
        for (const std::string& key : keys) {
            if (error.key == key || key.starts_with(error.key + ".") ||
                error.key.starts_with(key + ".")) {
                throw UsageError(error.what());
            }
        }
        throw;
    }
}

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

// Scene, picture and statistics are three files.
void check_paths(const RenderOptions& options) {
    const auto same = [](const std::string& a, const std::string& b) {
        std::error_code ignored;
        return !a.empty() && !b.empty() &&
               std::filesystem::weakly_canonical(a, ignored) ==
                   std::filesystem::weakly_canonical(b, ignored);
    };
    for (const auto& [a, b] : {std::pair(options.output, options.stats),
                               {options.output, options.scene},
                               {options.stats, options.scene}}) {
        if (same(a, b))
            throw UsageError(
                fmt::format("{}: expected different files for scene, -o and --stats", a));
    }
}

void message(const RenderOptions& options, const std::string& text) {
    if (!options.quiet) fmt::print(stderr, "lamina: {}\n", text);
}

// Colours above 1 do not fit a fixed-point target: they are clamped there, and said.
std::int64_t count_clamped_colors(const Scene& scene) {
    if (scene.target == Target::float32 || scene.target == Target::float16) return 0;
    std::int64_t count = 0;
    for (const TransferKnot& knot : scene.transfer_function.knots()) {
        count += glm::any(glm::greaterThan(knot.optics.color, glm::dvec3(1)));
    }
    return count;
}

// The frames of --frames: `draw(view)` for the scene's camera turned a little further each time.
template <typename Draw>
void time_frames(const Scene& scene, int frames, RenderStats& stats, const Draw& draw) {
    if (frames == 0) return;
    stats.frames_ms.clear();  // the scene's own frame was the warm-up
    Progress progress("timing frames", frames);
    for (int i = 1; i <= frames; ++i) {
        check_interrupt();
        const Camera camera = turned(scene.camera, degrees_per_frame * i);
        const Stopwatch watch;
        draw(View(camera, scene.width, scene.height));
        stats.frames_ms.push_back(watch.milliseconds());
        progress.advance();
    }
}

// One `lamina render`: from the files to the picture and what it cost.
class RenderRun {
  public:
    explicit RenderRun(const RenderOptions& options)
        : options_(options), scene_(load_scene(options, scene_text_)) {}

    void run() {
        for (const std::string& warning : scene_.warnings) message(options_, warning);
        const OmissionSwitch omissions = omission_switch(options_);
        context_kind(options_.context);  // a bad word fails before any work
        const bool tracing = scene_.method == Method::trace;
        std::optional<PictureFile> picture;
        if (!options_.output.empty()) picture.emplace(options_.output, tracing);
        std::optional<AtomicFile> stats_file;
        if (!options_.stats.empty()) stats_file.emplace(options_.stats);

        load();
        if (!tracing) make_context();
        const Capabilities capabilities = context_ ? context_->capabilities() : Capabilities{};
        plan_ = make_plan(scene_, facts_, capabilities, omissions);
        if (options_.explain) fmt::print("{}", explain(plan_, facts_, capabilities));
        if (!picture) return;
        if (tracing)
            trace(*picture);
        else
            slice(*picture);
        if (stats_file) {
            stats_file->write(to_json(stats_, plan_).dump(2) + "\n");
            stats_file->commit();
        }
        message(options_,
                fmt::format("wrote {} ({} x {}, {}, {:.4g} ms a frame)", options_.output,
                            scene_.width, scene_.height, stats_.context, stats_.frames_ms.back()));
    }

  private:
    void load() {
        const Stopwatch load_watch;
        volume_.emplace(load_volume(scene_));
        stats_.stages_ms["load"] = load_watch.milliseconds();
        const Stopwatch measure_watch;
        facts_ = measure(scene_, *volume_, measure_bricks(*volume_));
        stats_.stages_ms["measure"] = measure_watch.milliseconds();
        stats_.counts["non_finite_samples"] = facts_.non_finite;
        if (facts_.non_finite > 0) {
            message(options_,
                    fmt::format("{} samples are NaN or infinite: their cells are drawn transparent",
                                facts_.non_finite));
        }
    }

    void make_context() {
        const Stopwatch watch;
        context_ = gl::Context::create(context_kind(options_.context));
        stats_.stages_ms["context"] = watch.milliseconds();
        stats_.context = context_->capabilities().renderer;
    }

    void slice(PictureFile& picture) {
        stats_.counts["clamped_colors"] = count_clamped_colors(scene_);
        if (stats_.counts["clamped_colors"] > 0) {
            message(
                options_,
                fmt::format(
                    "{} transfer-function points have a colour above 1, which the target {} clamps",
                    stats_.counts["clamped_colors"], name_of(scene_.target)));
        }
        GlSliceRenderer renderer(*volume_, scene_.transfer_function, facts_, plan_.slice,
                                 context_->capabilities(), scene_.width, scene_.height);
        const View view(scene_.camera, scene_.width, scene_.height);
        const Stopwatch frame_watch;
        {
            Progress progress("slicing", renderer.step_count());
            if (options_.stats.empty())
                renderer.draw(view, &progress);
            else
                stats_.fragments = renderer.draw_counting(view, &progress);
        }
        stats_.frames_ms = {frame_watch.milliseconds()};
        stats_.stages_ms["tables"] = renderer.table_ms();
        stats_.stages_ms["upload"] = renderer.upload_ms();
        stats_.stages_ms["geometry"] = renderer.geometry_ms();
        stats_.stages_ms["draw"] = renderer.draw_ms();
        const Stopwatch read_watch;
        const Image image = renderer.read();
        stats_.stages_ms["read"] = read_watch.milliseconds();
        time_frames(scene_, options_.frames, stats_,
                    [&](const View& turned_view) { renderer.draw(turned_view); });
        stats_.samples = plan_.slice.slabs;
        stats_.bytes_gpu = gl::bytes_allocated();
        write(picture, image);
    }

    void trace(PictureFile& picture) {
        stats_.context = "reference tracer";
        const TraceOptions trace_options{scene_.trace_tolerance};
        const auto trace_view = [&](const View& view) {
            return trace_volume(*volume_, scene_.transfer_function, view, trace_options);
        };
        const Stopwatch watch;
        const TraceResult result = trace_view(View(scene_.camera, scene_.width, scene_.height));
        stats_.frames_ms = {watch.milliseconds()};
        stats_.stages_ms["trace"] = watch.milliseconds();
        stats_.error_estimate = result.error_estimate;
        time_frames(scene_, options_.frames, stats_, trace_view);
        write(picture, result.image);
    }

    template <typename AnyImage>
    void write(PictureFile& picture, const AnyImage& image) {
        const Capabilities capabilities = context_ ? context_->capabilities() : Capabilities{};
        const Stopwatch watch;
        const std::size_t clamped = picture.write(image, scene_.background,
                                                  {{"scene", scene_text_},
                                                   {"plan", explain(plan_, facts_, capabilities)},
                                                   {"renderer", stats_.context},
                                                   {"software", "lamina " LAMINA_VERSION}});
        stats_.stages_ms["write"] = watch.milliseconds();
        stats_.counts["clamped_pixels"] = static_cast<std::int64_t>(clamped);
        if (clamped > 0)
            message(options_, fmt::format("{} pixels lay outside 0..1 and were clamped", clamped));
    }

    const RenderOptions& options_;
    std::string scene_text_;
    Scene scene_;
    std::optional<Volume> volume_;
    Facts facts_;
    std::unique_ptr<gl::Context> context_;
    Plan plan_;
    RenderStats stats_;
};

}  // namespace

void add_render(CLI::App& app, int&) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* const verb = app.add_subcommand("render", "Render a scene to a picture");
    verb->add_option("SCENE", options->scene, "Scene file (JSON)")->required();
    verb->add_option("-o,--output", options->output,
                     "Picture to write: .exr, .png, or .npy (trace only)");
    verb->add_option("--method", options->method, "slice or trace; as --set render.method=...");
    verb->add_option("--set", options->settings,
                     "Set a key of the scene: KEY=VALUE, as in render.slice.samples=512")
        ->allow_extra_args(false);
    verb->add_option("--frames", options->frames,
                     "Time this many frames, the camera turning a little")
        ->check(CLI::Range(1, 1000000));
    verb->add_option("--stats", options->stats,
                     "Write times, counts and the plan to this JSON file");
    verb->add_flag("--explain", options->explain, "Print what runs and what is left out, and why");
    verb->add_flag("--no-omit{all}", options->kept,
                   "Leave out nothing, or with =NAME keep one thing in");
    verb->add_option("--context", options->context, "OpenGL context: auto, osmesa or egl");
    verb->add_flag("--quiet", options->quiet, "No messages and no progress on stderr");
    verb->callback([options] {
        if (options->output.empty() && !options->explain) {
            throw UsageError("render: expected -o FILE (only --explain works without a picture)");
        }
        check_paths(*options);
        Progress::set_quiet(options->quiet);
        RenderRun(*options).run();
    });
}

}  // namespace lamina
