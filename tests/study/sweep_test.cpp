// SPDX-License-Identifier: Apache-2.0
#include "study/study_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <set>

#include "support/expect_error.h"

namespace lamina::study {
namespace {

using nlohmann::json;

constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();

// Counts the factorizations of `of` into exactly `levels` factors of at least 2, by recursion.
std::int64_t count_by_recursion(int of, int levels) {
    if (levels == 0) return of == 1 ? 1 : 0;
    std::int64_t count = 0;
    for (int factor = 2; factor <= of; ++factor)
        count += of % factor == 0 ? count_by_recursion(of / factor, levels - 1) : 0;
    return count;
}

void expect_factorizations(int of, int levels) {
    std::int64_t wanted = 0;
    for (int length = 1; length <= levels; ++length) wanted += count_by_recursion(of, length);
    const std::vector<std::vector<int>> all = factorizations(of, levels);
    EXPECT_EQ(static_cast<std::int64_t>(all.size()), wanted) << of << " " << levels;
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), all.size()) << of << " " << levels;
    std::size_t length = 1;
    for (const std::vector<int>& factors : all) {
        EXPECT_GE(factors.size(), length) << "the short ones come first";
        length = factors.size();
        EXPECT_LE(length, static_cast<std::size_t>(levels));
        EXPECT_GE(*std::min_element(factors.begin(), factors.end()), 2);
        EXPECT_EQ(std::accumulate(factors.begin(), factors.end(), 1, std::multiplies<>()), of);
    }
}

std::vector<SweepGrid> read(const json& sweep) {
    const json study{{"sweep", sweep}};
    const std::filesystem::path file = "study.json";
    JsonReader reader(study, file);
    return read_sweep(reader);
}

TEST(Factorizations, CountTheCompositionsForAPowerOfTwo) {
    // Exponents of 2^10 in k factors are compositions of 10 into k parts: there are C(9, k - 1).
    EXPECT_EQ(factorizations(1024, 1).size(), 1u);
    EXPECT_EQ(factorizations(1024, 2).size(), 1u + 9);
    EXPECT_EQ(factorizations(1024, 3).size(), 1u + 9 + 36);
    EXPECT_EQ(factorizations(1024, 4).size(), 1u + 9 + 36 + 84);
    EXPECT_EQ(factorizations(1024, 10).size(), 512u);  // all compositions: 2^9
    EXPECT_EQ(factorizations(1024, 16).size(), 512u);  // no factor may be 1
}

TEST(Factorizations, HaveTheProductAndNoFactorBelowTwoAndNoRepeats) {
    expect_factorizations(1024, 4);
    expect_factorizations(360, 4);
    expect_factorizations(360, 16);
    expect_factorizations(97, 4);
    expect_factorizations(2, 3);
    expect_factorizations(12, 2);
}

TEST(Factorizations, HoldOnlyThePrimeForAPrime) {
    EXPECT_EQ(factorizations(97, 16), (std::vector<std::vector<int>>{{97}}));
}

TEST(Factorizations, AreOrdered) {
    EXPECT_EQ(factorizations(12, 3),
              (std::vector<std::vector<int>>{
                  {12}, {2, 6}, {3, 4}, {4, 3}, {6, 2}, {2, 2, 3}, {2, 3, 2}, {3, 2, 2}}));
}

TEST(SweepGrid, NumbersEveryCombinationTheLastAxisFirst) {
    const SweepGrid grid{{{"a", {1, 2}}, {"b", {"x", "y", "z"}}, {"c", {nullptr, json({4, 4})}}}};
    ASSERT_EQ(grid.count(), 12u);
    std::uint64_t n = 0;
    for (const json& a : grid.axes[0].values) {
        for (const json& b : grid.axes[1].values) {
            for (const json& c : grid.axes[2].values)
                EXPECT_EQ(grid.settings(n++), (Settings{{"a", a}, {"b", b}, {"c", c}}));
        }
    }
}

TEST(SweepGrid, CountSaturates) {
    const SweepAxis four{"a", {1, 2, 3, 4}}, two{"a", {1, 2}};
    SweepGrid grid{std::vector<SweepAxis>(31, four)};
    EXPECT_EQ(grid.count(), std::uint64_t{1} << 62);
    grid.axes.push_back(two);  // 2^63, one too many
    EXPECT_EQ(grid.count(), most);
    grid.axes.insert(grid.axes.end(), 100, four);
    EXPECT_EQ(grid.count(), most);
}

TEST(Sweep, ReadsListsSingleValuesAndFactorizations) {
    const std::vector<SweepGrid> grids =
        read({{{"render.target", {"fixed8", "float32"}},
               {"render.slice.tree", {{"factors", {4, 4}}, {"nodes", "fixed"}}}},
              {{"render.slice.tree.factors", {{"factorizations", 8}, {"levels", 2}}},
               {"image.width", 16}}});
    ASSERT_EQ(grids.size(), 2u);
    EXPECT_EQ(grids[0].count(), 2u);  // an object is one value
    EXPECT_EQ(grids[1].count(), 3u);
    std::set<json> factors;
    for (std::uint64_t n = 0; n < grids[1].count(); ++n)
        factors.insert(*find_setting(grids[1].settings(n), "render.slice.tree.factors"));
    EXPECT_EQ(factors, (std::set<json>{{8}, {2, 4}, {4, 2}}));
}

TEST(Sweep, TakesAllFactorizationsWithoutLevels) {
    EXPECT_EQ(read({{"k", {{"factorizations", 1024}}}})[0].count(), 512u);
}

TEST(Sweep, EmptySweepsAreErrors) {
    expect_error([] { read(json::object()); }, {"study.json", "sweep", "{}"});
    expect_error([] { read(json::array()); }, {"study.json", "sweep", "[]"});
    expect_error([] { read(json::array({json::object()})); }, {"study.json", "sweep.0", "{}"});
    expect_error(
        [] {
            read({{"image.width", json::array()}});
        },
        {"study.json", "sweep.image.width", "[]", "at least one value"});
    expect_error([] { read(5); }, {"study.json", "sweep", "5"});
}

TEST(Sweep, BadFactorizationsAreErrors) {
    for (const json& bad : std::vector<json>{1, 0, -8, 2.5, 65537, "8", nullptr})
        expect_error(
            [&] {
                read({{"k", {{"factorizations", bad}}}});
            },
            {"study.json", "sweep.k.factorizations", "from 2 to 65536"});
    for (const json& bad : std::vector<json>{0, 17, "2"})
        expect_error(
            [&] {
                read({{"k", {{"factorizations", 8}, {"levels", bad}}}});
            },
            {"study.json", "sweep.k.levels", "from 1 to 16"});
    expect_error(
        [] {
            read({{"k", {{"factorizations", 8}, {"level", 2}}}});
        },
        {"sweep.k.level", "did you mean \"levels\""});
}

// A short file must not ask for lists that fill the memory.
TEST(Sweep, MoreFactorizationsThanRunsAreErrors) {
    const json most_of_one{{"factorizations", 65536}};  // it has 2^15 factorizations
    EXPECT_EQ(read({{"a", most_of_one}, {"b", most_of_one}, {"c", most_of_one}})[0].axes.size(),
              3u);
    json four;
    for (const char* const key : {"a", "b", "c", "d"}) four[key] = most_of_one;
    expect_error([&] { read(four); },
                 {"study.json", "sweep.d", "more than 100000 factorizations", "levels"});
    const json one_each = std::vector<json>(4, {{"a", most_of_one}});
    expect_error([&] { read(one_each); }, {"study.json", "sweep.3.a", "more than 100000"});
    expect_error(
        [] {
            read({{"k", {{"factorizations", 60480}}}});
        },  // it has 1096512 factorizations
        {"study.json", "sweep.k", "more than 100000"});
}

TEST(Sweep, GridsOfMoreKeysThanASceneHasAreErrors) {
    json keys;
    for (int i = 0; i < 257; ++i) keys[fmt::format("k{}", i)] = 1;
    expect_error([&] { read(keys); }, {"study.json", "sweep", "257 keys", "at most 256"});
}

TEST(SettingText, IsShort) {
    EXPECT_EQ(setting_text({32, 32}), "32x32");
    EXPECT_EQ(setting_text("fixed8"), "fixed8");
    EXPECT_EQ(setting_text(256), "256");
    EXPECT_EQ(setting_text(nullptr), "");
    EXPECT_EQ(setting_text({0.5, 1}), "[0.5,1]");
    EXPECT_EQ(setting_text(json::array()), "[]");
}

}  // namespace
}  // namespace lamina::study
