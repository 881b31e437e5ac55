// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <cmath>

#include "cpu_alone.h"
#include "plan/plan.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

// A scene's facts with trials, as if these numbers of slabs had been tried.
struct Tried {
    Facts facts;
    SampleTrials trials;
    SlabTrial chosen() const { return chosen_slabs(facts, trials); }
};
Tried with_trials(const Scene& scene, std::vector<SlabTrial> trials) {
    const Volume volume = load_volume(scene);
    Facts facts = measure(scene, volume, measure_bricks(volume));
    for (SlabTrial& trial : trials)
        trial.goal = slab_error_goal(scene, facts.max_color, trial.slabs, 1e6);
    return {std::move(facts), {std::move(trials), {}}};
}

Scene automatic_scene(const std::string& target, double max_error, float color = 1) {
    nlohmann::json document = minimal_scene();
    document["render"] = {
        {"target", target}, {"max_error", max_error}, {"slice", {{"classification", "post"}}}};
    document["transfer_function"]["points"][1]["color"] = {color, 0, 0};
    document["transfer_function"]["points"][0]["color"] = {0, 0, 1};
    return read_scene(document, "s");
}

TEST(SlabChoice, TakesTheFewestSlabsWithinTheErrorOrTheBestTried) {
    const Scene scene = automatic_scene("float32", 1);
    const SlabTrial most{200, .2, 9}, enough{100, .9, 9}, too_few{50, 3.6, 9};
    EXPECT_EQ(with_trials(scene, {most, too_few, enough}).chosen().slabs, 100);
    EXPECT_EQ(with_trials(scene, {too_few}).chosen().slabs, 50);
    EXPECT_EQ(with_trials(scene, {{70, 2, 9}, too_few}).chosen().slabs, 70);
    const Tried tried = with_trials(scene, {enough});
    const Plan plan = make_plan(scene, tried.facts, cpu_alone(), {}, tried.trials);
    EXPECT_EQ(plan.slice.slabs, 100);
    EXPECT_EQ(plan.slice.slab_trial->error, .9);
}

TEST(SlabChoice, SlabsGetWhatCompositingLeavesOfTheError) {
    Scene scene = automatic_scene("fixed8", 1);
    const double all = static_cast<double>(scene.width) * scene.height;
    const auto goal = [&](double share = 1) { return slab_error_goal(scene, 1, 100, share * all); };
    // The scene gives the compositing, so the slabs may use nearly all of max_error: less a little
    // for errors of the pictures that trials compare with, and more if not all rays are tried.
    EXPECT_LT(goal(), 1);
    EXPECT_GT(goal(), .9);
    EXPECT_EQ(goal(2), goal());
    EXPECT_NEAR(goal(1. / 16), goal() / 2, 1e-9);
    scene.slice.tree = automatic;
    // The root of a tree of one level is rounded to a code once.
    EXPECT_LT(goal(), .5);
    EXPECT_GT(goal(), .45);
    scene.max_error = .5;  // the choice of the tree will refuse this
    EXPECT_GT(goal(), 0);
}

// Errors of second order fall to a quarter and a ninth with twice and three times the slabs. Errors
// at steps fall to a half and a third, or go up and down.
TEST(SlabChoice, ErrorsOfSecondOrderAreRecognized) {
    EXPECT_TRUE(are_of_second_order({{100, 9, 1}, {300, 1, 1}, {200, 2.2, 1}}));
    EXPECT_TRUE(are_of_second_order({{100, 9, 1}}));
    EXPECT_FALSE(are_of_second_order({{100, 9, 1}, {200, 4.5, 1}}));
    EXPECT_FALSE(are_of_second_order({{100, 9, 1}, {110, 11, 1}, {200, 2.2, 1}}));
    EXPECT_FALSE(are_of_second_order({{100, 9, 1}, {110, 2, 1}}));
    EXPECT_FALSE(are_of_second_order({{100, 0, 1}, {110, 0, 1}}));
}

// Slabs get max_error minus the rounding of the target that is chosen for so many slabs: hardly
// anything with 16 bits, half a code with 8.
TEST(SlabChoice, SlabsGetWhatTheChosenTargetLeavesOfTheError) {
    EXPECT_GT(slab_error_goal(automatic_scene("auto", 1), 1, 100, 1e6), .9);
    const Scene coarse = automatic_scene("auto", 4);
    EXPECT_LT(slab_error_goal(coarse, 1, 100, 1e6), .96 * 3.5);
    EXPECT_GT(slab_error_goal(coarse, 1, 100, 1e6), .96 * 3.4);
    Scene of_factors = coarse;  // no bound is known
    of_factors.slice.tree = TreeSettings{.factors = {8, 8}, .nodes = NodeArithmetic::fixed};
    EXPECT_LE(slab_error_goal(of_factors, 1, 100, 1e6), .96 * .85 * 4);
}

TEST(TargetChoice, TakesTheFewestBytesThatRoundFinelyEnough) {
    const auto target = [](double max_error, float color = 1) {
        const Scene scene = automatic_scene("auto", max_error, color);
        EXPECT_TRUE(scene.target.is_automatic());
        const Tried tried = with_trials(scene, {{40, max_error / 2, 9}});
        const Plan plan = make_plan(scene, tried.facts, cpu_alone(), {}, tried.trials);
        EXPECT_FALSE(plan.slice.target_reason.empty());
        EXPECT_LE(plan.slice.error_bound.value_or(0) + plan.slice.slab_trial->error, max_error);
        return plan.slice.target;
    };
    EXPECT_EQ(target(4), Target::fixed8);
    EXPECT_EQ(target(1), Target::fixed16);
    EXPECT_EQ(target(4, 1.5f), Target::float16);  // fixed-point targets clamp colours above 1
    EXPECT_EQ(target(.001), Target::float32);
}

TEST(TargetChoice, TakesFloat32ForTetsAndGivenTreesOfShaderNodes) {
    Scene scene = automatic_scene("auto", 4);
    const Tried tried = with_trials(scene, {});
    scene.slice.tree = TreeSettings{.factors = {8, 8}, .nodes = NodeArithmetic::shader};
    EXPECT_EQ(choose_target(scene, tried.facts, tried.trials).target, Target::float32);
    (*scene.slice.tree)->nodes = NodeArithmetic::fixed;
    EXPECT_EQ(choose_target(scene, tried.facts, tried.trials).target, Target::fixed16);
    EXPECT_EQ(choose_project_target(scene).target, Target::float32);
    expect_error([] { automatic_scene("automatic", 1); }, {"render.target", "\"auto\""});
}

}  // namespace
}  // namespace lamina
