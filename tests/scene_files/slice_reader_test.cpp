// SPDX-License-Identifier: Apache-2.0
// Tests the keys "render.slice.dither", "render.slice.tree", "render.emulate" and
// "render.max_error".
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

Scene read(const std::string& pointer, const nlohmann::json& value) {
    return read_scene(with(pointer, value), "s");
}

TEST(SliceReader, NothingIsDitheredOrInATreeByDefault) {
    const Scene scene = read_scene(minimal_scene(), "s");
    EXPECT_FALSE(scene.slice.dither.has_value());
    EXPECT_FALSE(scene.slice.tree.has_value());
    EXPECT_EQ(scene.max_error, 1);
    EXPECT_EQ(scene.emulate.bits, 8);
    EXPECT_EQ(scene.emulate.alpha, AlphaRounding::truncate);
    EXPECT_EQ(scene.emulate.over, OverRounding::separate);
    EXPECT_EQ(scene.emulate.seed, 1u);
}

TEST(SliceReader, ReadsSettingsOfEmulation) {
    const Scene scene = read(
        "/render",
        {{"target", "emulated"},
         {"max_error", 0.25},
         {"emulate", {{"bits", 16}, {"alpha", "stochastic"}, {"over", "fused"}, {"seed", 0}}}});
    EXPECT_EQ(scene.target, Target::emulated);
    EXPECT_EQ(scene.max_error, 0.25);
    EXPECT_EQ(scene.emulate.bits, 16);
    EXPECT_EQ(scene.emulate.alpha, AlphaRounding::stochastic);
    EXPECT_EQ(scene.emulate.over, OverRounding::fused);
    EXPECT_EQ(scene.emulate.seed, 0u);
    EXPECT_EQ(read("/render/emulate/seed", 4294967295u).emulate.seed, 4294967295u);
    EXPECT_EQ(read("/render/emulate/alpha", "nearest").emulate.alpha, AlphaRounding::nearest);
    EXPECT_EQ(read("/render/emulate/bits", 1).emulate.bits, 1);
}

TEST(SliceReader, ReadsSettingsOfDithering) {
    const auto none = read("/render/slice/dither", nlohmann::json::object()).slice.dither;
    ASSERT_TRUE(none.has_value());
    EXPECT_EQ(none->period, 16);
    EXPECT_EQ(none->seed, 1u);
    EXPECT_FALSE(none->color);
    EXPECT_EQ(none->increment, 1);
    const auto all = read("/render/slice/dither",
                          {{"period", 65536}, {"seed", 7}, {"color", true}, {"increment", 128}})
                         .slice.dither;
    EXPECT_EQ(all->period, 65536);
    EXPECT_EQ(all->seed, 7u);
    EXPECT_TRUE(all->color);
    EXPECT_EQ(all->increment, 128);
    EXPECT_FALSE(read("/render/slice/dither/period", "auto").slice.dither->period.is_given());
}

TEST(SliceReader, ReadsSettingsOfTrees) {
    const auto read_tree = [](const nlohmann::json& value) {
        return *read("/render/slice/tree", value).slice.tree;
    };
    const Auto<TreeSettings> tree = read_tree({{"factors", {32, 16, 2}}});
    ASSERT_TRUE(tree.is_given());
    EXPECT_EQ(tree->factors, (std::vector<int>{32, 16, 2}));
    EXPECT_EQ(tree->nodes, NodeArithmetic::shader);
    EXPECT_EQ(tree->code, NodeCode::minimax);
    EXPECT_EQ(tree->alpha_bits, 8);
    const Auto<TreeSettings> other =
        read_tree({{"factors", {2}}, {"nodes", "fixed"}, {"code", "phi"}, {"alpha_bits", 16}});
    EXPECT_EQ(other->nodes, NodeArithmetic::fixed);
    EXPECT_EQ(other->code, NodeCode::phi);
    EXPECT_EQ(other->alpha_bits, 16);
    EXPECT_TRUE(read_tree("auto").is_automatic());
}

std::vector<int> factors(const nlohmann::json& value) {
    return (*read("/render/slice/tree/factors", value).slice.tree)->factors;
}

TEST(SliceReader, FactorsAreAListANumberOrText) {
    EXPECT_EQ(factors({1, 65536}), (std::vector<int>{1, 65536}));
    EXPECT_EQ(factors(1024), (std::vector<int>{1024}));
    EXPECT_EQ(factors("1024"), (std::vector<int>{1024}));
    EXPECT_EQ(factors("32x16"), (std::vector<int>{32, 16}));
    EXPECT_EQ(factors("4^5"), std::vector<int>(5, 4));
    EXPECT_EQ(factors("8x4^2x2"), (std::vector<int>{8, 4, 4, 2}));
    EXPECT_EQ(factors("2^16"), std::vector<int>(16, 2));
}

TEST(SliceReader, TakesTheTextsOfTheCommandLine) {
    const std::vector<std::pair<const char*, const char*>> settings = {
        {"render.target", "emulated"},          {"render.emulate.bits", "12"},
        {"render.emulate.over", "fused"},       {"render.max_error", "2.5"},
        {"render.slice.dither.period", "auto"}, {"render.slice.dither.color", "true"},
        {"render.slice.tree.factors", "32x32"}, {"render.slice.tree.nodes", "fixed"}};
    nlohmann::json document = minimal_scene();
    for (const auto& [key, value] : settings) set_key(document, key, value);
    const Scene scene = read_scene(document, "s");
    EXPECT_EQ(scene.target, Target::emulated);
    EXPECT_EQ(scene.emulate.bits, 12);
    EXPECT_EQ(scene.emulate.over, OverRounding::fused);
    EXPECT_EQ(scene.max_error, 2.5);
    EXPECT_FALSE(scene.slice.dither->period.is_given());
    EXPECT_TRUE(scene.slice.dither->color);
    EXPECT_EQ((*scene.slice.tree)->factors, (std::vector<int>{32, 32}));
    EXPECT_EQ((*scene.slice.tree)->nodes, NodeArithmetic::fixed);
    for (const char* list : {"[32,32]", "32x32"}) {
        set_key(document, "render.slice.tree.factors", list);
        EXPECT_EQ((*read_scene(document, "s").slice.tree)->factors, (std::vector<int>{32, 32}));
    }
    set_key(document, "render.slice.tree", "auto");
    EXPECT_TRUE(read_scene(document, "s").slice.tree->is_automatic());
}

struct BadValue {
    const char* pointer;
    nlohmann::json value;
    std::vector<std::string> parts;
};

void expect_rejected(const std::vector<BadValue>& cases) {
    for (const BadValue& bad : cases) {
        const std::string message =
            error_of([&] { read_scene(with(bad.pointer, bad.value), "bad.json"); });
        std::string key(bad.pointer + 1);
        std::replace(key.begin(), key.end(), '/', '.');
        EXPECT_EQ(message.find("bad.json: render."), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_NE(message.find(key), std::string::npos) << message;
        for (const std::string& part : bad.parts)
            EXPECT_NE(message.find(part), std::string::npos) << message;
    }
}

TEST(SliceReader, BadValuesNameKeyFoundAndExpected) {
    const nlohmann::json object = nlohmann::json::object();
    expect_rejected({
        {"/render/slice/dither", 16, {"found 16", "an object"}},
        {"/render/slice/dither/period", 0, {"found 0", "from 1 to 65536"}},
        {"/render/slice/dither/period", 65537, {"found 65537", "from 1 to 65536"}},
        {"/render/slice/dither/period", 1.5, {"found 1.5", "whole number"}},
        {"/render/slice/dither/period", "often", {"found \"often\"", "1 to 65536", "\"auto\""}},
        {"/render/slice/dither/seed", -1, {"found -1", "from 0 to 4294967295"}},
        {"/render/slice/dither/color", "yes", {"found \"yes\"", "true or false"}},
        {"/render/slice/dither/increment", 0, {"found 0", "from 1 to 128"}},
        {"/render/slice/dither/increment", 129, {"found 129", "from 1 to 128"}},
        {"/render/slice/dither/colour", true, {"unknown key", "mean \"color\""}},
        {"/render/slice/tree", "car", {"found \"car\"", "factors", "\"auto\""}},
        {"/render/slice/tree", 32, {"found 32", "\"auto\""}},
        {"/render/slice/tree", {{"factors", 4}, {"nodes", "float"}}, {"\"float\"", "\"shader\""}},
        {"/render/slice/tree", {{"factors", 4}, {"code", "beta"}}, {"\"beta\"", "\"minimax\""}},
        {"/render/slice/tree", {{"factors", 4}, {"alpha_bits", 12}}, {"found 12", "8 or 16"}},
        {"/render/slice/tree", {{"factors", 4}, {"alpha_bits", "8"}}, {"found \"8\"", "8 or 16"}},
        {"/render/slice/tree", {{"factors", 4}, {"alphabits", 8}}, {"unknown", "\"alpha_bits\""}},
        {"/render/emulate/bits", 0, {"found 0", "from 1 to 16"}},
        {"/render/emulate/bits", 17, {"found 17", "from 1 to 16"}},
        {"/render/emulate/alpha", "up", {"found \"up\"", "\"truncate\", \"nearest\""}},
        {"/render/emulate/over", "both", {"found \"both\"", "\"separate\", \"fused\""}},
        {"/render/emulate/seed", -1, {"found -1", "from 0 to 4294967295"}},
        {"/render/emulate/seed", 4294967296, {"found 4294967296", "from 0 to 4294967295"}},
        {"/render/emulate/bit", 8, {"unknown key", "mean \"bits\""}},
        {"/render/max_error", 0, {"found 0", "above 0 and up to 255"}},
        {"/render/max_error", 256, {"found 256", "above 0 and up to 255"}},
        {"/render/max_error", -1, {"found -1", "above 0"}},
        {"/render/max_error", "nan", {"found \"nan\"", "a number"}},
    });
}

TEST(SliceReader, BadFactorsAreShownBesideGoodOnes) {
    const nlohmann::json list = nlohmann::json::array();
    for (const nlohmann::json& bad : {list,
                                      nlohmann::json{0},
                                      nlohmann::json{2.5},
                                      nlohmann::json{4, -4},
                                      nlohmann::json{65537},
                                      nlohmann::json{"4"},
                                      nlohmann::json(std::vector<int>(17, 1)),
                                      nlohmann::json(0),
                                      nlohmann::json(65537),
                                      nlohmann::json(18446744073709551615u),
                                      nlohmann::json(2.5),
                                      nlohmann::json(true),
                                      nlohmann::json("32y32"),
                                      nlohmann::json(""),
                                      nlohmann::json("x32"),
                                      nlohmann::json("32x"),
                                      nlohmann::json("2^17"),
                                      nlohmann::json("4^"),
                                      nlohmann::json("99999999999"),
                                      nlohmann::json("-4"),
                                      nlohmann::json(nullptr)}) {
        expect_rejected(
            {{"/render/slice/tree/factors",
              bad,
              {"found " + bad.dump().substr(0, 50), "1 to 16", "from 1 to 65536", "\"32x32\""}}});
    }
    expect_error([&] { read("/render/slice/tree", nlohmann::json::object()); },
                 {"render.slice.tree.factors: is missing", "[32, 32]"});
}

}  // namespace
}  // namespace lamina
