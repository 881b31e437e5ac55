// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "compositing/tree_shape.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

constexpr std::array every_target = {Target::float32, Target::float16, Target::fixed16,
                                     Target::fixed8, Target::emulated};

TreeQuestion question_of(Target target, int slabs, double max_error = 1) {
    TreeQuestion question;
    question.target = target;
    question.slabs = question.visible_slabs = slabs;
    question.max_error = max_error;
    return question;
}

TEST(TreeChoice, BoundsGrowWithSlabsAndStayBelowFullScale) {
    for (const Target target : every_target) {
        for (double (*const bound)(const TreeQuestion&) :
             {straight_error_bound, one_level_error_bound}) {
            double last = 0;
            for (int slabs = 1; slabs <= 65536; slabs *= 2) {
                const double now = bound(question_of(target, slabs));
                EXPECT_GE(now, last) << name_of(target) << ", " << slabs;
                EXPECT_GT(now, 0);
                EXPECT_LE(now, 255);
                last = now;
            }
        }
    }
}

// Returns the smaller bound. In float32 it may be either, because storing less often gains nothing.
double best_bound(const TreeQuestion& question) {
    return std::min(one_level_error_bound(question), straight_error_bound(question));
}

void expect_one_node(const TreeQuestion& question, const TreeChoice& choice) {
    ASSERT_TRUE(choice.tree.has_value());
    EXPECT_EQ(choice.tree->factors, (std::vector<int>{question.slabs}));
    EXPECT_EQ(choice.error_bound, one_level_error_bound(question));
    EXPECT_FALSE(choice.reason.empty());
}

TEST(TreeChoice, OneLevelMeetsTheErrorOrNamesTheBestBound) {
    for (const Target target :
         {Target::float32, Target::float16, Target::fixed16, Target::fixed8}) {
        for (const double max_error : {1., 2., 4., 8.}) {
            const TreeQuestion question = question_of(target, 1024, max_error);
            expect_one_node(question, choose_tree(question));
            EXPECT_LE(choose_tree(question).error_bound, max_error);
        }
        // A thousandth of the error of one rounding to the target.
        const double too_little = one_level_error_bound(question_of(target, 1)) / 1000;
        const TreeQuestion question = question_of(target, 1024, too_little);
        if (target == Target::float32) {  // no target is more exact
            expect_one_node(question, choose_tree(question));
            continue;
        }
        expect_error([&] { choose_tree(question); },
                     {fmt::format("render.max_error: {:.4g} cannot be kept", too_little),
                      fmt::format("{:.4g}", best_bound(question)), name_of(target)});
    }
}

// If slabs leave too little of max_error, the target is still accepted if compositing by itself
// keeps max_error.
TEST(TreeChoice, CompositingIsJudgedAloneIfSlabsMissTheError) {
    for (const double slab_error : {.9, 1., 7.}) {
        for (const Target target : {Target::float32, Target::float16, Target::fixed8}) {
            TreeQuestion question = question_of(target, 1024);
            question.slab_error = slab_error;
            expect_one_node(question, choose_tree(question));
        }
        TreeQuestion coarse = question_of(Target::fixed8, 1024, .4);
        coarse.slab_error = slab_error;
        expect_error([&] { choose_tree(coarse); }, {"render.max_error: 0.4 cannot be kept"});
    }
}

// Each remedy that a message names keeps max_error, and no other is named.
TEST(TreeChoice, NamesExactlyTheRemediesThatHelp) {
    const auto message = [](const TreeQuestion& question) -> std::string {
        try {
            choose_tree(question);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    TreeQuestion bright = question_of(Target::fixed8, 100);
    bright.largest_color = 3;
    EXPECT_TRUE(message(bright).ends_with(
        "and clamps colours (up to 3) to 1: take colours up to 1, or target float16 or float32"))
        << message(bright);
    bright.max_error = .3;  // half precision: 3 * 255 * 2^-11 = .37; eight bits: .5
    EXPECT_TRUE(message(bright).ends_with(": take target float32")) << message(bright);
    bright.target = Target::float16;
    EXPECT_EQ(message(bright).find("clamp"), std::string::npos) << message(bright);
    EXPECT_TRUE(message(bright).ends_with("take a larger max_error, or target float32"));
    bright.target = Target::emulated;
    bright.emulation.bits = 12;
    // With 16 bits, 4 roundings of half a code a slab are .78 / 255 (100 * 2 / 65535 * 255), but
    // colours stay clamped.
    EXPECT_TRUE(message(bright).ends_with(": take target float32")) << message(bright);
    bright.max_error = 1;
    bright.emulation.bits = 16;
    EXPECT_TRUE(message(bright).ends_with(": take colours up to 1, or target float16 or float32"))
        << message(bright);
    bright.largest_color = 1;
    bright.emulation.bits = 12;
    EXPECT_NE(message(bright).find(", or more bits, or fewer slabs, or target "), std::string::npos)
        << message(bright);
}

TEST(TreeChoice, OneSlabNeedsNoTree) {
    const TreeChoice choice = choose_tree(question_of(Target::fixed8, 1, 2));
    EXPECT_FALSE(choice.tree.has_value());
    EXPECT_EQ(choice.error_bound, straight_error_bound(question_of(Target::fixed8, 1)));
}

// A single slab has a node if blending rounds more often than max_error allows: a node is rounded
// once.
TEST(TreeChoice, OneSlabHasANodeWhereBlendingMissesTheError) {
    const TreeQuestion question = question_of(Target::fixed8, 1, 1);
    ASSERT_GT(straight_error_bound(question), 1);
    const TreeChoice choice = choose_tree(question);
    EXPECT_EQ(choice.tree.value().factors, std::vector{1});
    EXPECT_LE(choice.error_bound, 1);
}

TEST(TreeChoice, AnEmulatedBufferHasNoTreeAndMayMissTheError) {
    TreeQuestion question = question_of(Target::emulated, 100);
    question.emulation.bits = 16;
    EXPECT_FALSE(choose_tree(question).tree.has_value());
    EXPECT_LE(choose_tree(question).error_bound, 1);
    question.emulation.bits = 8;
    expect_error([&] { choose_tree(question); },
                 {"render.max_error: 1 cannot be kept", "8 bits",
                  fmt::format("{:.4g}", straight_error_bound(question)), "100 visible slabs"});
}

TEST(TreeChoice, ColorsAboveOneAreCutOffByFixedPoint) {
    TreeQuestion question = question_of(Target::fixed8, 1024);
    question.largest_color = 1.5;
    EXPECT_GT(one_level_error_bound(question), 127);
    EXPECT_THROW(choose_tree(question), Error);
    question.target = Target::float16;
    EXPECT_NEAR(one_level_error_bound(question),
                1.5 * one_level_error_bound(question_of(Target::float16, 1024)), 1e-12);
}

// Returns colour and opacity of one ray in double precision.
std::pair<double, double> exact(const std::vector<RaySample>& samples) {
    double color = 0, transmittance = 1;
    for (const RaySample& sample : samples) {
        color += transmittance * sample.alpha * sample.color;
        transmittance *= 1 - sample.alpha;
    }
    return {color, 1 - transmittance};
}

std::vector<RaySample> random_ray(std::mt19937& random, int samples) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double scale = std::pow(10.0, -3 * uniform(random));
    const bool white = uniform(random) < .3, alike = uniform(random) < .3;
    std::vector<RaySample> ray(static_cast<std::size_t>(samples));
    const RaySample first{white ? 1 : uniform(random), scale * uniform(random)};
    for (RaySample& sample : ray) {
        sample = alike ? first : RaySample{white ? 1 : uniform(random), scale * uniform(random)};
    }
    return ray;
}

// Returns the largest error of random rays in codes of the question's emulation, as a share of its
// bound.
double share_of_bound(const TreeQuestion& question) {
    std::mt19937 random(5);
    const double codes = largest_code(question.emulation.bits);
    double largest = 0;
    for (std::uint32_t trial = 0; trial < 2000; ++trial) {
        const std::vector<RaySample> ray = random_ray(random, question.slabs);
        const FixedPixel pixel =
            composite_straight(ray, question.emulation, question.dither, question.order, trial, 0);
        const auto [color, alpha] = exact(ray);
        largest = std::max({largest, std::abs(pixel.color / codes - color),
                            std::abs(pixel.alpha / codes - alpha)});
    }
    return 255 * largest / straight_error_bound(question);
}

// The bound is never exceeded, and it is not trivially large: an error of a quarter of it occurs.
TEST(TreeChoice, CodesStayUnderTheStraightBound) {
    double closest = 0;
    for (const Order order : {Order::back_to_front, Order::front_to_back}) {
        for (const OverRounding over : {OverRounding::separate, OverRounding::fused}) {
            for (const AlphaRounding alpha :
                 {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
                for (const int dither : {0, 1, 3}) {
                    TreeQuestion question = question_of(Target::emulated, 8);
                    question.order = order;
                    question.emulation = {8, alpha, over, 1};
                    if (dither > 0) question.dither = Dither{5, 1, dither > 1, dither};
                    const double share = share_of_bound(question);
                    EXPECT_LE(share, 1) << name_of(order) << name_of(over) << name_of(alpha);
                    closest = std::max(closest, share);
                }
            }
        }
    }
    EXPECT_GT(closest, .25);
}

// A piece of a ray, with its optical depth and its colour, which is not associated.
struct RayPart {
    double depth = 0, color = 0;
};

double rounded(double value, double largest) {
    return std::round(value * largest) / largest;
}

RayPart composited(const std::vector<RayPart>& parts) {
    double transmittance = 1, color = 0, depth = 0;
    for (const RayPart& part : parts) {
        const double alpha = -std::expm1(-part.depth);
        color += transmittance * alpha * part.color;
        transmittance *= 1 - alpha;
        depth += part.depth;
    }
    const double alpha = -std::expm1(-depth);
    return {depth, alpha > 0 ? color / alpha : 0};
}

// Evaluates a node of a tree in double precision, except for the numbers that it stores
// (docs/numerics.md, section 4).
RayPart node_of(const std::vector<RayPart>& ray, const TreeShape& shape, int level, SampleSpan node,
                int alpha_bits) {
    std::vector<RayPart> parts;
    if (shape.is_marched(level, node)) {
        parts.assign(ray.begin() + node.first, ray.begin() + node.end());
    } else {
        for (int i = 0; i < shape.factor(level); ++i) {
            const SampleSpan child = child_span(node, i, shape.factor(level));
            if (child.count > 0) parts.push_back(node_of(ray, shape, level + 1, child, alpha_bits));
        }
    }
    RayPart found = composited(parts);
    if (level == 0) return found;
    const double share = static_cast<double>(node.count) / shape.samples();
    const double code = encode_depth(NodeCode::minimax, found.depth, share);
    const double stored = rounded(code, alpha_bits == 16 ? 65535 : 255);
    return {decode_depth(NodeCode::minimax, stored, share), rounded(found.color, 255)};
}

// Returns a ray of one of three kinds for which the bound must hold: equal samples of any density;
// runs of dense and of thin samples in turns, with the brightest and the darkest colour; and random
// samples.
std::vector<RayPart> hard_ray(int samples, int kind, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<RayPart> ray(static_cast<std::size_t>(samples));
    const double whole = std::exp(10 * unit(random) - 6);  // optical depth
    const int period = 1 + static_cast<int>(20 * unit(random));
    for (int i = 0; i < samples; ++i) {
        const bool odd = i / period % 2 == 1;
        double share = kind == 0 ? 1 : odd ? 1.9 : .1;
        if (kind == 2) share = -std::log(1 - unit(random));
        ray[static_cast<std::size_t>(i)] = {whole * share / samples, kind == 2 ? unit(random)
                                                                     : odd     ? 0.
                                                                               : 1.};
    }
    return ray;
}

TEST(RoundingBound, HoldsForTreesOfTheMinimaxCode) {
    std::mt19937 random(7);
    double closest = 0;
    for (const std::vector<int>& factors :
         {std::vector{32, 32}, {16, 8, 4}, {4, 4, 4, 4, 4}, {2, 300}, {10, 10}}) {
        for (const int alpha_bits : {8, 16}) {
            TreeQuestion question = question_of(Target::fixed8, 700);
            const TreePlan tree{.factors = factors, .alpha_bits = alpha_bits};
            const double bound = rounding_bound(question, tree).value();
            const TreeShape shape(factors, question.slabs);
            for (int i = 0; i < 150; ++i) {
                const std::vector<RayPart> ray = hard_ray(question.slabs, i % 3, random);
                const RayPart exact = composited(ray);
                const RayPart found = node_of(ray, shape, 0, shape.root(), alpha_bits);
                const double exact_alpha = -std::expm1(-exact.depth);
                const double alpha = -std::expm1(-found.depth);
                // The root stores opacity and associated colour.
                const double e = 255 * std::max(std::abs(rounded(alpha, 255) - exact_alpha),
                                                std::abs(rounded(alpha * found.color, 255) -
                                                         exact_alpha * exact.color));
                EXPECT_LE(e, bound) << to_text(factors) << ", " << alpha_bits << " bits, ray " << i;
                closest = std::max(closest, e / bound);
            }
        }
    }
    EXPECT_GT(closest, .2);  // the bound is not trivially large
    EXPECT_LE(closest, 1);
}

TEST(RoundingBound, IsKnownForBlendingAndOneNodeButNotForPhiTrees) {
    const TreeQuestion question = question_of(Target::fixed8, 64);
    EXPECT_EQ(rounding_bound(question, {}), straight_error_bound(question));
    EXPECT_EQ(rounding_bound(question, TreePlan{.factors = {64}, .code = NodeCode::phi}),
              one_level_error_bound(question));
    EXPECT_FALSE(rounding_bound(question, TreePlan{.factors = {8, 8}, .code = NodeCode::phi}));
    EXPECT_FALSE(
        rounding_bound(question, TreePlan{.factors = {64}, .nodes = NodeArithmetic::fixed}));
}

}  // namespace
}  // namespace lamina
