// SPDX-License-Identifier: Apache-2.0
#include "lamina/settings.h"

#include <gtest/gtest.h>

#include <string>

#include "lamina/scene.h"

namespace lamina {
namespace {

TEST(Auto, IsAutomaticUnlessItIsGiven) {
    Auto<int> samples;
    EXPECT_TRUE(samples.is_automatic() && !samples.is_given());
    EXPECT_EQ(samples.value_or(7), 7);
    samples = 3;
    EXPECT_TRUE(samples.is_given() && !samples.is_automatic());
    EXPECT_EQ(*samples, 3);
    EXPECT_EQ(samples.value_or(7), 3);
    samples = automatic;
    EXPECT_TRUE(samples.is_automatic());
}

TEST(Auto, ComparesWithValuesAndWithAutomatic) {
    const Auto<Filter> open, given = Filter::exact;
    EXPECT_TRUE(open == automatic && given != automatic);
    EXPECT_TRUE(given == Filter::exact && given != Filter::hardware);
    // An automatic value equals no enum value, not even the first.
    EXPECT_FALSE(open == Filter::exact);
    EXPECT_TRUE(open != given && open == Auto<Filter>());
}

TEST(Auto, HasTheWordsOfSceneFiles) {
    EXPECT_EQ(name_of(Auto<Filter>()), std::string("auto"));
    EXPECT_EQ(name_of(Auto<Filter>(Filter::hardware)), std::string("hardware"));
}

TEST(Auto, GivesTheTreeWhoseFactorsAreKnown) {
    SliceSettings slice;
    EXPECT_EQ(given_tree(slice.tree), nullptr);
    slice.tree = automatic;
    EXPECT_TRUE(slice.tree.has_value());
    EXPECT_EQ(given_tree(slice.tree), nullptr);
    slice.tree = TreeSettings{.factors = {4, 2}};
    ASSERT_NE(given_tree(slice.tree), nullptr);
    EXPECT_EQ(given_tree(slice.tree)->factors, (std::vector<int>{4, 2}));
}

}  // namespace
}  // namespace lamina
