// SPDX-License-Identifier: Apache-2.0
#include "parallel/fragment_code.h"

#include <gtest/gtest.h>

#include "random_picture.h"

namespace lamina {
namespace {

TEST(ActiveRuns, AreAllPixelsThatShowSomething) {
    for (const int width : {1, 7, 8, 9, 100}) {
        const Image picture = random_picture(width, 20, 7);
        const ActiveRuns runs(picture, {3, 17});
        for (int row = 3; row < 17; ++row) {
            std::vector<bool> shown(static_cast<std::size_t>(width));
            int before = -1;
            for (auto run = runs.begin(row); run != runs.end(row); ++run) {
                EXPECT_GT(run->first, before);  // runs are separated by hidden pixels
                before = run->end;
                for (int column = run->first; column < run->end; ++column)
                    shown[static_cast<std::size_t>(column)] = true;
            }
            for (int column = 0; column < width; ++column) {
                EXPECT_EQ(shown[static_cast<std::size_t>(column)],
                          picture.pixel(column, row)[3] > 0);
            }
        }
    }
}

TEST(ActiveRuns, KeepPixelsWithOneNonzeroChannel) {
    for (int channel = 0; channel < 4; ++channel) {
        Image picture(11, 1);
        picture.pixel(9, 0)[channel] = 1e-30f;
        EXPECT_EQ(ActiveRuns(picture, {0, 1}).pixels(0), 1);
    }
}

}  // namespace
}  // namespace lamina
