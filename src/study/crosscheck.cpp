// SPDX-License-Identifier: Apache-2.0
#include "study/crosscheck.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <memory>

#include "base/interrupt.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "study/study_frames.h"

namespace lamina::study {
namespace {

Scene slicing_scene(const Scene& scene, int samples) {
    Scene sliced = scene;
    sliced.method = Method::slice;
    sliced.slice.samples = samples;
    return sliced;
}

Scene projection_scene(const Scene& scene, double tolerance) {
    Scene projected = scene;
    projected.method = Method::project;
    if (projected.mesh_file.empty()) {
        if (!projected.mesh_request) projected.mesh_request.emplace();
        projected.mesh_request->tolerance = tolerance;
    }
    return projected;
}

// Draws step by step, coarse to fine, and keeps all renderers ready to be timed.
class Crosschecker {
  public:
    Crosschecker(const Scene& scene, const CrosscheckSettings& settings,
                 const Capabilities& capabilities)
        : scene_(scene), settings_(settings), capabilities_(capabilities) {}

    Crosscheck run() {
        assert(scene_.has_volume());
        const std::vector<int> samples = all_samples();
        const std::vector<double> tolerances = all_tolerances();
        const auto steps = 1 + samples.size() + tolerances.size();
        Progress progress("crosscheck", static_cast<std::int64_t>(steps));
        trace_volume_once();
        progress.advance();
        for (const int each : samples) {
            slice(each);
            progress.advance();
        }
        for (const double each : tolerances) {
            project(each);
            progress.advance();
            if (settings_.stop_when_agreed && each <= made_.tolerance && is_fine_enough()) break;
        }
        time();
        compare_pairs();
        choose_pictures();
        return std::move(made_);
    }

  private:
    std::vector<int> all_samples() {
        std::vector<int> samples = settings_.samples;
        made_.samples = scene_.slice.samples ? *scene_.slice.samples : automatic_samples();
        samples.push_back(made_.samples);
        std::sort(samples.begin(), samples.end());
        samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
        return samples;
    }
    int automatic_samples() {
        Scene sliced = scene_;
        sliced.method = Method::slice;
        return SceneRenderer(sliced, data_.volume(sliced).data, capabilities_).plan().slice.slabs;
    }
    std::vector<double> all_tolerances() {
        if (!scene_.mesh_file.empty()) return {0.0};
        made_.tolerance = scene_.mesh_request.value_or(MeshSettings{}).tolerance;
        std::vector<double> tolerances;
        if (makes_meshes(scene_)) tolerances = settings_.tolerances;
        tolerances.push_back(made_.tolerance);
        std::sort(tolerances.begin(), tolerances.end(), std::greater<>());
        tolerances.erase(std::unique(tolerances.begin(), tolerances.end()), tolerances.end());
        return tolerances;
    }

    void trace_volume_once() {
        const Reference& reference = references_.get(scene_, TraceOf::volume, data_);
        made_.reference_error = reference.error_estimate;
        made_.reference_ms = reference.ms;
        made_.pictures.traced_volume = to_float(reference.image);
        made_.pictures.space = scene_.color_space;
    }

    void slice(int samples) {
        check_interrupt();
        StudyFrames& frames = *frames_.emplace_back(
            std::make_unique<StudyFrames>(slicing_scene(scene_, samples), data_, capabilities_));
        Crosscheck::Slicing& made = made_.slicings.emplace_back();
        made.samples = samples;
        made.picture = frames.picture();
        made.error = image_error(made.picture, made_.pictures.traced_volume);
        made.bytes = frames.bytes();
    }

    void project(double tolerance) {
        check_interrupt();
        const Scene scene = projection_scene(scene_, tolerance);
        const Stopwatch watch;
        const SceneMesh& mesh = *data_.mesh(scene).data.data();
        Crosscheck::Projection& made = made_.projections.emplace_back();
        made.mesh_ms = watch.milliseconds();
        made.tolerance = tolerance;
        made.tets = static_cast<std::int64_t>(mesh.mesh.tets().size());
        if (mesh.report) {
            made.mesh_error = mesh.report->relative_error();
            made.stopped = mesh.report->stopped_by_max_tets;
        }
        StudyFrames& frames =
            *frames_.emplace_back(std::make_unique<StudyFrames>(scene, data_, capabilities_));
        made.picture = frames.picture();
        made.traced = to_float(references_.get(scene, TraceOf::mesh, data_).image);
        made.mesh_part = image_error(made.traced, made_.pictures.traced_volume);
        made.method_part = image_error(made.picture, made.traced);
        made.error = image_error(made.picture, made_.pictures.traced_volume);
        made.bytes = frames.bytes();
    }

    bool is_fine_enough() const {
        const Crosscheck::Projection& last = made_.projections.back();
        const double e = image_error(last.picture, made_.slicings.back().picture).all.linf;
        return e <= scene_.max_error || last.stopped;
    }

    void time() {
        std::vector<TimedFrame> timed;
        for (const auto& frames : frames_) {
            const auto angle = std::make_shared<int>(0);
            timed.push_back(
                {"", [&frames] { frames->draw(); },
                 [&frames, angle] { frames->draw_turned(degrees_per_frame * ++*angle); }});
        }
        const std::vector<FrameTimes> times = time_interleaved("timing", timed, settings_.rounds);
        auto next = times.begin();
        for (Crosscheck::Slicing& each : made_.slicings) each.times = *next++;
        for (Crosscheck::Projection& each : made_.projections) each.times = *next++;
    }

    void compare_pairs() {
        for (const Crosscheck::Projection& projection : made_.projections) {
            std::vector<Crosscheck::Pair>& row = made_.pairs.emplace_back();
            for (const Crosscheck::Slicing& slicing : made_.slicings) {
                const std::array<double, 3> parts{projection.mesh_part.all.l2, slicing.error.all.l2,
                                                  projection.method_part.all.l2};
                const auto most = std::max_element(parts.begin(), parts.end());
                row.push_back({image_error(projection.picture, slicing.picture).all,
                               static_cast<std::size_t>(most - parts.begin())});
            }
        }
    }

    void choose_pictures() {
        for (const Crosscheck::Slicing& each : made_.slicings) {
            if (each.samples == made_.samples) made_.pictures.sliced = each.picture;
        }
        for (const Crosscheck::Projection& each : made_.projections) {
            if (each.tolerance != made_.tolerance) continue;
            made_.pictures.projected = each.picture;
            made_.pictures.traced_mesh = each.traced;
        }
        if (scene_.lighting) trace_unlit();
    }

    // What light adds to the difference of mesh and volume is told for the pictures that are shown.
    void trace_unlit() {
        check_interrupt();
        Scene unlit = projection_scene(scene_, made_.tolerance);
        unlit.lighting.reset();
        made_.pictures.unlit_volume =
            to_float(references_.get(unlit, TraceOf::volume, data_).image);
        made_.pictures.unlit_mesh = to_float(references_.get(unlit, TraceOf::mesh, data_).image);
    }

    const Scene& scene_;
    const CrosscheckSettings& settings_;
    const Capabilities& capabilities_;
    DataStore data_;
    ReferenceStore references_;
    std::vector<std::unique_ptr<StudyFrames>> frames_;
    Crosscheck made_;
};

}  // namespace

bool makes_meshes(const Scene& scene) {
    return scene.mesh_file.empty() && !(scene.mesh_request && scene.mesh_request->kuhn);
}

Crosscheck crosscheck(const Scene& scene, const CrosscheckSettings& settings,
                      const Capabilities& capabilities) {
    return Crosschecker(scene, settings, capabilities).run();
}

}  // namespace lamina::study
