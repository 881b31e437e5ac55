// SPDX-License-Identifier: Apache-2.0
#include "study/crosscheck.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/expect_error.h"

namespace lamina::study {
namespace {

Image all_of(float value) {
    Image image(4, 3);
    for (float& each : image.rgba) each = value;
    return image;
}

Image noise(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    Image image(7, 5);
    for (float& each : image.rgba) each = value(random);
    return image;
}

TEST(ErrorBudget, PartsAddUpInEveryPixel) {
    const ErrorBudget budget = error_budget({noise(1), noise(2), noise(3), noise(4)});
    ASSERT_EQ(budget.raw.e.size(), 7u * 5 * 4);
    double largest = 0;
    for (std::size_t i = 0; i < budget.raw.e.size(); ++i) {
        const double sum = budget.parts[0].e.e[i] - budget.parts[1].e.e[i] + budget.parts[2].e.e[i];
        // Bound with u = 2^-53: a difference of float32 values up to 1 is exact or rounded by u;
        // times 255, it is rounded by 255 u again. So 4 differences give 4 * 2 * 255 u, and two
        // sums, of up to 510 and 765, give 1275 u: together 3315 u = 3.7e-13.
        EXPECT_NEAR(budget.raw.e[i], sum, 1e-12);
        largest = std::max(largest, std::abs(budget.raw.e[i] - sum));
    }
    EXPECT_LE(budget.residual, 1e-12);
    EXPECT_NEAR(budget.residual, largest, 1e-12);
    EXPECT_GT(budget.raw_error.all.linf, 1);
    // <s1, d> + <s2, d> + <s3, d> = <d, d>: sums of 140 products, each with a relative error of 140
    // u.
    EXPECT_NEAR(budget.parts[0].share + budget.parts[1].share + budget.parts[2].share, 1, 1e-12);
}

// Compares pixel by pixel, with twice the tolerance of the test before: there are two more
// differences.
TEST(ErrorBudget, TellsGradientsOfLitScenesFromTheMesh) {
    FourPictures pictures{noise(1), noise(2), noise(3), noise(4)};
    pictures.unlit_volume = noise(5);
    pictures.unlit_mesh = noise(6);
    const ErrorBudget budget = error_budget(pictures);
    ASSERT_EQ(budget.parts.size(), 4u);
    EXPECT_EQ(budget.parts[3].key, "gradients");
    const ErrorBudget unlit = error_budget({noise(5), noise(6), noise(3), noise(4)});
    EXPECT_EQ(budget.parts[0].e.e, unlit.parts[0].e.e);
    for (std::size_t i = 0; i < budget.raw.e.size(); ++i) {
        const double sum = budget.parts[0].e.e[i] - budget.parts[1].e.e[i] +
                           budget.parts[2].e.e[i] + budget.parts[3].e.e[i];
        EXPECT_NEAR(budget.raw.e[i], sum, 2e-12);
    }
    EXPECT_LE(budget.residual, 2e-12);
    double shares = 0;
    for (const ErrorBudget::Part& part : budget.parts) shares += part.share;
    EXPECT_NEAR(shares, 1, 1e-12);
}

// Mesh and volume differ by 1/16 without lighting and by 4/16 with it.
TEST(ErrorBudget, GradientsCanDominate) {
    FourPictures pictures{all_of(.25F), all_of(.5F), all_of(.25F), all_of(.5F)};
    pictures.unlit_volume = all_of(.5F);
    pictures.unlit_mesh = all_of(.5625F);
    const ErrorBudget budget = error_budget(pictures);
    EXPECT_EQ(budget.dominant().key, "gradients");
    EXPECT_DOUBLE_EQ(budget.parts[3].error.all.linf, 255 * .1875);
    EXPECT_DOUBLE_EQ(budget.parts[3].share, .75);
    EXPECT_DOUBLE_EQ(budget.parts[0].share, .25);
}

// Pictures are constant, so every norm is the difference itself, in 1/255.
TEST(ErrorBudget, FindsTheDominantPart) {
    struct Case {
        FourPictures pictures;
        std::size_t dominant;
        double e[3], shares[3];
    };
    // Multiples of 1/16 are exact. The raw differences are 4/16, 4/16, 4/16 and 1/16.
    const std::vector<Case> cases = {
        {{all_of(.5F), all_of(.75F), all_of(.5F), all_of(.75F)}, 0, {.25, 0, 0}, {1, 0, 0}},
        {{all_of(.5F), all_of(.5F), all_of(.25F), all_of(.5F)}, 1, {0, -.25, 0}, {0, 1, 0}},
        {{all_of(.5F), all_of(.5F), all_of(.5F), all_of(.75F)}, 2, {0, 0, .25}, {0, 0, 1}},
        // Mesh +2/16 and projection -3/16 cancel in part, and slicing -2/16 is subtracted: raw
        // +1/16.
        {{all_of(.5F), all_of(.625F), all_of(.375F), all_of(.4375F)},
         2,
         {.125, -.125, -.1875},
         {2, 2, -3}},
    };
    for (const Case& each : cases) {
        const ErrorBudget budget = error_budget(each.pictures);
        EXPECT_EQ(&budget.dominant(), &budget.parts[each.dominant]);
        for (std::size_t i = 0; i < 3; ++i) {
            const ErrorBudget::Part& part = budget.parts[i];
            EXPECT_DOUBLE_EQ(part.error.all.mean, 255 * each.e[i]);
            EXPECT_DOUBLE_EQ(part.error.all.linf, 255 * std::abs(each.e[i]));
            EXPECT_DOUBLE_EQ(part.error.all.l2, 255 * std::abs(each.e[i]));
            EXPECT_DOUBLE_EQ(part.share, each.shares[i]);
        }
        EXPECT_EQ(budget.residual, 0);
    }
}

// The dominant part has the largest L2, not the largest error in one pixel.
TEST(ErrorBudget, DominantPartHasTheLargestL2) {
    FourPictures pictures{all_of(.5F), all_of(.5F), all_of(.625F), all_of(.5F)};
    pictures.traced_mesh.pixel(1, 1)[0] = pictures.projected.pixel(1, 1)[0] = .75F;
    const ErrorBudget budget = error_budget(pictures);
    EXPECT_GT(budget.parts[0].error.all.linf, budget.parts[1].error.all.linf);
    EXPECT_EQ(budget.dominant().name, "slicing method");
}

TEST(ErrorBudget, EqualPicturesExplainNothing) {
    const ErrorBudget budget = error_budget({noise(1), noise(1), noise(1), noise(1)});
    EXPECT_EQ(budget.raw_error.all.linf, 0);
    for (const ErrorBudget::Part& part : budget.parts) EXPECT_EQ(part.share, 0);
}

TEST(ErrorBudget, PicturesOfDifferentSizesAreAnError) {
    for (Image FourPictures::*picture : {&FourPictures::traced_volume, &FourPictures::traced_mesh,
                                         &FourPictures::sliced, &FourPictures::projected}) {
        FourPictures pictures{all_of(0), all_of(0), all_of(0), all_of(0)};
        pictures.*picture = noise(1);
        expect_error([&] { error_budget(pictures); }, {"7 x 5", "4 x 3"});
    }
}

}  // namespace
}  // namespace lamina::study
