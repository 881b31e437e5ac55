// SPDX-License-Identifier: Apache-2.0
#include "model/scene_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

namespace lamina::view {
namespace {

using Json = nlohmann::json;

// Collects the paths of all properties below `here`, a part of the schema, through references,
// lists and alternatives.
void collect(const Json& schema, const Json& here, const std::string& path,
             std::set<std::string>& paths) {
    if (here.contains("$ref")) {
        const std::string word = here.at("$ref").get<std::string>().substr(8);
        // One control shows a colour; the parts of its schema are no keys.
        if (word != "color") collect(schema, schema.at("$defs").at(word), path, paths);
    }
    if (here.contains("properties")) {
        for (const auto& [key, value] : here.at("properties").items()) {
            const std::string below = path.empty() ? key : path + "." + key;
            paths.insert(below);
            collect(schema, value, below, paths);
        }
    }
    if (here.contains("items") && here.at("items").contains("properties"))
        collect(schema, here.at("items"), path + "[]", paths);
    if (here.contains("oneOf"))
        for (const Json& one : here.at("oneOf")) collect(schema, one, path, paths);
}

TEST(SceneKeys, AreAllThatTheSchemaHas) {
    std::ifstream file(LAMINA_SOURCE_DIR "/docs/scene.schema.json");
    const Json schema = Json::parse(file);
    std::set<std::string> wanted, found;
    collect(schema, schema, "", wanted);
    for (const std::string& path : paths_below(scene_keys()))
        if (!path.ends_with("[]")) found.insert(path);
    EXPECT_EQ(found, wanted);
    EXPECT_GT(found.size(), 90u);
}

TEST(SceneKeys, HaveTheirKindsAndLimits) {
    const SettingNode& samples = scene_key("render.slice.samples");
    EXPECT_EQ(samples.kind, SettingKind::whole);
    EXPECT_TRUE(samples.automatic);
    EXPECT_EQ(samples.least, 1);
    EXPECT_EQ(samples.most, 65536);
    EXPECT_EQ(samples.otherwise, "auto");
    EXPECT_EQ(scene_key("render.max_error").kind, SettingKind::number);
    EXPECT_TRUE(scene_key("render.max_error").least_excluded);
    EXPECT_EQ(scene_key("render.target").words.size(), 6u);
    EXPECT_EQ(scene_key("image.background").kind, SettingKind::color);
    EXPECT_EQ(scene_key("camera.eye").kind, SettingKind::vector);
    EXPECT_EQ(scene_key("camera.eye").count, 3u);
    EXPECT_TRUE(scene_key("camera").automatic);
    EXPECT_EQ(scene_key("clip.planes").kind, SettingKind::list);
    EXPECT_TRUE(scene_key("clip.planes[].normal").required);
    EXPECT_EQ(scene_key("render.slice.tree.factors").kind, SettingKind::factors);
    EXPECT_EQ(scene_key("volume").kind, SettingKind::either);
    EXPECT_EQ(scene_key("lighting.lights[].direction").automatic_word, "headlight");
    EXPECT_EQ(scene_key("render.slice.dither.seed").most, 4294967295.);
    EXPECT_EQ(scene_key("version").kind, SettingKind::fixed);
}

}  // namespace
}  // namespace lamina::view
