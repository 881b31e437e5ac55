// SPDX-License-Identifier: Apache-2.0
#include "model/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lamina/image.h"

namespace lamina::view {
namespace {

Shown shown_of(const Image& picture, const Scene& scene) {
    Shown shown;
    shown.kind = PictureKind::full;
    shown.full = std::make_shared<const Image>(picture);
    auto screen = std::make_shared<ScreenPicture>();
    screen->width = picture.width;
    screen->height = picture.height;
    screen->rgb = screen_codes(picture);
    shown.screen = shown.full_screen = screen;
    shown.resolved = std::make_shared<const Scene>(scene);
    shown.full_revisions.data = 1;
    return shown;
}

Image picture_of(float red) {
    Image picture(3, 2);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) picture.rgba[i] = red;
    return picture;
}

Scene scene_of(const Image& picture) {
    Scene scene;
    scene.width = picture.width;
    scene.height = picture.height;
    return scene;
}

TEST(Comparison, SubtractsAFromB) {
    const Image a = picture_of(.25f);
    Image b = a;
    b.pixel(1, 1)[3] = 2.f / 255;
    b.pixel(2, 0)[0] -= 3.f / 255;
    b.pixel(2, 0)[1] += 1.f / 255;
    const Scene scene = scene_of(a);
    Comparison comparison;
    comparison.by = CompareBy::difference;
    comparison.follow(shown_of(a, scene));
    EXPECT_FALSE(comparison.active());
    EXPECT_EQ(comparison.missing(), "Nothing is pinned");
    comparison.pin(scene, shown_of(a, scene));
    comparison.follow(shown_of(b, scene));
    ASSERT_TRUE(comparison.active());
    const std::vector<float>& e = comparison.difference()->e;
    // Rounding of float32 colours up to 1 (24 bits), in 1/255.
    const float rounding = 255 * 0x1p-24f;
    EXPECT_NEAR(e[2], -3, rounding);
    EXPECT_NEAR(e[4], 2, rounding);
    EXPECT_EQ(e[0], 0);
    EXPECT_NEAR(comparison.norms().linf, 3, rounding);
    EXPECT_NEAR(comparison.norms().l2, std::sqrt((4 + 9 + 1) / 24.), rounding);
    EXPECT_EQ(comparison.shown_range(), 5);
    const auto colors = comparison.colors();
    const std::vector<std::uint8_t> expected = difference_codes(e, 5);
    EXPECT_EQ(colors->rgb, expected);
    EXPECT_EQ(comparison.colors(), colors);  // the same picture is returned, not a new one
    comparison.range = 1;
    EXPECT_NE(comparison.colors(), colors);
}

TEST(Comparison, NeedsTheSameViewAndAFullPicture) {
    const Image a = picture_of(.5f);
    const Scene scene = scene_of(a);
    Comparison comparison;
    comparison.by = CompareBy::wipe;
    comparison.pin(scene, shown_of(a, scene));
    Shown shown = shown_of(a, scene);
    shown.kind = PictureKind::moving;
    comparison.follow(shown);
    EXPECT_EQ(comparison.missing(), "There is no full picture yet");
    Scene other = scene;
    other.camera->eye.x += 1;
    shown = shown_of(a, other);
    comparison.follow(shown);
    EXPECT_EQ(comparison.missing(), "A is not drawn in this view yet");
    // The worker has drawn the pinned settings in this view.
    PinnedPicture again = *comparison.pinned();
    again.scene.camera = other.camera;
    shown.pinned = std::make_shared<const PinnedPicture>(again);
    comparison.follow(shown);
    EXPECT_TRUE(comparison.active());
    // Pin other settings: the worker's picture, which has the earlier ones, does not count.
    comparison.pin(scene, shown_of(a, scene));
    comparison.follow(shown);
    EXPECT_FALSE(comparison.active());
    // Loading other data removes the pinned picture.
    shown.full_revisions.data = 2;
    comparison.follow(shown);
    EXPECT_FALSE(comparison.pinned());
}

TEST(Comparison, CoversTheTracedPixelsOfTheTruth) {
    const Image b = picture_of(.5f);
    const Scene scene = scene_of(b);
    Comparison comparison;
    comparison.by = CompareBy::difference;
    comparison.with = CompareWith::truth;
    Shown shown = shown_of(b, scene);
    comparison.follow(shown);
    EXPECT_EQ(comparison.missing(), "Nothing is traced yet");
    PictureDifference missed{3, 2, std::vector<float>(6, std::numeric_limits<float>::quiet_NaN())};
    missed.e[1] = -.3f;
    shown.missed = std::make_shared<const PictureDifference>(missed);
    shown.error = {.3, 0, .1};
    comparison.follow(shown);
    ASSERT_TRUE(comparison.active());
    EXPECT_EQ(comparison.norms().linf, .3);
    EXPECT_EQ(comparison.shown_range(), .5);
    const auto colors = comparison.colors();
    const std::vector<std::uint8_t> expected = difference_codes(std::vector<float>{-.3f}, .5);
    for (std::size_t i = 0; i < colors->rgb.size(); ++i)
        EXPECT_EQ(colors->rgb[i], i / 3 == 1 ? expected[i - 3] : shown.full_screen->rgb[i]);
}

TEST(FittingRange, IsARoundNumberThatHoldsAll) {
    for (const auto& [largest, range] : {std::pair{.9, 1.},
                                         {1., 1.},
                                         {1.01, 2.},
                                         {2.5, 5.},
                                         {5.5, 10.},
                                         {180., 200.},
                                         {.0123, .02},
                                         {0., 1e-4}}) {
        const PictureDifference difference{
            2, 1, {static_cast<float>(-largest), std::numeric_limits<float>::quiet_NaN()}};
        EXPECT_NEAR(fitting_range(difference), range, 1e-12 * range) << largest;
    }
}

}  // namespace
}  // namespace lamina::view
