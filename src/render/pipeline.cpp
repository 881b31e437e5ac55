// SPDX-License-Identifier: Apache-2.0
#include "render/pipeline.h"

#include <fmt/format.h>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <new>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/profile.h"
#include "choice/field.h"
#include "choice/words.h"
#include "facts/mesh_facts.h"
#include "facts/volume_facts.h"
#include "gl/api.h"
#include "gl/timeline.h"
#include "mesh/tet_mesh.h"
#include "plain/plain_tracer.h"
#include "reference/scene_tracer.h"
#include "render/warnings.h"
#include "scene/given_transfer.h"

namespace lamina {
namespace {

// Returns the context for a volume that does not fit the memory and is read from its files while it
// is drawn: the cpu engine. Throws Error if OpenGL is chosen.
ContextChoice context_for_files(const Auto<ContextChoice>& choice) {
    if (choice.value_or(ContextChoice::cpu) != ContextChoice::cpu) {
        fail(
            "--context {}: the volume does not fit the memory limit of {} bytes, and OpenGL draws "
            "volumes in memory alone: expected cpu, or more memory (--memory)",
            name_of(choice), memory_limit());
    }
    return ContextChoice::cpu;
}

// Settles what a field that is constant in each voxel leaves no choice of: it is integrated
// exactly, and it has no gradient that could be lit. Returns why light that was left open is not
// chosen. Throws Error if the scene asks for other segments.
std::vector<std::string> settle_for_voxels(Scene& scene) {
    if (VolumeFile* const file = scene.volume_file())
        file->selection.lookup = VolumeLookup::nearest;
    const Auto<Classification>& asked = scene.slice.classification;
    if (asked.is_given() && asked != Classification::exact) {
        fail(
            "{}: render.slice.classification: found \"{}\", expected \"exact\" with \"lookup\": "
            "\"nearest\": the field steps at the faces of voxels, which slabs would miss",
            scene.file.string(), name_of(*asked));
    }
    scene.slice.classification = Classification::exact;
    if (!scene.lighting) return {};
    const bool asked_for = scene.lighting->is_given();
    scene.lighting.reset();
    const std::string reason =
        "because with \"lookup\": \"nearest\" the field is constant in each voxel and has no "
        "gradient";
    if (!asked_for) return {"lighting: not lit, " + reason};
    warn("lighting: nothing is lit, " + reason);
    return {};
}

}  // namespace

Scene as_trace(Scene scene, TraceOf of) {
    scene.method = Method::trace;
    scene.trace_of = of;
    return scene;
}

TracedPicture trace_picture(const Scene& scene, SceneData& data, const TileDone& tile_done) {
    if (scene.draws_mesh()) {
        const SceneMesh& mesh = *data.mesh(scene);
        const FaceTree& open_faces = data.open_faces(scene);
        const Stage tracing("trace");
        TraceResult traced = trace(scene, mesh, open_faces, tile_done);
        return {std::move(traced.image), traced.error_estimate, traced.segments,
                traced.overlapping_rays};
    }
    const Volume& volume = data.volume(scene)->volume;
    const Stage tracing("trace");
    TraceResult traced = trace(scene, volume, tile_done);
    return {std::move(traced.image), traced.error_estimate, traced.segments, 0};
}

TracedPicture plainly_traced_picture(const Scene& scene, SceneData& data) {
    const auto trace = [&](const auto& drawn) {
        const Stage tracing("trace");
        PlainPicture traced = trace_plainly(scene, drawn);
        return TracedPicture{std::move(traced.image), traced.error_estimate, traced.segments, 0};
    };
    return scene.draws_mesh() ? trace(*data.mesh(scene)) : trace(data.volume(scene)->volume);
}

namespace {

Scene adjusted(Scene scene, const Adjustments& adjustments) {
    adjust_scene(scene, adjustments);
    return scene;
}

}  // namespace

Pipeline::Pipeline(Scene scene, SceneData data, PipelineOptions options)
    : asked_(adjusted(std::move(scene), options.adjustments)),
      scene_(asked_),
      data_(std::move(data)),
      options_(std::move(options)) {}

template <typename Work>
decltype(auto) Pipeline::in_context(const Work& work) {
    const auto current = make_current();
    return work();
}

std::unique_ptr<gl::CurrentContext> Pipeline::make_current() const {
    return context_ ? context_->make_current() : nullptr;
}

// The context must be current when a renderer of OpenGL is destroyed.
Pipeline::~Pipeline() {
    drop_frames();
}

void Pipeline::drop_frames() {
    if (!frames_) return;
    in_context([&] { frames_.reset(); });
    own_ = nullptr;
    frame_ms_ = 0;
    counted_fragments_.reset();
    stages_ms_.erase("read");
}

// --- data and choices

Choices Pipeline::chosen() {
    return keep_warnings(choice_warnings_, [&]() -> Choices {
        const Adjustments& adjustments = options_.adjustments;
        if (const auto ramp = opaque_ramp(asked_)) warn(*ramp);
        Scene scene = asked_;
        std::vector<std::string> settled;
        if (!scene.draws_mesh() &&
            data_.volume(scene)->volume.grid().lookup == VolumeLookup::nearest)
            settled = settle_for_voxels(scene);
        data_.close_transfer_function(scene);
        if (!leaves_something_open(scene) && !adjustments.any()) return {std::move(scene), settled};
        // If the mesh is made from the volume, transfer function and camera are chosen for the
        // volume.
        const std::unique_ptr<Field> field =
            data_.makes_mesh(scene) ? std::make_unique<VolumeField>(*data_.volume(scene))
                                    : data_.field(scene);
        Stage choosing("choose");
        Choices result = choose(std::move(scene), *field, adjustments);
        result.scene.transfer_function =
            data_.marked(result.scene, *result.scene.transfer_function);
        stages_ms_["choose"] = choosing.end();
        std::ranges::move(settled, std::back_inserter(result.reasons));
        return result;
    });
}

const Scene& Pipeline::scene() {
    if (!chosen_) {
        Choices choices = chosen();
        scene_ = std::move(choices.scene);
        reasons_ = std::move(choices.reasons);
    }
    chosen_ = true;
    return scene_;
}

const std::vector<std::string>& Pipeline::reasons() {
    scene();
    return reasons_;
}

void Pipeline::load() {
    if (scene().draws_mesh())
        data_.mesh(scene_);
    else
        data_.volume(scene_);
}

// --- changes

// A mesh that is made from a volume depends on the transfer function: parts that show nothing are
// coarse.
bool Pipeline::changes_mesh(const Scene& next) const {
    const bool made = data_.makes_mesh(scene_), makes = data_.makes_mesh(next);
    return made != makes || (makes && (mesh_settings(next) != mesh_settings(scene_) ||
                                       next.transfer_function != scene_.transfer_function));
}

void Pipeline::take(Choices next) {
    const bool other_method = next.scene.method != scene_.method;
    const bool other_mesh = changes_mesh(next.scene);
    scene_ = std::move(next.scene);
    reasons_ = std::move(next.reasons);
    trace_plan_.reset();
    if (other_mesh) data_.forget_mesh();
    if (other_method || (other_mesh && scene_.method == Method::project)) drop_frames();
}

void Pipeline::set_scene(Scene scene) {
    asked_ = adjusted(std::move(scene), options_.adjustments);
    // If an earlier scene's mesh was made from the volume and this scene's is a file, the file must
    // be read before chosen() looks at it.
    const bool reads_mesh = data_.makes_mesh(scene_) && !data_.makes_mesh(asked_);
    if (reads_mesh) {
        if (scene_.method == Method::project) drop_frames();
        data_.forget_mesh();
        scene_.mesh = asked_.mesh;
    }
    take(chosen());
    chosen_ = true;
    if (frames_) in_context([&] { frames_->set_scene(scene_); });
}

void Pipeline::adjust(const Adjustments& adjustments) {
    const Scene asked = asked_;
    options_.adjustments = adjustments;
    try {
        set_scene(asked);
    } catch (...) {
        options_.adjustments = {};
        asked_ = asked;
        throw;
    }
    options_.adjustments = {};
    asked_ = scene_;
}

void Pipeline::set_camera(const Camera& camera) {
    scene_.camera = asked_.camera = camera;
    trace_plan_.reset();
    if (frames_) frames_->set_camera(camera);
}

void Pipeline::set_size(int width, int height) {
    scene_.width = asked_.width = width;
    scene_.height = asked_.height = height;
    trace_plan_.reset();
    if (frames_) frames_->set_size(width, height);
}

void Pipeline::set_transfer_function(const TransferFunction& transfer_function) {
    asked_.transfer_function = transfer_function;
    asked_.given_transfer.reset();
    Choices next{scene_, reasons_};
    next.scene.transfer_function = transfer_function;
    data_.close_transfer_function(next.scene);
    take(std::move(next));
    choice_warnings_.clear();
    if (frames_) in_context([&] { frames_->set_transfer_function(*scene_.transfer_function); });
}

void Pipeline::set_transfer_function_of(const Scene& like) {
    Scene next = asked_;
    next.transfer_function = like.transfer_function;
    next.given_transfer = like.given_transfer;
    if (chooses_transfer_function(like)) return set_scene(std::move(next));
    Scene closed = like;
    if (has_open_colormap(closed)) {
        close_colormap(closed, data_.range(scene()));
        closed.transfer_function = data_.marked(scene(), *closed.transfer_function);
    }
    set_transfer_function(*closed.transfer_function);
    if (const auto ramp = opaque_ramp(closed)) {
        warn(*ramp);
        choice_warnings_.push_back(*ramp);
    }
    asked_ = std::move(next);
}

void Pipeline::set_clip(const Clip& clip) {
    scene_.clip = asked_.clip = clip;
    trace_plan_.reset();
    if (frames_) in_context([&] { frames_->set_clip(clip); });
}

// --- frames

// A volume that does not fit the memory limit needs the cpu engine, so it is loaded before the
// context is chosen.
const Capabilities& Pipeline::capabilities() {
    assert(!options_.make_frames);
    if (options_.capabilities) return *options_.capabilities;
    if (context_) return context_->capabilities();
    const bool in_files =
        scene().method == Method::slice && !data_.volume(scene_)->volume.in_memory();
    Stage opening("context");
    context_.emplace(in_files ? context_for_files(options_.context) : options_.context);
    stages_ms_["context"] = opening.end();
    return context_->capabilities();
}

std::unique_ptr<SceneRenderer> Pipeline::renderer_of(const Scene& scene) {
    if (scene.method == Method::project) {
        return std::make_unique<SceneRenderer>(scene, data_.mesh(scene), capabilities(),
                                               options_.omissions, options_.tables);
    }
    return std::make_unique<SceneRenderer>(scene, data_.volume(scene), capabilities(),
                                           options_.omissions, options_.share, options_.tables);
}

Frames& Pipeline::frames() {
    if (frames_) return *frames_;
    load();
    assert(scene_.method != Method::trace);
    if (options_.make_frames) {
        frames_ = options_.make_frames(scene_, data_, options_);
        return *frames_;
    }
    std::unique_ptr<SceneRenderer> made = renderer_of(scene_);
    if (options_.many_frames) made->expect_many_frames();
    own_ = made.get();
    frames_ = std::move(made);
    return *frames_;
}

SceneRenderer& Pipeline::renderer() {
    frames();
    return *own_;
}

const Scene& Pipeline::resolved_scene() {
    if (scene().method == Method::trace) return scene_;
    Frames& drawing = frames();
    return in_context([&]() -> const Scene& { return drawing.resolved().scene(); });
}

const Plan& Pipeline::plan() {
    if (scene().method == Method::trace) return plan_of_trace().plan;
    Frames& drawing = frames();
    return in_context([&]() -> const Plan& { return drawing.plan(); });
}

std::string Pipeline::explanation() {
    if (scene().method == Method::trace) return chosen_text(reasons_) + plan_of_trace().explanation;
    Frames& drawing = frames();
    return in_context([&] { return chosen_text(reasons_) + drawing.explanation(); });
}

// Draws small pictures: twice with and twice without light, in frames a sixteenth as large. What is
// set up for the one without is thrown away, and before this pipeline's own renderer is set up, so
// that the two do not take memory together.
std::string Pipeline::light_cost() {
    constexpr int scale = 4;  // of the picture's edges
    if (scene().method == Method::trace || !scene_.lighting || options_.make_frames) return {};
    SceneRenderer& drawing = renderer();
    const auto shortest_ms = [](SceneRenderer& small) {
        small.set_up();
        double shortest = INFINITY;
        for (int i = 0; i < 2; ++i) {
            Stage frame("light_cost");
            small.draw();
            shortest = std::min(shortest, frame.end());
        }
        return shortest;
    };
    const auto measured = [&] {
        Scene unlit = drawing.resolved().scene();
        unlit.lighting.reset();
        unlit.width = std::max(1, unlit.width / scale);
        unlit.height = std::max(1, unlit.height / scale);
        const double without = shortest_ms(*renderer_of(unlit));
        drawing.set_size(unlit.width, unlit.height);
        const double with_light = shortest_ms(drawing);
        return fmt::format(
            "a frame takes {:.1f} times as long as without light (measured at {} x {}: {:.3g} and "
            "{:.3g} ms)",
            with_light / without, unlit.width, unlit.height, with_light, without);
    };
    return in_context([&] {
        std::string cost;
        const auto not_measured = [&](const std::exception& error) {
            cost = "what it costs cannot be measured: " + error_text(error);
        };
        try {
            cost = measured();
        } catch (const Error& error) {
            not_measured(error);
        } catch (const std::bad_alloc& error) {
            not_measured(error);
        }
        drawing.set_size(scene_.width, scene_.height);
        return "light\n  " + cost + "\n";
    });
}

void Pipeline::warn_of_plan() {
    if (scene().method == Method::trace) return warn_of_data();
    Frames& drawing = frames();
    warn_of_scene();
    in_context([&] { warn_of_all(drawing.warnings()); });
}

void Pipeline::set_up() {
    if (scene().method == Method::trace) return;
    Frames& drawing = frames();
    in_context([&] { drawing.set_up(); });
}

void Pipeline::draw_frame() {
    if (scene().method == Method::trace) {
        traced_now({});
        return;
    }
    Frames& drawing = frames();
    in_context([&] { drawing.draw(); });
}

// Draws a frame and counts its fragments if asked. With OpenGL this takes a query, which costs
// time.
void Pipeline::draw_counted() {
    counted_fragments_.reset();
    if (!options_.count_fragments || options_.make_frames || capabilities().cpu)
        return frames_->draw();
    gl::Query query(gl::Query::Kind::samples_passed);
    query.begin();
    frames_->draw();
    query.end();
    counted_fragments_ = static_cast<std::int64_t>(query.result());
}

// The values of data are counted once for labels, and their range for a colour bar.
const AnnotatedData& Pipeline::annotated() {
    const Annotations& wanted = scene_.annotations;
    const std::pair counted(wanted.labels.has_value(), wanted.colorbar.has_value());
    std::shared_ptr<const void> drawn;
    if (scene_.draws_mesh())
        drawn = data_.mesh(scene_);
    else
        drawn = data_.volume(scene_);
    const bool known = annotated_ && annotated_of_.lock() == drawn &&
                       annotated_counted_ == counted && annotated_clip_ == scene_.clip;
    if (known) return *annotated_;
    annotated_of_ = drawn;
    annotated_counted_ = counted;
    annotated_clip_ = scene_.clip;
    return annotated_.emplace(annotated_data(*field(), wanted, scene_.clip));
}

template <typename Real>
void Pipeline::label(RgbaImage<Real>& picture) {
    picture.space = scene_.color_space;
    picture.annotations.reset();
    if (!scene_.annotations.any()) return;
    const Stage drawing("annotate");
    picture.annotations = annotation_layer(scene_, annotated(), picture);
}

void Pipeline::read_frame(Image& picture) {
    frames_->read(picture);
    label(picture);
}

void Pipeline::read(Image& picture) {
    if (scene_.method == Method::trace) {
        assert(traced_);
        picture = to_float(traced_->image);
        return;
    }
    in_context([&] { read_frame(picture); });
}

void Pipeline::draw_quietly(Image& picture) {
    if (scene().method == Method::trace) {
        trace();
        return read(picture);
    }
    Frames& drawing = frames();
    in_context([&] {
        drawing.set_up();
        Stage frame("frame");
        frame.count("frame", frames_drawn_++);
        draw_counted();
        frame_ms_ = frame.end();
        Stage reading("read");
        read_frame(picture);
        stages_ms_["read"] = reading.end();
        warn_of_scene();
        warn_of_all(drawing.warnings());
    });
}

void Pipeline::draw(Image& picture) {
    draw_quietly(picture);
    warn_of(picture);
}

void Pipeline::warn_of(const Image& picture) {
    warn_of_picture(scene_, *field(), picture);
}

// --- traced pictures

const Pipeline::TracePlan& Pipeline::plan_of_trace() {
    if (trace_plan_) return *trace_plan_;
    load();
    Stage measuring("measure");
    TracePlan made;
    if (scene_.draws_mesh()) {
        const MeshFacts facts = measure(scene_, *data_.mesh(scene_));
        made.plan = make_plan(scene_, facts, {}, options_.omissions);
        made.explanation = explain(made.plan, facts, {});
    } else {
        const VolumeData& volume = *data_.volume(scene_);
        const Facts facts = measure(scene_, volume.volume, volume.bricks);
        made.plan = make_plan(scene_, facts, {}, options_.omissions);
        made.explanation = explain(made.plan, facts, {});
    }
    stages_ms_["facts"] = measuring.end();
    return trace_plan_.emplace(std::move(made));
}

// Repeats the warnings of choosing and reading: they belong to every picture.
void Pipeline::warn_of_scene() {
    warn_of_all(choice_warnings_);
    warn_of_all(data_.warnings(scene_));
}

void Pipeline::warn_of_data() {
    warn_of_scene();
    warn_of_all(scene_.draws_mesh() ? data_warnings(scene_, *data_.mesh(scene_))
                                    : data_warnings(*data_.volume(scene_)));
}

void Pipeline::check_data() {
    if (scene_.draws_mesh()) {
        const SceneMesh& mesh = *data_.mesh(scene_);
        check_finite(scene_, mesh, measure_range(mesh.scalar.values));
    } else {
        const VolumeData& volume = *data_.volume(scene_);
        check_finite(scene_, volume.volume.grid(), volume.bricks);
    }
}

TracedPicture Pipeline::traced_now(const TileDone& tile_done) {
    TracedPicture made = options_.trace_plainly ? plainly_traced_picture(scene_, data_)
                                                : trace_picture(scene_, data_, tile_done);
    label(made.image);
    return made;
}

const TracedPicture& Pipeline::trace(const TileDone& tile_done) {
    load();
    check_data();
    if (scene_.draws_mesh() && !options_.trace_plainly)
        data_.open_faces(scene_);  // built once, in no frame's time
    Stage frame("frame");
    frame.count("frame", frames_drawn_++);
    TracedPicture made = traced_now(tile_done);
    trace_ms_ = frame.end();
    traced_ = std::move(made);
    warn_of_data();
    warn_of_all(trace_warnings(traced_->overlapping_rays));
    return *traced_;
}

// --- statistics

FrameStatistics Pipeline::statistics() {
    if (scene().method == Method::trace) return trace_statistics();
    FrameStatistics found;
    found.stages_ms = stages_ms_;
    found.draw_ms = frame_ms_;
    data_.add_to(scene_, found);
    if (!frames_) return found;
    if (!options_.make_frames) {
        found.renderer = capabilities().renderer;
        found.drawn_by = renderer_and_threads(capabilities());
        found.native = capabilities().cpu;
    }
    in_context([&] {
        frames_->add_to(found);
        found.bytes_gpu = gl::bytes_allocated();
    });
    if (counted_fragments_) found.fragments = *counted_fragments_;
    return found;
}

FrameStatistics Pipeline::trace_statistics() {
    FrameStatistics found;
    found.renderer = found.drawn_by = options_.trace_plainly ? "plain tracer" : "reference tracer";
    found.stages_ms = stages_ms_;
    data_.add_to(scene_, found);
    if (!traced_) return found;
    found.draw_ms = found.stages_ms["trace"] = trace_ms_;
    found.trace_error = 255 * traced_->error_estimate;
    if (scene_.draws_mesh()) {
        found.counts["segments"] = traced_->segments;
        found.counts["overlapping_rays"] = traced_->overlapping_rays;
    }
    return found;
}

}  // namespace lamina
