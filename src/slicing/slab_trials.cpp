// SPDX-License-Identifier: Apache-2.0
#include "slicing/slab_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "base/client.h"
#include "base/profile.h"
#include "image/difference.h"
#include "plan/choices.h"
#include "plan/planners.h"
#include "slicing/slice_renderer.h"
#include "slicing/trial_truth.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

// Limits of the search for the fewest slabs whose picture keeps the goal: max_error minus all other
// errors (slab_error_goal()). The search:
//
//   too few = 0, enough = none
//   until most_trials pictures are drawn, or nothing lies between too few and enough:
//       error = largest difference of the picture of `slabs` slabs to the truth on traced rays, and
//               to a picture of `finer` times the slabs if not all rays are traced
//       if error <= goal: enough = slabs; stop if it is at least near_aim of the goal
//       else: too few = slabs; stop if twice the slabs left still_left of the error
//       slabs = slabs sqrt(error / (aim goal)), as errors of second order fall
//
// Large pictures are searched on first_rays rays, and from there on most_rays. If errors are not of
// second order, fewer slabs (`fewer`) are tried at the end: they may keep the goal by chance.
struct TrialLimits {
    static constexpr int most_trials = 8;  // pictures in one search
    static constexpr double most_slabs_per_voxel = 16;
    // Lower bound of the largest number: volumes of few voxels along the view may have kinks, too.
    static constexpr int fewest_most_slabs = 1024;

    static constexpr double aim = 0.9;  // share of the goal that is aimed at
    // A search ends when the error is at least this share of the goal: in small pictures, and in
    // large ones, whose trials cost more time than fewer slabs save.
    static constexpr double near_aim_of_small = 0.78, near_aim_of_large = 0.6;
    static constexpr double most_growth = 4;  // max ratio of a trial's slabs to those before
    // If twice the slabs leave more than this share of the error, more slabs do not help.
    static constexpr double still_left = 0.7;
    // Errors below this share of the goal do not tell how many slabs are needed.
    static constexpr double unbelievable = 1e-3;
    // If the error on traced rays is more than this ratio times that between pictures, the trial is
    // doubtful: errors are not of second order alone.
    static constexpr double most_doubt = 1.1;
    // Numbers of slabs that are tried last, as shares of the number that was found.
    static constexpr std::array fewer{0.71, 0.76, 0.81, 0.87, 0.93};

    // Numbers of rays. Pictures of at most all_traced_rays (330 x 248) are compared with the tracer
    // in every pixel. Of larger ones some_traced_rays are traced, which takes a fifth of the time
    // of a usual search's pictures.
    static constexpr double all_traced_rays = 5 << 14;
    static constexpr std::size_t some_traced_rays = 3 << 12;
    static constexpr double first_rays = 1 << 13, most_rays = 1 << 20, filter_rays = 1 << 17;

    // The tracer's tolerance as a share of max_error, and limits within which finer is worth it.
    static constexpr double tracer_share = 0.01, finest_tolerance = 1e-8, coarsest_tolerance = 1e-4;

    // Ratios of the finer picture's slabs to a trial's slabs: the finer picture is drawn with
    // `finer`, and is used for further trials while the ratio is at least `fine_enough`.
    static constexpr int finer = 3;
    static constexpr double fine_enough = 2;
};

double rays_of(const Scene& scene) {
    return static_cast<double>(scene.width) * scene.height;
}

// Draws and judges pictures of up to `most` slabs and `rays` rays. `last`: no search with more rays
// follows. `ready`: the volume as an earlier search prepared it, or null.
class SlabTrials {
  public:
    SlabTrials(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks,
               const Facts& facts, int most, double rays, bool last, TableCache& tables,
               std::shared_ptr<const CpuVolume> ready = nullptr)
        : asked_(scene),
          last_(last),
          scene_(trial_scene(scene, rays)),
          volume_(volume),
          bricks_(bricks),
          facts_(seen_by(scene_, facts)),
          tables_(tables),
          ready_(std::move(ready)),
          most_(most),
          all_traced_(rays_of(scene_) <= TrialLimits::all_traced_rays),
          truth_(volume, *scene.transfer_function,
                 View(*scene_.camera, scene_.width, scene_.height),
                 {.tolerance =
                      std::clamp(TrialLimits::tracer_share * scene.max_error / 255,
                                 TrialLimits::finest_tolerance, TrialLimits::coarsest_tolerance),
                  .lighting = copied_lighting(scene.lighting),
                  .clip = half_spaces(scene.clip)}) {}

    // Searches from `slabs` on. Returns all trials in order.
    std::vector<SlabTrial> run(int slabs, Filter filter) {
        const double near_aim =
            all_traced_ ? TrialLimits::near_aim_of_small : TrialLimits::near_aim_of_large;
        std::vector<SlabTrial> trials;
        double error_of_too_few = std::numeric_limits<double>::infinity();
        int too_few = 0, enough = most_ + 1;
        while (trials.size() < TrialLimits::most_trials && too_few + 1 < enough) {
            slabs = std::clamp(slabs, too_few + 1, enough - 1);
            const SlabTrial trial = trials.emplace_back(try_slabs(slabs, filter));
            const bool kept = trial.keeps_goal();
            if (!kept && slabs >= 2 * too_few &&
                trial.error > TrialLimits::still_left * error_of_too_few)
                break;
            (kept ? enough : too_few) = slabs;
            if (kept && (trial.error >= near_aim * trial.goal || shows_too_little(trial))) break;
            if (!kept) error_of_too_few = trial.error;
            // The error falls with the slabs' square, unless the transfer function has steps.
            const double next =
                std::ceil(slabs * std::sqrt(trial.error / (TrialLimits::aim * trial.goal)));
            slabs =
                static_cast<int>(std::min({next, double(most_), TrialLimits::most_growth * slabs}));
        }
        return trials;
    }

    // Tries two slabs a voxel: what is used if more slabs do not help.
    SlabTrial try_two_a_voxel() {
        return try_slabs(std::min(slabs_per_voxel(facts_, 2), most_), Filter::exact);
    }

    // Tries smaller numbers, which may keep the goal by chance, until one does.
    void try_fewer(int enough, std::vector<SlabTrial>& trials) {
        for (const double share : TrialLimits::fewer) {
            const int slabs = static_cast<int>(std::ceil(share * enough));
            if (std::ranges::find(trials, slabs, &SlabTrial::slabs) != trials.end()) continue;
            if (trials.emplace_back(try_slabs(slabs, Filter::exact)).keeps_goal()) return;
        }
    }

    std::shared_ptr<const CpuVolume> ready() const { return ready_; }

    // Returns the error that the texture units' 8-bit weights alone cause.
    SlabTrial try_filter(int slabs) {
        const Image exact = draw(slabs, Filter::exact, {});
        return trial_of(slabs, image_error(draw(slabs, Filter::hardware, {}), exact).all.linf);
    }

  private:
    // Tells whether the error is near 0 although rays may cross a point of the transfer function.
    // Then they have missed it, and the error does not mean that fewer slabs are enough.
    bool shows_too_little(const SlabTrial& trial) const {
        return facts_.knots > 0 && trial.error < TrialLimits::unbelievable * trial.goal;
    }

    static Facts seen_by(const Scene& scene, Facts facts) {
        measure_view(scene, facts);
        return facts;
    }
    static Scene trial_scene(Scene scene, double rays) {
        const double scale = std::min(1.0, std::sqrt(rays / rays_of(scene)));
        scene.width = std::max(1, static_cast<int>(std::lround(scale * scene.width)));
        scene.height = std::max(1, static_cast<int>(std::lround(scale * scene.height)));
        scene.target = Target::float32;
        scene.slice.tree.reset();
        scene.slice.dither.reset();
        return scene;
    }

    SlabTrial trial_of(int slabs, double error) const {
        const double rays = rays_of(scene_);
        return {slabs,
                error,
                static_cast<std::int64_t>(rays),
                slab_error_goal(asked_, largest_drawn_color(asked_, facts_.max_color), slabs,
                                last_ ? rays : rays_of(asked_)),
                truth_.rays(),
                !last_};
    }

    SlabTrial try_slabs(int slabs, Filter filter) {
        if (all_traced_) {
            if (truth_.empty()) truth_.trace_all();
            return trial_of(slabs, truth_.error_of(draw(slabs, filter, {})));
        }
        draw_fine(slabs);
        const Image picture = draw(slabs, filter, {});
        if (truth_.empty())
            truth_.trace_some(TrialLimits::some_traced_rays, picture, *fine_, points_cover());
        // The finer picture itself has (slabs / fine_slabs_)^2 of the trial's error.
        const double share = static_cast<double>(slabs) / fine_slabs_;
        const double shown = image_error(picture, *fine_).all.linf / (1 - share * share);
        const double traced = truth_.error_of(picture);
        SlabTrial trial = trial_of(slabs, std::max(shown, traced));
        trial.doubtful = traced > TrialLimits::most_doubt * shown || shows_too_little(trial);
        return trial;
    }

    std::vector<float> points_cover() const {
        if (facts_.knots == 0) return {};
        return cover_of_points(bricks_, facts_.grid, *scene_.transfer_function,
                               View(*scene_.camera, scene_.width, scene_.height));
    }

    void draw_fine(int slabs) {
        if (fine_slabs_ >= TrialLimits::fine_enough * slabs) return;
        fine_slabs_ = TrialLimits::finer * slabs;
        OmissionSwitch exact;  // the error of early termination counts for the trial
        exact.kept = {"early_termination"};
        fine_ = draw(fine_slabs_, Filter::exact, exact);
    }

    Image draw(int slabs, Filter filter, const OmissionSwitch& omissions) {
        scene_.slice.samples = slabs;
        scene_.slice.filter = filter;
        Plan plan = plan_slicing(scene_, facts_, cpu_capabilities(), omissions, {}, tables_);
        build_drawn_table(scene_, facts_, plan.slice, tables_);
        CpuSliceRenderer renderer(volume_, *scene_.transfer_function, facts_, plan.slice,
                                  scene_.width, scene_.height, ready_);
        ready_ = renderer.volume();
        const Stage trial("trial");
        Progress progress(fmt::format("trying {} slabs", slabs), renderer.step_count());
        renderer.draw(View(*scene_.camera, scene_.width, scene_.height), &progress);
        return renderer.read();
    }

    const Scene& asked_;
    bool last_;
    Scene scene_;
    const Volume& volume_;
    const MinMaxBricks& bricks_;
    Facts facts_;
    TableCache& tables_;
    std::shared_ptr<const CpuVolume> ready_;  // the volume that earlier pictures prepared
    int most_;
    bool all_traced_;
    TrialTruth truth_;
    int fine_slabs_ = 0;
    std::optional<Image> fine_;
};

bool some_keep_goal(const std::vector<SlabTrial>& trials) {
    return std::ranges::any_of(trials, &SlabTrial::keeps_goal);
}

// Tries up to `most` slabs. Smaller numbers, which are right only by chance (try_fewer()), are
// tried only if all rays are traced: on other rays they may be wrong.
std::vector<SlabTrial> try_numbers(const Scene& scene, const Volume& volume,
                                   const MinMaxBricks& bricks, const Facts& facts, int most,
                                   TableCache& tables) {
    const bool small = rays_of(scene) <= TrialLimits::all_traced_rays;
    SlabTrials first(scene, volume, bricks, facts, most,
                     small ? TrialLimits::all_traced_rays : TrialLimits::first_rays, small, tables);
    SampleTrials trials{first.run(slabs_per_voxel(facts, 1), Filter::exact), {}};
    if (!some_keep_goal(trials.exact)) {
        trials.exact.push_back(first.try_two_a_voxel());
        if (!trials.exact.back().keeps_goal()) return trials.exact;
    }
    const SlabTrial found = chosen_slabs(facts, trials);
    if (!small) {
        SlabTrials second(scene, volume, bricks, facts, most, TrialLimits::most_rays, true, tables,
                          first.ready());
        std::vector<SlabTrial> all = second.run(found.slabs, Filter::exact);
        if (!some_keep_goal(all)) all.push_back(second.try_two_a_voxel());
        return all;
    }
    if (!are_of_second_order(trials.exact)) first.try_fewer(found.slabs, trials.exact);
    return trials.exact;
}

int most_slabs(const Facts& facts) {
    return std::clamp(slabs_per_voxel(facts, TrialLimits::most_slabs_per_voxel),
                      TrialLimits::fewest_most_slabs, max_slabs / TrialLimits::finer);
}

// Returns trials of numbers of slabs quicker than exact segments; empty if none keeps the goal.
std::vector<SlabTrial> try_quicker(const Scene& asked, const Volume& volume,
                                   const MinMaxBricks& bricks, const Facts& facts,
                                   TableCache& tables) {
    const Scene scene = with_classification(asked, {Classification::post, 1, {}});
    const int most = std::min(slabs_per_voxel(facts, quicker_slabs_per_voxel), most_slabs(facts));
    std::vector<SlabTrial> trials = try_numbers(scene, volume, bricks, facts, most, tables);
    if (!some_keep_goal(trials)) trials.clear();
    return trials;
}

// Tells whether texture units' filter may be chosen. They filter NaN differently.
bool may_filter(const Scene& scene, const Facts& facts, const Capabilities& capabilities) {
    return scene.slice.filter.is_automatic() && capabilities.eight_bit_filter &&
           facts.non_finite == 0 && !facts.constant;
}

}  // namespace

SampleTrials try_samples(const Scene& asked, const Volume& volume, const MinMaxBricks& bricks,
                         const Facts& facts, const Capabilities& capabilities, bool many_frames,
                         TableCache& tables) {
    SampleTrials trials;
    const bool shows = !facts.occupied.empty() && facts.far_depth > facts.near_depth;
    if (asked.method != Method::slice || !shows) return trials;
    const Scene scene =
        with_classification(asked, choose_classification(asked, facts, capabilities));
    if (scene.slice.classification == Classification::exact) {
        if (many_frames && may_be_quicker(asked))
            trials.exact = try_quicker(asked, volume, bricks, facts, tables);
        return trials;
    }
    if (scene.slice.samples.is_automatic())
        trials.exact = try_numbers(scene, volume, bricks, facts, most_slabs(facts), tables);
    if (!may_filter(scene, facts, capabilities)) return trials;
    SlabTrials filtered(scene, volume, bricks, facts, most_slabs(facts), TrialLimits::filter_rays,
                        true, tables);
    if (scene.slice.samples.is_given()) {
        trials.hardware = {filtered.try_filter(*scene.slice.samples)};
    } else if (const SlabTrial exact = chosen_slabs(facts, trials); exact.keeps_goal()) {
        trials.hardware = filtered.run(exact.slabs, Filter::hardware);
    }
    return trials;
}

}  // namespace lamina
