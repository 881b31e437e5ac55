// SPDX-License-Identifier: Apache-2.0
// Compositing trees: LaMar 2004, section 6; docs/numerics.md, section 3.
#include "compositing/tree_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "compositing/codes.h"
#include "compositing/fixed_ray.h"
#include "oracles.h"
#include "support/expect_error.h"

namespace lamina {
namespace {

using Factors = std::vector<int>;

const std::vector<Factors> some_factors = {
    {},       {1},      {2},          {7},       {256},    {1024},   {64, 4},      {4, 64},
    {16, 16}, {32, 32}, {2, 1, 3, 5}, {3, 3, 3}, {10, 10}, {5, 256}, {4, 4, 4, 4}, Factors(10, 2)};

TEST(TreeShape, ChildrenPartitionTheirNode) {
    for (const int first : {0, 17}) {
        for (int n = 1; n <= 70; ++n) {
            for (int k = 1; k <= 80; ++k) {
                int at = first, smallest = n, largest = 0;
                for (int i = 0; i < k; ++i) {
                    const SampleSpan child = child_span({first, n}, i, k);
                    ASSERT_EQ(child.first, at);
                    ASSERT_EQ(child.first, first + i * n / k);  // docs/numerics.md, section 3
                    at = child.end();
                    smallest = std::min(smallest, child.count);
                    largest = std::max(largest, child.count);
                }
                ASSERT_EQ(at, first + n);
                ASSERT_LE(largest - smallest, 1);
            }
        }
    }
    // Products beyond 32 bits.
    const SampleSpan last = child_span({0, 2000000000}, 65535, 65536);
    EXPECT_EQ(last.end(), 2000000000);
    EXPECT_EQ(last.first, static_cast<int>(65535ll * 2000000000 / 65536));
}

struct Counts {
    std::int64_t leaves = 0, deepest_leaf = 0, samples = 0;
};

void count(const TreeShape& tree, int level, const SampleSpan& node, Counts& counts) {
    if (node.count == 0) return;
    if (tree.is_leaf(level, node)) {
        ++counts.leaves;
        counts.samples += node.count;
        counts.deepest_leaf = std::max(counts.deepest_leaf, std::int64_t{node.count});
        return;
    }
    double weights = 0;
    for (int i = 0; i < tree.factor(level); ++i) {
        const SampleSpan child = child_span(node, i, tree.factor(level));
        weights += static_cast<double>(child.count) / node.count;
        count(tree, level + 1, child, counts);
    }
    EXPECT_NEAR(weights, 1, 1e-12);  // at most 65536 additions of one half unit in the last place
}

TEST(TreeShape, CountsAreThoseOfARecursion) {
    for (const Factors& factors : some_factors) {
        for (const int samples : {1, 2, 3, 15, 16, 17, 255, 256, 1000, 1021, 1024}) {
            const TreeShape tree(factors, samples);
            Counts counts;
            count(tree, 0, tree.root(), counts);
            EXPECT_EQ(tree.leaf_count(), counts.leaves) << to_text(factors) << " of " << samples;
            EXPECT_EQ(counts.samples, samples);
            if (tree.levels() > 0) {
                // No leaf has more samples than the last factor.
                EXPECT_LE(counts.deepest_leaf, tree.factor(tree.levels() - 1));
            }
        }
    }
    EXPECT_EQ(TreeShape({4, 4}, 16).leaf_count(), 4);
    EXPECT_EQ(TreeShape({16, 16, 2}, 512).leaf_count(), 256);
    EXPECT_EQ(TreeShape(Factors(10, 2), 1024).leaf_count(), 512);
}

TEST(TreeShape, ALastLevelTakesTheRest) {
    const auto levels_of = [](const Factors& factors, int samples) {
        const TreeShape tree(factors, samples);
        Factors all;
        for (int level = 0; level < tree.levels(); ++level) all.push_back(tree.factor(level));
        return all;
    };
    EXPECT_EQ(levels_of({32}, 1024), (Factors{32, 32}));
    EXPECT_EQ(levels_of({32}, 1025), (Factors{32, 33}));
    EXPECT_EQ(levels_of({32}, 33), (Factors{32, 2}));
    EXPECT_EQ(levels_of({32, 32}, 1024), (Factors{32, 32}));
    EXPECT_EQ(levels_of({32, 32}, 1000), (Factors{32, 32}));
    EXPECT_EQ(levels_of({}, 1000), (Factors{1000}));
    EXPECT_EQ(levels_of({65536, 65536, 65536, 65536}, 2000000000),
              (Factors{65536, 65536, 65536, 65536}));
}

TEST(TreeShape, ParsesFactors) {
    EXPECT_EQ(parse_factors("32x32"), (Factors{32, 32}));
    EXPECT_EQ(parse_factors("1024"), (Factors{1024}));
    EXPECT_EQ(parse_factors("4^5"), Factors(5, 4));
    EXPECT_EQ(parse_factors("16x8^2"), (Factors{16, 8, 8}));
    EXPECT_EQ(parse_factors("2^3x1x65536"), (Factors{2, 2, 2, 1, 65536}));
    for (const Factors& factors : some_factors) {
        if (factors.empty()) continue;
        EXPECT_EQ(parse_factors(to_text(factors)), factors);
    }
    EXPECT_EQ(to_text({16, 8, 8}), "16x8x8");
}

TEST(TreeShape, RefusesMalformedFactors) {
    for (const std::string text : {"",
                                   "x",
                                   "32x",
                                   "x32",
                                   "32xx32",
                                   "32*32",
                                   "32 x 32",
                                   " 32",
                                   "32 ",
                                   "0",
                                   "4x0",
                                   "-4",
                                   "+4",
                                   "4.5",
                                   "abc",
                                   "65537",
                                   "99999999999999999999",
                                   "4^",
                                   "4^0",
                                   "4^-1",
                                   "^4",
                                   "4^5^2"}) {
        expect_error([&] { parse_factors(text); }, {"\"" + text + "\"", "expected"});
    }
    expect_error([] { parse_factors("2^17"); }, {"2^17", "expected", "16"});
    expect_error([] { parse_factors("2^10x2^7"); }, {"2^10x2^7", "17 levels", "16"});
}

// A second implementation of docs/numerics.md, section 3.
struct Tree {
    std::vector<double> ray;
    Factors factors;
    Emulation emulation;
    std::optional<Dither> dither;
    bool front_to_back;

    std::uint32_t largest() const { return largest_code(emulation.bits); }

    std::uint32_t code(long double opacity) const {
        const auto [whole, rest] = oracle::parts(opacity * largest());
        return whole + (emulation.alpha == AlphaRounding::nearest && rest + 1e-9L >= .5L ? 1 : 0);
    }

    std::uint32_t sample(int slab, long double share) const {
        const long double opacity = oracle::opacity(ray[static_cast<std::size_t>(slab)], share);
        if (!dither) return code(opacity);
        const auto [whole, rest] = oracle::parts(opacity * largest());
        const int rank = oracle::permutation(
            dither->period, dither->seed)[static_cast<std::size_t>(slab % dither->period)];
        return whole + (rank < std::floor(dither->period * rest + 1e-9L) ? 1 : 0);
    }

    // Returns the code of a node with the samples begin .. end - 1.
    std::uint32_t node(std::size_t level, int begin, int end) const {
        const int n = end - begin;
        std::vector<std::uint32_t> alphas;  // from the front
        if (n == 1 || level + 1 >= factors.size()) {
            for (int slab = begin; slab < end; ++slab) alphas.push_back(sample(slab, 1.0L / n));
        } else {
            const int k = factors[level];
            for (int i = 0; i < k; ++i) {
                const int from = begin + i * n / k, to = begin + (i + 1) * n / k;
                if (from == to) continue;
                const long double phi =
                    static_cast<long double>(node(level + 1, from, to)) / largest();
                alphas.push_back(
                    code(oracle::opacity(phi, static_cast<long double>(to - from) / n)));
            }
        }
        if (!front_to_back) std::reverse(alphas.begin(), alphas.end());
        const bool fused = emulation.over == OverRounding::fused;
        std::uint32_t result = 0;
        for (const std::uint32_t alpha : alphas) {
            result = front_to_back
                         ? oracle::under(fused, largest(), alpha, result, result, largest())
                         : oracle::over(fused, largest(), alpha, result, largest());
        }
        return result;
    }
};

class TreeFactors : public testing::TestWithParam<Factors> {};

TEST_P(TreeFactors, CodesAreThoseOfARecursion) {
    for (const int samples : {1, 3, 16, 100, 256, 259}) {
        Factors factors = GetParam();
        std::int64_t product = 1;
        for (const int factor : factors) product *= factor;
        if (product < samples) {
            factors.push_back(static_cast<int>((samples + product - 1) / product));
        }
        for (const int bits : {4, 8, 16}) {
            for (const AlphaRounding alpha : {AlphaRounding::truncate, AlphaRounding::nearest}) {
                for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
                    for (const Order order : {Order::back_to_front, Order::front_to_back}) {
                        const Emulation emulation = {bits, alpha, rounding, 1};
                        std::optional<Dither> dither;
                        if (samples != 100) dither = Dither{11, 3, false, 1};
                        const std::vector<double> ray =
                            oracle::random_ray(samples, .99, static_cast<std::uint32_t>(samples));
                        const Tree tree = {ray, factors, emulation, dither,
                                           order == Order::front_to_back};
                        ASSERT_EQ(composite_tree(ray, TreeShape(GetParam(), samples), emulation,
                                                 dither, order),
                                  tree.node(0, 0, samples))
                            << to_text(GetParam()) << " of " << samples << ", " << bits << " bits";
                    }
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Some, TreeFactors, testing::ValuesIn(some_factors));

// Straight compositing is a tree of one level.
TEST(Tree, IsStraightCompositingIfItHasOneLevel) {
    const std::vector<double> ray = oracle::random_ray(200, .999, 5);
    std::vector<RaySample> samples;
    for (const double unit : ray) samples.push_back({1, opacity_over(unit, 1.0 / 200)});
    for (const AlphaRounding alpha :
         {AlphaRounding::truncate, AlphaRounding::nearest, AlphaRounding::stochastic}) {
        for (const Order order : {Order::back_to_front, Order::front_to_back}) {
            for (const std::optional<Dither>& dither : {std::optional<Dither>(), {Dither{}}}) {
                const Emulation emulation = {8, alpha, OverRounding::separate, 4};
                const FixedPixel straight =
                    composite_straight(samples, emulation, dither, order, 7, 8);
                EXPECT_EQ(straight.alpha, straight.color);
                EXPECT_EQ(
                    composite_tree(ray, TreeShape({200}, 200), emulation, dither, order, 7, 8),
                    straight.alpha);
            }
        }
    }
}

// Equal fragments give one opacity in either order (docs/numerics.md, section 2), since OVER of two
// alpha codes does not depend on which is in front.
TEST(Tree, EqualFragmentsGiveTheSameInEitherOrder) {
    for (const int samples : {16, 64, 256}) {
        for (int value = 0; value <= 255; ++value) {
            const double alpha = opacity_over(value / 255.0, 1.0 / samples);
            const std::vector<RaySample> ray(static_cast<std::size_t>(samples), {1, alpha});
            for (const OverRounding rounding : {OverRounding::separate, OverRounding::fused}) {
                const Emulation emulation = {8, AlphaRounding::nearest, rounding, 1};
                EXPECT_EQ(composite_straight(ray, emulation, {}, Order::back_to_front).alpha,
                          composite_straight(ray, emulation, {}, Order::front_to_back).alpha);
            }
        }
    }
}

// LaMar 2004, Table 1 (docs/numerics.md, "Where the papers are wrong"): the values of an 8-bit
// buffer for nine opacities after 64 samples.
TEST(Tree, StraightRaysHaveTheCorrectedValuesOfTable1) {
    const std::vector<std::uint32_t> expected = {0, 0, 64, 64, 96, 136, 183, 220, 255};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double alpha = opacity_over(static_cast<double>(i) / 8, 1.0 / 64);
        const std::vector<RaySample> ray(64, {1, alpha});
        EXPECT_EQ(composite_straight(ray, {}).alpha, expected[i]) << i;
    }
}

using Weight = std::function<double(int child, int node, int children)>;

// Returns the Phi of a node (the opacity of the whole ray if all of it were like the node), in
// double precision.
double phi_of(const std::vector<double>& ray, const TreeShape& tree, const Weight& weight,
              int level, const SampleSpan& node) {
    const bool leaf = tree.is_leaf(level, node);
    const int children = leaf ? node.count : tree.factor(level);
    double transmittance = 1;
    for (int i = 0; i < children; ++i) {
        const SampleSpan child =
            leaf ? SampleSpan{node.first + i, 1} : child_span(node, i, children);
        if (child.count == 0) continue;
        const double phi = leaf ? ray[static_cast<std::size_t>(child.first)]
                                : phi_of(ray, tree, weight, level + 1, child);
        transmittance *= 1 - opacity_over(phi, weight(child.count, node.count, children));
    }
    return 1 - transmittance;
}

double by_share(int child, int node, int) {
    return static_cast<double>(child) / node;
}
double by_number(int, int, int children) {
    return 1.0 / children;
}

// Returns the exact opacity, from the mean optical depth.
double exact_opacity(const std::vector<double>& ray) {
    long double depth = 0;
    for (const double unit : ray) depth -= std::log1p(-static_cast<long double>(unit));
    return static_cast<double>(-std::expm1(-depth / static_cast<long double>(ray.size())));
}

TEST(Tree, HasTheExactOpacityForEverySplit) {
    for (const Factors& factors : some_factors) {
        for (const int samples : {1, 16, 1000, 1021, 1024, 4096}) {
            const std::vector<double> ray = oracle::random_ray(samples, .9, 3);
            const TreeShape tree(factors, samples);
            // A node of k children multiplies k transmittances in 2 k roundings of 2^-53 at most. A
            // level of nodes adds these errors to its Phi, and the mean over children keeps them.
            // They cancel in part, as in a random walk: the tolerance is five standard deviations
            // (2^-53 / sqrt 3 each).
            double steps = 0;
            for (int level = 0; level < tree.levels(); ++level) steps += 3 * tree.factor(level);
            EXPECT_NEAR(phi_of(ray, tree, by_share, 0, tree.root()), exact_opacity(ray),
                        1e-15 + 5 * 0x1p-53 / std::sqrt(3.) * std::sqrt(steps))
                << to_text(factors) << " of " << samples;
        }
    }
}

// Weights of 1 / (number of children) are wrong for children of unequal sizes; equal samples do not
// show it.
TEST(Tree, NeedsWeightsForUnequalChildren) {
    std::vector<double> ray(5, 0.0);
    ray[0] = ray[1] = .999;  // the smaller of two children
    const TreeShape tree({2, 3}, 5);
    const double exact = exact_opacity(ray);
    EXPECT_NEAR(phi_of(ray, tree, by_share, 0, tree.root()), exact, 1e-15);
    EXPECT_GT(std::abs(phi_of(ray, tree, by_number, 0, tree.root()) - exact), .03);
    const std::vector<double> homogeneous(5, .7);
    EXPECT_NEAR(phi_of(homogeneous, tree, by_number, 0, tree.root()), .7, 1e-15);
}

}  // namespace
}  // namespace lamina
