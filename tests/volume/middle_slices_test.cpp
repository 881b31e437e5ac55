// SPDX-License-Identifier: Apache-2.0
#include "volume/middle_slices.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace lamina {
namespace {

using Rgb = std::array<int, 3>;

constexpr int room = 8, titles = 20;  // pixels: margin of slices, height of a title line

Rgb pixel(const CodedImage& image, int column, int row) {
    const std::size_t at = static_cast<std::size_t>(3 * (row * image.width + column));
    return {image.codes[at], image.codes[at + 1], image.codes[at + 2]};
}

Rgb grey(int code) {
    return {code, code, code};
}

// Returns a volume with the value x + 3 y + 6 z at sample (x, y, z), except one NaN.
Volume counted(Grid grid) {
    grid.size = {3, 2, 4};
    const auto values = std::make_shared<std::vector<float>>();
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) values->push_back(static_cast<float>(x + 3 * y + 6 * z));
    values->at(2 + 3 * 1 + 6 * 2) = std::numeric_limits<float>::quiet_NaN();
    return {grid, SampleType::float32, std::shared_ptr<const void>(values, values->data())};
}

// The four samples along z, the longest axis, take at least 256 pixels, so a sample is 64 x 64
// pixels. The titles are narrower than the slices.
TEST(MiddleSlices, ShowEveryPlaneWithItsSecondAxisUp) {
    constexpr int edge = 64;
    const CodedImage image = middle_slices(counted({}), {0, 25.5});  // code = 10 * value
    EXPECT_EQ(image.width, 4 * room + (3 + 3 + 2) * edge);
    EXPECT_EQ(image.height, 2 * room + titles + 4 * edge);
    const int bottom = image.height - room - edge / 2;  // in the middle of the lowest samples
    const auto at = [&](int left, int u, int v) {
        return pixel(image, left + u * edge + edge / 2, bottom - v * edge);
    };
    const int first = room, second = first + 3 * edge + room, third = second + 3 * edge + room;
    EXPECT_EQ(at(first, 0, 0), grey(120));           // x 0, y 0, z 2
    EXPECT_EQ(at(first, 1, 1), grey(160));           // x 1, y 1, z 2
    EXPECT_EQ(at(second, 0, 0), grey(30));           // x 0, y 1, z 0
    EXPECT_EQ(at(second, 2, 3), grey(230));          // x 2, y 1, z 3
    EXPECT_EQ(at(third, 0, 3), grey(190));           // x 1, y 0, z 3
    EXPECT_EQ(at(third, 1, 0), grey(40));            // x 1, y 1, z 0
    EXPECT_EQ(at(first, 2, 1), (Rgb{20, 40, 160}));  // NaN
    EXPECT_EQ(at(first, 0, 3), grey(255));           // beside the slice
    // Samples are as wide as they are high, to the pixel.
    EXPECT_EQ(pixel(image, first + edge - 1, image.height - room - 1), grey(120));
    EXPECT_EQ(pixel(image, first + edge, image.height - room - 1), grey(130));
    EXPECT_EQ(pixel(image, first, image.height - room - edge), grey(120));
    EXPECT_EQ(pixel(image, first, image.height - room - edge - 1), grey(150));
}

// With spacings of 0.5, 1 and 2 the axes are 1.5, 2 and 8 long. So z is as long as 16 samples of x,
// which get 16 pixels each.
TEST(MiddleSlices, HaveTheAspectOfTheWorld) {
    Grid grid;
    grid.step = {glm::dvec3(0.5, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2)};
    grid.centering.fill(Centering::cell);
    const CodedImage image = middle_slices(counted(grid), {0, 25.5});
    EXPECT_EQ(image.height, 2 * room + titles + 256);
    const int bottom = image.height - room - 1;
    EXPECT_EQ(pixel(image, room + 15, bottom), grey(120));
    EXPECT_EQ(pixel(image, room + 16, bottom), grey(130));
    EXPECT_EQ(pixel(image, room, bottom - 31), grey(120));
    EXPECT_EQ(pixel(image, room, bottom - 32), grey(150));
    EXPECT_EQ(pixel(image, room, bottom - 64), grey(255));
}

TEST(MiddleSlices, LongVolumesFitThePicture) {
    Grid grid;
    grid.size = {5000, 1, 2};
    grid.centering.fill(Centering::cell);
    const auto bytes = std::make_shared<std::vector<std::uint8_t>>(10000, 7);
    const Volume volume(grid, SampleType::uint8, std::shared_ptr<const void>(bytes, bytes->data()));
    const CodedImage image = middle_slices(volume, {7, 7});
    EXPECT_EQ(image.height, 2 * room + titles + 1);  // 2 / 5000 of 1024 pixels, but not less than 1
    EXPECT_EQ(pixel(image, room + 1023, image.height - room - 1), grey(128));
    EXPECT_EQ(pixel(image, room + 1024, image.height - room - 1), grey(255));
}

}  // namespace
}  // namespace lamina
