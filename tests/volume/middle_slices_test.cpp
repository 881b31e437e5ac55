// SPDX-License-Identifier: Apache-2.0
#include "volume/middle_slices.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace lamina {
namespace {

using Rgb = std::array<int, 3>;

Rgb pixel(const CodedImage& image, int column, int row) {
    const std::size_t at = static_cast<std::size_t>(3 * (row * image.width + column));
    return {image.codes[at], image.codes[at + 1], image.codes[at + 2]};
}

TEST(MiddleSlices, ShowEveryPlaneWithItsSecondAxisUp) {
    Grid grid;
    grid.size = {3, 2, 4};
    const auto values = std::make_shared<std::vector<float>>();
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) values->push_back(static_cast<float>(x + 3 * y + 6 * z));
    values->at(2 + 3 * 1 + 6 * 2) = std::numeric_limits<float>::quiet_NaN();
    const Volume volume(grid, SampleType::float32,
                        std::shared_ptr<const void>(values, values->data()));
    const CodedImage image = middle_slices(volume, {0, 25.5});  // code = 10 * value
    EXPECT_EQ(image.width, 3 + 8 + 3 + 8 + 2);
    EXPECT_EQ(image.height, 4);
    const auto grey = [](int code) { return Rgb{code, code, code}; };
    EXPECT_EQ(pixel(image, 0, 3), grey(120));           // x 0, y 0, z 2
    EXPECT_EQ(pixel(image, 1, 2), grey(160));           // x 1, y 1, z 2
    EXPECT_EQ(pixel(image, 11, 3), grey(30));           // x 0, y 1, z 0
    EXPECT_EQ(pixel(image, 11 + 2, 0), grey(230));      // x 2, y 1, z 3
    EXPECT_EQ(pixel(image, 22, 0), grey(190));          // x 1, y 0, z 3
    EXPECT_EQ(pixel(image, 23, 3), grey(40));           // x 1, y 1, z 0
    EXPECT_EQ(pixel(image, 2, 2), pixel(image, 5, 0));  // NaN looks like the room between
    EXPECT_NE(pixel(image, 2, 2)[0], pixel(image, 2, 2)[2]);
}

}  // namespace
}  // namespace lamina
