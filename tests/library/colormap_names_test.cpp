// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "lamina/color.h"
#include "support/expect_error.h"

namespace lamina {
namespace {

TEST(LibraryColormaps, AreListedWithTheirColors) {
    const std::vector<std::string> names = colormap_names();
    EXPECT_TRUE(std::ranges::find(names, "viridis") != names.end());
    for (const std::string& name : names) {
        const Colormap map = load_colormap(name, ImageColorSpace::display);
        ASSERT_GE(map.colors.size(), 2u) << name;
        EXPECT_LT(map.colors.front().value, map.colors.back().value) << name;
        // The ends of a map are the preset's own colours, converted one by one.
        const Colormap linear = load_colormap(name);
        EXPECT_EQ(color_of_display(map.colors.front().color), linear.colors.front().color) << name;
    }
    EXPECT_TRUE(load_colormap("ct-bone").own_range);
    EXPECT_FALSE(load_colormap("viridis").own_range);
}

TEST(LibraryColormaps, AnUnknownNameSuggestsTheNearest) {
    expect_error([] { load_colormap("virdis"); }, {"viridis"});
}

}  // namespace
}  // namespace lamina
