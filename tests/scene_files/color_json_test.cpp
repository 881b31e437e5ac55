// SPDX-License-Identifier: Apache-2.0
// Tests how scene files give colours: of points, of the background and by colour maps.
#include "scene_files/keys.h"

#include <cmath>
#include <fstream>

#include "lamina/color.h"
#include "optics/colormap.h"
#include "scene/given_transfer.h"
#include "scene_files/scene_keys.h"
#include "scene_files/scene_reader.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

nlohmann::json colored(const nlohmann::json& color, const char* space) {
    nlohmann::json document = with("/transfer_function/points/1/color", color);
    document["image"]["background"] = color;
    if (space != nullptr) document["image"]["color_space"] = space;
    return document;
}

void expect_color(const nlohmann::json& color, const char* space, const glm::dvec3& expected) {
    const Scene scene = read_scene(colored(color, space), "s");
    EXPECT_EQ(scene.transfer_function->knots()[1].optics.color, expected) << color;
    EXPECT_EQ(scene.background, expected) << color;
}

TEST(ColorJson, TriplesAreTakenAsTheyAre) {
    for (const char* const space : {static_cast<const char*>(nullptr), "linear", "display"})
        expect_color({.1, .2, .3}, space, {.1, .2, .3});
}

TEST(ColorJson, DisplayValuesAreDecodedForLinearLight) {
    const glm::dvec3 orange(1, 128 / 255., 25 / 255.);
    for (const nlohmann::json& same :
         {nlohmann::json("#ff8019"), nlohmann::json{{"srgb", {1, 128 / 255., 25 / 255.}}}}) {
        expect_color(same, nullptr, linear_from_srgb(orange));
        expect_color(same, "linear", linear_from_srgb(orange));
        expect_color(same, "display", orange);
    }
    expect_color("tomato", "linear", color_of("#ff6347"));
    expect_color("tomato", "display", glm::dvec3(255, 99, 71) / 255.);
}

TEST(ColorJson, MistakesAreNamed) {
    const auto expect_refused = [](const nlohmann::json& color,
                                   std::initializer_list<std::string> parts) {
        expect_error([&] { read_scene(colored(color, "display"), "s"); }, parts);
    };
    const nlohmann::json bright{{"srgb", {0, 0, 1.5}}}, misspelt{{"srbg", {0, 0, 1}}};
    const nlohmann::json more{{"srgb", {0, 0, 1}}, {"a", 1}};
    expect_refused("tomatoe", {"points.1.color", "tomatoe", "did you mean \"tomato\"?"});
    expect_refused("#12345", {"points.1.color", "#12345", "six hexadecimal digits"});
    expect_refused(7, {"points.1.color", "7", "[r, g, b], \"#rrggbb\""});
    expect_refused(bright, {"points.1.color.srgb", "three numbers from 0 to 1"});
    expect_refused(misspelt, {"points.1.color.srgb", "three finite numbers"});
    expect_refused(more, {"points.1.color.a", "unknown key"});
    expect_refused({0, -1, 0}, {"points.1.color", "components from 0 to 1e30"});
    expect_error([] { read_scene(with("/image/background", "grren"), "s"); },
                 {"image.background", "did you mean \"green\"?"});
    expect_error([] { read_scene(with("/image/color_space", "srgb"), "s"); },
                 {"image.color_space", "\"linear\", \"display\""});
}

nlohmann::json mapped(const nlohmann::json& map, const char* space) {
    nlohmann::json document = with("/image/color_space", space);
    document["transfer_function"] = map;
    return document;
}

TEST(ColorJson, AShippedMapIsStretchedOverTheDataIfNoRangeIsGiven) {
    nlohmann::json map{{"colormap", "greys"}, {"points", {{{"value", 0}, {"extinction", 1}}}}};
    Scene over_data = read_scene(mapped(map, "display"), "s");
    ASSERT_TRUE(has_open_colormap(over_data));
    close_colormap(over_data, {20, 60});
    EXPECT_FALSE(has_open_colormap(over_data));
    EXPECT_EQ(over_data.transfer_function->at(20).color, glm::dvec3(0));
    EXPECT_EQ(over_data.transfer_function->at(60).color, glm::dvec3(1));
    // Tolerance of a few roundings.
    EXPECT_NEAR(over_data.transfer_function->at(40).color.g, .5, 1e-15);
    map["colormap_range"] = {100, 200};
    const auto given = read_scene(mapped(map, "display"), "s").transfer_function;
    EXPECT_EQ(given->at(150).color, glm::dvec3(.5));
    const auto linear = read_scene(mapped(map, "linear"), "s").transfer_function;
    // The points of the resampled map follow it within 5e-4.
    EXPECT_NEAR(linear->at(150).color.g, linear_from_srgb(glm::dvec3(.5)).g, 5e-4);
}

TEST(ColorJson, AnOpenMapIsWrittenAsItIsGiven) {
    const nlohmann::json map{{"unit_length", 2.},
                             {"interpolation", "extinction"},
                             {"colormap", "viridis"},
                             {"points",
                              {{{"value", 0.}, {"extinction", 1.}, {"smooth", true}},
                               {{"value", 2.}, {"opacity", .5}}}}};
    const Scene scene = read_scene(mapped(map, "display"), "s");
    const nlohmann::json written = scene_json(scene);
    EXPECT_EQ(written["transfer_function"], map);
    Scene again = read_scene(written, "s"), first = scene;
    close_colormap(again, {0, 2});
    close_colormap(first, {0, 2});
    EXPECT_EQ(again.transfer_function, first.transfer_function);
}

TEST(ColorJson, DataBeyondAllMapsAreRefusedNamingFileAndKey) {
    const nlohmann::json map{{"colormap", "greys"},
                             {"points", {{{"value", 0}, {"extinction", 1}}}}};
    Scene scene = read_scene(mapped(map, "display"), "dir/s");
    expect_error(
        [&] {
            close_colormap(scene, {0, 1e305});
        },
        {"dir/s: transfer_function.colormap_range: is missing", "go from 0 to 1e+305"});
}

TEST(ColorJson, APresetInUnitsAndAFileKeepTheirRange) {
    const Scene bone = read_scene(mapped({{"colormap", "ct-bone"}}, "display"), "s");
    EXPECT_TRUE(bone.transfer_function->transparent(-1e9, 150));
    EXPECT_TRUE(colormap_file_of(bone).empty());
    const TemporaryFolder folder;
    std::ofstream(folder / "two.json")
        << R"({"RGBPoints": [5, 0, 0, 0, 7, 1, 1, 1], "Points": [5, 0, 0.5, 0, 7, 0.5, 0.5, 0]})";
    const Scene two =
        read_scene(mapped({{"colormap", "two.json"}}, "display"), folder / "scene.json");
    EXPECT_EQ(two.transfer_function->at(6).color, glm::dvec3(.5));
    EXPECT_EQ(colormap_file_of(two), folder / "two.json");
}

TEST(ColorJson, MistakesWithMapsAreNamed) {
    const nlohmann::json no_such{{"colormap", "virdis"}, {"points", nlohmann::json::array()}};
    expect_error([&] { read_scene(mapped(no_such, "linear"), "dir/s"); },
                 {"dir/s", "transfer_function.colormap", "did you mean \"viridis\"?"});
    const nlohmann::json segment = nlohmann::json::parse(R"({"transfer_function":
        {"colormap": "viridis", "points": [{"value": 0, "extinction": 1}]}, "sf": 0, "sb": 1,
        "length": 1})");
    const std::filesystem::path file = "cases.json";
    expect_error([&] { read_integration_case(JsonReader(segment, file)); },
                 {"cases.json", "transfer_function.colormap_range", "is missing", "no data"});
}

}  // namespace
}  // namespace lamina
