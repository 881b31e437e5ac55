// SPDX-License-Identifier: Apache-2.0
// docs/scene.schema.json names exactly the keys that the reader asks for.
#include <algorithm>
#include <iterator>
#include <regex>

#include "support/scene_fixture.h"

namespace lamina {
namespace {

const nlohmann::json& root() {
    static const nlohmann::json schema = load_json(LAMINA_SOURCE_DIR "/docs/scene.schema.json");
    return schema;
}

// Paths of all properties below `schema`; list elements have no number of their own.
void collect(const nlohmann::json& schema, const std::string& path, std::set<std::string>& keys) {
    if (schema.contains("$ref")) {
        const std::string pointer = schema["$ref"].get<std::string>().substr(1);
        collect(root().at(nlohmann::json::json_pointer(pointer)), path, keys);
    }
    if (schema.contains("oneOf")) {
        for (const nlohmann::json& variant : schema["oneOf"]) collect(variant, path, keys);
    }
    if (schema.contains("items")) collect(schema["items"], path, keys);
    if (!schema.contains("properties")) return;
    EXPECT_EQ(schema["additionalProperties"], false) << path;
    for (const auto& [key, property] : schema["properties"].items()) {
        const std::string child = path.empty() ? key : path + "." + key;
        keys.insert(child);
        collect(property, child, keys);
    }
}

std::set<std::string> asked_for(const nlohmann::json& document) {
    std::set<std::string> asked, keys;
    try {
        read_scene(document, "s", &asked);
    } catch (const Error&) {  // the colour map that is asked for below does not exist
    }
    for (const std::string& key : asked)
        keys.insert(std::regex_replace(key, std::regex("\\.[0-9]+"), ""));
    return keys;
}

TEST(Schema, NamesTheKeysOfTheReader) {
    std::set<std::string> in_schema;
    collect(root(), "", in_schema);
    std::set<std::string> in_reader = asked_for(minimal_scene());
    // Keys that are asked for only beside others.
    in_reader.merge(asked_for(with("/transfer_function/colormap_range", {0, 1})));
    in_reader.insert("transfer_function.colormap_range");
    const nlohmann::json display{{"srgb", {.1, .2, .3}}};
    in_reader.merge(asked_for(with("/transfer_function/points/0/color", display)));
    in_reader.merge(asked_for(with("/image/background", display)));
    in_reader.merge(asked_for(with("/render/slice/dither", nlohmann::json::object())));
    in_reader.merge(asked_for(with("/render/slice/tree", {{"factors", {4, 4}}})));
    in_reader.merge(asked_for(with("/render/slice/table", nlohmann::json::object())));
    in_reader.merge(asked_for(with("/render/project/table", nlohmann::json::object())));
    in_reader.merge(asked_for(with("/render/project/tree", {{"factors", {4, 4}}})));
    const nlohmann::json place{0, 0, 1};
    in_reader.merge(asked_for(with("/clip", {{"planes", {{{"point", place}, {"normal", place}}}},
                                             {"box", {{"min", place}, {"max", place}}}})));
    in_reader.merge(asked_for(with("/lighting", {{"lights", {{{"color", display}}}}})));
    in_reader.merge(
        asked_for(with("/volume", {{"path", "a.bin"}, {"size", {4, 3, 2}}, {"type", "uint8"}})));
    nlohmann::json mesh = with("/mesh", nlohmann::json::object());
    in_reader.merge(asked_for(mesh));
    in_reader.merge(asked_for(with("/mesh", {{"path", "a.pvd"}})));
    const auto only_in = [](const std::set<std::string>& a, const std::set<std::string>& b) {
        std::vector<std::string> keys;
        std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(keys));
        return keys;
    };
    EXPECT_EQ(only_in(in_schema, in_reader), std::vector<std::string>());
    EXPECT_EQ(only_in(in_reader, in_schema), std::vector<std::string>());
}

TEST(Schema, EverySceneThatShipsIsRead) {
    setenv("LAMINA_DATA", "data", 1);
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(LAMINA_SOURCE_DIR "/data/scenes")) {
        EXPECT_NO_THROW(read_scene(load_json(entry.path()), entry.path())) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 8);
}

}  // namespace
}  // namespace lamina
