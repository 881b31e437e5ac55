// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_reader.h"

#include <cmath>
#include <cstdlib>

#include "optics/opacity.h"
#include "scene/given_transfer.h"
#include "support/expect_error.h"
#include "support/scene_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

TEST(SceneReader, DefaultsAreTheFirstOfTheListedValues) {
    const Scene scene = read_scene(minimal_scene(), "scene.json");
    EXPECT_EQ(scene.method, Method::slice);
    EXPECT_EQ(scene.target, Target::float32);
    EXPECT_EQ(scene.slice.classification, automatic);
    EXPECT_EQ(scene.slice.order, Order::back_to_front);
    EXPECT_EQ(scene.slice.filter, Filter::exact);
    EXPECT_TRUE(scene.slice.samples.is_automatic());
    EXPECT_EQ(scene.camera->projection, Projection::perspective);
    EXPECT_EQ(scene.nan, NanPolicy::error);
    EXPECT_EQ(scene.trace_tolerance, 1e-5);
}

TEST(SceneReader, OpacityBecomesExtinction) {
    nlohmann::json document = with("/transfer_function/unit_length", 4);
    const Scene scene = read_scene(document, "s");
    const auto knots = scene.transfer_function->knots();
    EXPECT_DOUBLE_EQ(knots[1].optics.extinction, std::log(2.) / 4);
}

TransferFunction by_opacity(const nlohmann::json& points, const char* interpolation) {
    nlohmann::json document = with("/transfer_function/points", points);
    document["transfer_function"]["unit_length"] = 4;
    document["transfer_function"]["interpolation"] = interpolation;
    const Scene scene = read_scene(document, "s");
    EXPECT_EQ(!opaque_ramp(scene), std::string(interpolation) != "extinction");
    return *scene.transfer_function;
}

TEST(SceneReader, OpacityIsLinearBetweenTwoPointsThatHaveIt) {
    const nlohmann::json tent = {{{"value", 0}, {"color", {0, 0, 0}}, {"opacity", 0}},
                                 {{"value", 8}, {"color", {1, .5, 0}}, {"opacity", 1}},
                                 {{"value", 16}, {"color", {1, 1, 1}}, {"opacity", 0}}};
    const auto linear = by_opacity(tent, "linear");
    EXPECT_EQ(linear, TransferFunction::linear_opacity(
                          {{0, {0, 0, 0}, 0}, {8, {1, .5, 0}, 1}, {16, {1, 1, 1}, 0}}, 4));
    EXPECT_NEAR(linear.at(6).extinction, std::log(4) / 4,
                std::log(4) / 4 * opacity_slope_tolerance);
    const auto extinction = by_opacity(tent, "extinction");
    EXPECT_EQ(extinction.knots().size(), 3u);
    EXPECT_EQ(extinction.at(4).extinction, 1e7 / 8);
    const auto nearest = by_opacity(tent, "nearest");
    EXPECT_EQ(nearest.at(6).extinction, 1e7 / 4);
    EXPECT_EQ(nearest.at(3).extinction, 0);
}

TEST(SceneReader, OpacityOneIsAWarningWhereExtinctionIsInterpolatedToIt) {
    const nlohmann::json document = with("/transfer_function/points/1/opacity", 1);
    const Scene linear = read_scene(document, "s");
    EXPECT_EQ(linear.transfer_function->knots()[1].optics.extinction, 17);
    EXPECT_EQ(linear.transfer_function->at(255).extinction, 1e7);
    EXPECT_EQ(opaque_ramp(linear),
              "s: transfer_function: extinction is linear from value 0 to 255 and runs to opacity "
              "1, taken as an optical depth of 17 per unit_length");
    Scene changed = linear;
    changed.transfer_function = TransferFunction::linear({TransferKnot{}});
    EXPECT_FALSE(opaque_ramp(changed));
    nlohmann::json nearest = document;
    nearest["transfer_function"]["interpolation"] = "nearest";
    EXPECT_FALSE(opaque_ramp(read_scene(nearest, "s")));
}

TEST(SceneReader, PathsAreRelativeToTheScene) {
    EXPECT_EQ(read_scene(with("/volume", "a/b.nrrd"), "/x/scene.json").volume_file()->path,
              "/x/a/b.nrrd");
    EXPECT_EQ(read_scene(with("/volume", "/a/b.nrrd"), "/x/scene.json").volume_file()->path,
              "/a/b.nrrd");
    setenv("LAMINA_DATA", "/data", 1);
    EXPECT_EQ(
        read_scene(with("/volume", "${LAMINA_DATA}/b.nrrd"), "/x/scene.json").volume_file()->path,
        "/data/b.nrrd");
    unsetenv("LAMINA_DATA");
    EXPECT_THROW(read_scene(with("/volume", "${LAMINA_DATA}/b.nrrd"), "/x/scene.json"), KeyError);
}

TEST(SceneReader, ColormapGivesColorsAndPointsExtinction) {
    const TemporaryFolder folder;
    write_bytes_to(
        folder / "map.json",
        R"([{"Name": "two", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1]}])");
    nlohmann::json document = minimal_scene();
    document["transfer_function"] = {
        {"colormap", "map.json"},
        {"colormap_range", {0, 255}},
        {"points", {{{"value", 0}, {"extinction", 0}}, {{"value", 255}, {"extinction", 2}}}}};
    const TransferFunction read = *read_scene(document, folder / "scene.json").transfer_function;
    EXPECT_DOUBLE_EQ(read.at(255).extinction, 2);
    EXPECT_DOUBLE_EQ(read.at(255).color.g, 1);
    // Expects sRGB .5 in linear light (IEC 61966-2-1), which the resampled map follows within 5e-4.
    EXPECT_NEAR(read.at(127.5).color.g, std::pow((.5 + .055) / 1.055, 2.4), 5e-4);
    EXPECT_DOUBLE_EQ(read.at(127.5).extinction, 1);
    // The difference of its ends is not finite.
    document["transfer_function"]["colormap_range"] = {-1.5e308, 1.5e308};
    expect_error([&] { read_scene(document, folder / "scene.json"); },
                 {"transfer_function.colormap_range", "between -1e300 and 1e300"});
}

// JSON has no .5 and no 5., but people write them, and so do lamina's messages.
TEST(SceneReader, SetTakesNumbersThatBeginOrEndWithAPoint) {
    const auto set = [](const std::string& text) {
        nlohmann::json document = nlohmann::json::object();
        set_key(document, "key", text);
        return document["key"];
    };
    EXPECT_EQ(set(".5"), .5);
    EXPECT_EQ(set("-.25e1"), -2.5);
    EXPECT_EQ(set("5."), 5.);
    EXPECT_EQ(set("[.5,-.5, 2.,10.25]"), nlohmann::json({.5, -.5, 2., 10.25}));
    EXPECT_EQ(set("."), ".");
    EXPECT_EQ(set(".5.5"), ".5.5");
    EXPECT_EQ(set("1.2.3."), "1.2.3.");
    EXPECT_EQ(set("./5.nrrd"), "./5.nrrd");
    EXPECT_EQ(set("a.5"), "a.5");
}

TEST(SceneReader, SetReachesKeysAndListElements) {
    nlohmann::json document = minimal_scene();
    set_key(document, "render.slice.samples", "512");
    set_key(document, "render.target", "fixed8");
    nlohmann::json named{{"volume", "a.nrrd"}};  // stands for an object with a path
    set_key(named, "volume.channel", "1");
    EXPECT_EQ(named["volume"], nlohmann::json({{"path", "a.nrrd"}, {"channel", 1}}));
    EXPECT_THROW(set_key(named, "mesh.scalar", "p"), UsageError);
    set_key(document, "camera.eye", "[1, 2, 3]");
    set_key(document, "transfer_function.points.1.opacity", "0.25");
    const Scene scene = read_scene(document, "s");
    EXPECT_EQ(scene.slice.samples, 512);
    EXPECT_EQ(scene.target, Target::fixed8);
    EXPECT_EQ(scene.camera->eye, glm::dvec3(1, 2, 3));
    EXPECT_DOUBLE_EQ(scene.transfer_function->knots()[1].optics.extinction, -std::log1p(-.25));
    set_key(document, "render.slice.samples", "null");
    set_key(document, "transfer_function.points.1", "null");
    set_key(document, "lighting.power", "null");  // a key that does not exist
    EXPECT_FALSE(document["render"]["slice"].contains("samples"));
    EXPECT_EQ(document["transfer_function"]["points"].size(), 1u);
    EXPECT_FALSE(document.contains("lighting"));
    EXPECT_THROW(set_key(document, "camera.eye.7", "1"), UsageError);
    EXPECT_THROW(set_key(document, "version.x", "1"), UsageError);
    EXPECT_THROW(set_key(document, "", "1"), UsageError);
    EXPECT_THROW(set_key(document, "camera..eye", "1"), UsageError);
}

// The parts of a key make nested objects, which are destroyed recursively: too many would overflow
// the stack.
TEST(SceneReader, SetIsLimitedInDepth) {
    std::string key = "a";
    for (int i = 1; i < 64; ++i) key += ".a";
    nlohmann::json document;
    set_key(document, key, "[[1]]");
    remove_key(document, key);
    for (int i = 0; i < 100'000; ++i) key += ".a";
    const auto message_of = [&](const std::string& name, const std::string& value) -> std::string {
        try {
            set_key(document, name, value);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_TRUE(message_of(key, "1").ends_with("100064 parts between dots, expected at most 64"));
    EXPECT_THROW(remove_key(document, key), UsageError);
    EXPECT_LT(message_of(std::string(200'000, '.'), "1").size(), 250u);
    const std::string lists(100'000, '[');
    EXPECT_TRUE(message_of("b", lists).ends_with("nested more than 64 deep"));
    EXPECT_TRUE(message_of("b", lists + std::string(100'000, ']')).starts_with("--set b: line 1"));
    EXPECT_EQ(message_of("b", "[1"), "");  // not valid JSON, so a string
    EXPECT_EQ(document["b"], "[1");
}

TEST(SceneReader, TurnedCameraKeepsItsDistanceAndHeight) {
    Camera camera;
    camera.eye = {3, 4, 5};
    camera.center = {1, 1, 1};
    camera.up = {0, 2, 0};
    const Camera quarter = turned(camera, 90);
    // (2, 3, 4) turned about +y by 90 degrees: the new x is z, the new z is -x.
    EXPECT_NEAR(quarter.eye.x, 1 + 4, 1e-14);
    EXPECT_NEAR(quarter.eye.y, 4, 1e-14);
    EXPECT_NEAR(quarter.eye.z, 1 - 2, 1e-14);
}

TEST(SceneReader, OmittedKeysAreAutomatic) {
    nlohmann::json document{{"version", 1}, {"volume", {{"generate", "gaussians"}}}};
    Scene scene = read_scene(document, "s.json");
    EXPECT_TRUE(scene.transfer_function.is_automatic() && scene.camera.is_automatic());
    EXPECT_EQ(scene.width, 800);
    EXPECT_EQ(scene.height, 600);
    EXPECT_EQ(scene.method, Method::slice);
    document["transfer_function"] = document["camera"] = "auto";
    document["image"] = {{"height", 30}};
    scene = read_scene(document, "s.json");
    EXPECT_TRUE(scene.transfer_function.is_automatic() && scene.camera.is_automatic());
    EXPECT_EQ(scene.width, 800);
    EXPECT_EQ(scene.height, 30);
    scene = read_scene({{"version", 1}, {"mesh", "m.vtu"}}, "s.json");
    EXPECT_EQ(scene.method, Method::project);
    scene = read_scene(minimal_scene(), "s.json");
    EXPECT_FALSE(scene.transfer_function.is_automatic() || scene.camera.is_automatic());
}

}  // namespace
}  // namespace lamina
