// SPDX-License-Identifier: Apache-2.0
#include "study/crosscheck.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <set>

#include "base/client.h"
#include "base/profile.h"
#include "study/time_left.h"

namespace lamina::study {
namespace {

double product(const Difference& a, const Difference& b) {
    return std::inner_product(a.e.begin(), a.e.end(), b.e.begin(), 0.0);
}

double sign_of(const ErrorBudget::Part& part) {
    return part.key == "slicing" ? -1 : 1;
}

std::vector<ErrorBudget::Part> parts_of(const FourPictures& pictures) {
    Difference mesh = difference(pictures.traced_mesh, pictures.traced_volume);
    std::vector<ErrorBudget::Part> parts{
        {"mesh", "mesh discretisation", mesh, {}, 0},
        {"slicing", "slicing method", difference(pictures.sliced, pictures.traced_volume), {}, 0},
        {"projection", "PT method", difference(pictures.projected, pictures.traced_mesh), {}, 0}};
    if (pictures.unlit_mesh.rgba.empty()) return parts;
    const Difference unlit = difference(pictures.unlit_mesh, pictures.unlit_volume);
    for (std::size_t i = 0; i < mesh.e.size(); ++i) mesh.e[i] -= unlit.e[i];
    parts[0].e = unlit;
    parts.push_back({"gradients", "gradients", mesh, {}, 0});
    return parts;
}

// Does a cross-check: draws with both methods, from coarse to fine, and keeps all renderers so that
// their frames can be timed in turn at the end.
class Crosschecker {
  public:
    Crosschecker(const Scene& scene, const CrosscheckSettings& settings,
                 const Capabilities& capabilities)
        : scene_(scene), settings_(settings), capabilities_(capabilities) {
        if (settings.kept.empty()) return;
        data_.keep_meshes(settings.kept);
        references_ = ReferenceStore(settings.kept, settings.say);
    }

    Crosscheck run() {
        assert(scene_.has_volume());
        data_.volume(scene_);
        settings_.begin();
        const std::vector<int> samples = all_samples();
        const std::vector<double> tolerances = all_tolerances();
        say_how_long(samples.size(), tolerances);
        TimedProgress progress("crosscheck");
        progress.expect(LadderCost::most_seconds(steps_of(tolerances)));
        trace_volume_once();
        for (const int each : samples) slice(each);
        std::vector<double> left = tolerances;
        while (!left.empty()) {
            project(left.front());
            left.erase(left.begin());
            if (is_ended_)
                std::erase_if(left, [&](double each) { return each != stated_tolerance(); });
            progress.expect(cost_.expected_seconds(steps_of(left)) + timing_seconds());
        }
        progress.expect(timing_seconds());
        time();
        compare_pairs();
        choose_pictures();
        return std::move(made_);
    }

  private:
    std::vector<int> all_samples() {
        made_.samples =
            scene_.slice.samples.is_given() ? *scene_.slice.samples : automatic_samples();
        std::set<int> samples(settings_.samples.begin(), settings_.samples.end());
        samples.insert(made_.samples);
        return {samples.begin(), samples.end()};
    }
    int automatic_samples() {
        Scene sliced = scene_;
        sliced.method = Method::slice;
        Pipeline pipeline(sliced, data_.data_of(sliced),
                          {.capabilities = capabilities_, .tables = tables_});
        return pipeline.plan().slice.slabs;
    }
    // Returns the tolerance of the made mesh that the scene states, or nothing.
    std::optional<double> stated_tolerance() const {
        if (scene_.made_mesh() == nullptr) return std::nullopt;
        return scene_.made_mesh()->tolerance;
    }
    std::vector<double> all_tolerances() {
        if (scene_.mesh_file() != nullptr) return {0.0};
        made_.tolerance = mesh_settings(scene_).tolerance;
        std::set<double, std::greater<>> tolerances{made_.tolerance};
        if (makes_meshes(scene_))
            tolerances.insert(settings_.tolerances.begin(), settings_.tolerances.end());
        return {tolerances.begin(), tolerances.end()};
    }

    // Tells whether the ladder's bound on the number of tets holds for this mesh: not if the scene
    // states the mesh, nor if the ladder was asked for.
    bool is_bounded(double tolerance) const {
        return settings_.ends_by_itself && tolerance != stated_tolerance();
    }
    std::int64_t most_tets(double tolerance) const {
        const std::int64_t own = mesh_settings(scene_).max_tets;
        return is_bounded(tolerance) ? std::min(settings_.ladder_tets, own) : own;
    }
    std::vector<LadderCost::Step> steps_of(const std::vector<double>& tolerances) const {
        std::vector<LadderCost::Step> steps;
        if (!makes_meshes(scene_)) return steps;
        for (const double each : tolerances)
            steps.push_back({each, most_tets(each), is_bounded(each)});
        return steps;
    }

    void say_how_long(std::size_t slabs, const std::vector<double>& tolerances) const {
        if (!makes_meshes(scene_)) return;
        std::int64_t most = 0;
        for (const double each : tolerances) most = std::max(most, most_tets(each));
        settings_.say(fmt::format(
            "{} numbers of slabs, {} {} of up to {} tets: meshes take about {} of a processor at "
            "most",
            slabs, tolerances.size(), tolerances.size() == 1 ? "mesh" : "meshes", most,
            duration_text(LadderCost::most_seconds(steps_of(tolerances)))));
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
        Scene sliced = scene_;
        sliced.method = Method::slice;
        sliced.slice.samples = samples;
        StudyFrames& frames = *frames_.emplace_back(
            std::make_unique<StudyFrames>(sliced, data_, capabilities_, tables_));
        Crosscheck::Slicing& made = made_.slicings.emplace_back();
        made.samples = samples;
        made.picture = frames.picture();
        made.error = image_error(made.picture, made_.pictures.traced_volume);
        made.bytes = frames.bytes();
    }

    Scene mesh_scene(double tolerance) const {
        Scene projected = scene_;
        projected.method = Method::project;
        if (projected.mesh_file() == nullptr) {
            MeshSettings settings = mesh_settings(scene_);
            settings.tolerance = tolerance;
            settings.max_tets = most_tets(tolerance);
            projected.mesh = settings;
        }
        return projected;
    }

    void project(double tolerance) {
        check_interrupt();
        const Scene scene = mesh_scene(tolerance);
        const Stopwatch watch;
        const DataStore::StoredMesh& stored = data_.mesh(scene);
        const SceneMesh& mesh = stored.data.mesh();
        Crosscheck::Projection& made = made_.projections.emplace_back();
        made.mesh_ms = stored.ms;
        made.tolerance = tolerance;
        made.tets = static_cast<std::int64_t>(mesh.mesh.tets().size());
        if (mesh.report) {
            made.mesh_error = mesh.report->relative_error();
            made.stopped = mesh.report->stopped_by_max_tets;
        }
        StudyFrames& frames = *frames_.emplace_back(
            std::make_unique<StudyFrames>(scene, data_, capabilities_, tables_));
        made.picture = frames.picture();
        made.traced = to_float(references_.get(scene, TraceOf::mesh, data_).image);
        made.mesh_part = image_error(made.traced, made_.pictures.traced_volume);
        made.method_part = image_error(made.picture, made.traced);
        made.error = image_error(made.picture, made_.pictures.traced_volume);
        made.bytes = frames.bytes();
        // A mesh that was found in the folder took stored.ms when it was made; that time counts.
        cost_.add(tolerance, made.tets, std::max(watch.seconds(), stored.ms / 1000));
        end_if_fine_enough();
    }

    // Ends refining once the methods agree or a mesh has too many tets. A mesh that the scene
    // states is drawn even then. If the scene states none, the finest mesh that was made takes its
    // place.
    void end_if_fine_enough() {
        if (!settings_.ends_by_itself) return;
        const Crosscheck::Projection& last = made_.projections.back();
        const double e = image_error(last.picture, made_.slicings.back().picture).all.linf;
        const bool agrees = e <= scene_.max_error && last.tolerance <= made_.tolerance;
        is_ended_ = is_ended_ || agrees || last.stopped;
        if (last.stopped && scene_.made_mesh() == nullptr)
            made_.tolerance = std::max(made_.tolerance, last.tolerance);
    }

    // Predicts the time of timing: a first frame is at least as slow as later ones, and each
    // renderer draws one frame more to warm up.
    double timing_seconds() const {
        double seconds = 0;
        for (const auto& frames : frames_) seconds += frames->first_ms() / 1000;
        return seconds * (settings_.rounds + 1);
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

    // Traces volume and mesh without light: for the pictures that it shows, the report says how
    // much light adds to the difference between mesh and volume.
    void trace_unlit() {
        check_interrupt();
        Scene unlit = mesh_scene(made_.tolerance);
        unlit.lighting.reset();
        made_.pictures.unlit_volume =
            to_float(references_.get(unlit, TraceOf::volume, data_).image);
        made_.pictures.unlit_mesh = to_float(references_.get(unlit, TraceOf::mesh, data_).image);
    }

    const Scene& scene_;
    const CrosscheckSettings& settings_;
    const Capabilities& capabilities_;
    DataStore data_;
    std::shared_ptr<TableCache> tables_ = std::make_shared<TableCache>();
    ReferenceStore references_;
    std::vector<std::unique_ptr<StudyFrames>> frames_;
    LadderCost cost_;
    bool is_ended_ = false;  // no finer meshes are made
    Crosscheck made_;
};

}  // namespace

const ErrorBudget::Part& ErrorBudget::dominant() const {
    return *std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
        return a.error.all.l2 < b.error.all.l2;
    });
}

ErrorBudget error_budget(const FourPictures& pictures) {
    ErrorBudget budget;
    budget.parts = parts_of(pictures);
    budget.raw = difference(pictures.projected, pictures.sliced);
    budget.raw_error = measure(budget.raw);
    const double whole = product(budget.raw, budget.raw);
    for (ErrorBudget::Part& part : budget.parts) {
        part.error = measure(part.e);
        part.share = whole > 0 ? sign_of(part) * product(part.e, budget.raw) / whole : 0;
    }
    for (std::size_t i = 0; i < budget.raw.e.size(); ++i) {
        double sum = 0;
        for (const ErrorBudget::Part& part : budget.parts) sum += sign_of(part) * part.e.e[i];
        budget.residual = std::max(budget.residual, std::abs(budget.raw.e[i] - sum));
    }
    return budget;
}

bool makes_meshes(const Scene& scene) {
    return scene.mesh_file() == nullptr && !mesh_settings(scene).kuhn;
}

Crosscheck crosscheck(const Scene& scene, const CrosscheckSettings& settings,
                      const Capabilities& capabilities) {
    return Crosschecker(scene, settings, capabilities).run();
}

}  // namespace lamina::study
