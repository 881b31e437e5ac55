// SPDX-License-Identifier: Apache-2.0
// Tests the keys that select a part of a volume's file.
#include "scene_files/scene_reader.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

const Json everything = {{"path", "/a.bin"},     {"array", "pressure"}, {"level", 1},
                         {"channel", 2},         {"time", 3},           {"spacing", {1, 2, .5}},
                         {"origin", {-1, 0, 7}}, {"size", {4, 3, 2}},   {"type", "double"},
                         {"offset", 16},         {"endian", "big"},     {"lookup", "nearest"}};

TEST(VolumeSelection, IsReadAndWrittenBack) {
    const Scene scene = read_scene(with("/volume", everything), "s.json");
    ASSERT_NE(scene.volume_file(), nullptr);
    EXPECT_EQ(scene.volume_file()->path, "/a.bin");
    const VolumeRequest& request = scene.volume_file()->selection;
    EXPECT_EQ(request.array, "pressure");
    EXPECT_EQ(request.level, 1);
    EXPECT_EQ(request.channel, 2);
    EXPECT_EQ(request.time, 3);
    EXPECT_EQ(request.lookup, VolumeLookup::nearest);
    EXPECT_EQ(request.spacing, glm::dvec3(1, 2, .5));
    EXPECT_EQ(request.origin, glm::dvec3(-1, 0, 7));
    ASSERT_TRUE(request.raw);
    EXPECT_EQ(*request.raw, (RawLayout{{4, 3, 2}, "double", 16, true}));
    EXPECT_EQ(Json(scene_json(scene)["volume"]), everything);
}

TEST(VolumeSelection, IsAPathIfNothingIsGiven) {
    const Scene scene = read_scene(with("/volume", {{"path", "/a.nrrd"}}), "s.json");
    EXPECT_EQ(scene.volume_file()->selection, VolumeRequest{});
    EXPECT_EQ(scene_json(scene)["volume"], "/a.nrrd");
}

TEST(VolumeSelection, MistakesNameTheKey) {
    const auto expect = [](const char* key, const Json& value,
                           std::initializer_list<std::string> parts) {
        Json volume = everything;
        volume[key] = value;
        expect_error([&] { read_scene(with("/volume", volume), "s.json"); }, parts);
    };
    expect("channel", -1, {"s.json", "volume.channel", "-1"});
    expect("time", .5, {"volume.time", "0.5"});
    expect("spacing", {1, 0, 1}, {"volume.spacing", "three numbers above 0"});
    expect("size", {4, 3}, {"volume.size", "three whole numbers"});
    expect("size", {4, 3, 0}, {"volume.size", "three whole numbers"});
    expect("type", "half", {"volume.type", "half", "int8, uint8", "double"});
    expect("endian", "middle", {"volume.endian", "\"little\", \"big\""});
    expect("chanel", 1, {"volume.chanel", "channel"});
    Json volume = everything;
    volume.erase("size");
    expect_error([&] { read_scene(with("/volume", volume), "s.json"); }, {"volume.size"});
}

}  // namespace
}  // namespace lamina
