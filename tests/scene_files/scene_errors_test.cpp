// SPDX-License-Identifier: Apache-2.0
// Tests that the message about a bad scene is one line that names file, key, what was found and
// what was expected.
#include "support/expect_error.h"
#include "support/scene_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

struct BadScene {
    const char* pointer;
    nlohmann::json value;
    std::vector<std::string> parts;
};

TEST(SceneErrors, NameFileKeyFoundAndExpected) {
    const std::vector<BadScene> cases = {
        {"/version", 2, {"version: found 2, expected 1"}},
        {"/colour", 1, {"colour: unknown key", "expected one of camera"}},
        {"/render/slice/sample", 8, {"render.slice.sample: unknown key", "\"samples\""}},
        {"/render/slice/samples", 0, {"render.slice.samples: found 0", "from 1 to 65536"}},
        {"/render/slice/samples", "many", {"found \"many\"", "auto"}},
        {"/render/slice/samples", 1.5, {"found 1.5", "whole number"}},
        {"/render/method", "project", {"render.method: found \"project\"", "without a mesh"}},
        {"/render/project/table", 256, {"render.project.table", "\"auto\""}},
        {"/render/project/tree", "oak", {"render.project.tree: found \"oak\"", "\"auto\""}},
        {"/render/project/tree", {{"factors", 0}}, {"render.project.tree.factors: found 0"}},
        {"/render/project/table", {{"scalar", 1}}, {"render.project.table.scalar: found 1"}},
        {"/render/project",
         {{"geometry", "silhouette"}, {"interpolation", "linear"}},
         {"render.project.geometry", "\"triangles\""}},
        {"/render/target", "fixed9", {"render.target", "fixed9", "\"fixed8\""}},
        {"/render/project/order", "random", {"render.project.order", "random"}},
        {"/render/trace/tolerance", 0, {"render.trace.tolerance", "found 0"}},
        {"/clip", 3, {"clip: found 3", "an object"}},
        {"/clip", {{"plane", 1}}, {"clip.plane: unknown key", "\"planes\""}},
        {"/clip/planes", 3, {"clip.planes: found 3", "a list"}},
        {"/clip/planes",
         {{{"point", {0, 0, 0}}, {"normal", {0, 0, 0}}}},
         {"clip.planes.0.normal: found [0,0,0]", "not zero"}},
        {"/clip/planes",
         {{{"point", {0, 0, 0}}}},
         {"clip.planes.0.normal: is missing", "three finite numbers"}},
        {"/clip/planes",
         {{{"point", {0, 0, 1e101}}, {"normal", {0, 0, 1}}}},
         {"clip.planes.0.point", "1e100"}},
        {"/clip/planes",
         nlohmann::json(33, {{"point", {0, 0, 0}}, {"normal", {0, 0, 1}}}),
         {"clip.planes: found 33 planes", "at most 32"}},
        {"/clip/box", {{"min", {0, 0, 0}}}, {"clip.box.max: is missing"}},
        {"/clip/box",
         {{"min", {0, 2, 0}}, {"max", {1, 1, 1}}},
         {"clip.box.max: found [1,1,1]", "clip.box.min, (0, 2, 0)"}},
        {"/image/width", 0, {"image.width: found 0"}},
        {"/image/width", 1000000, {"image.width: found 1000000"}},
        {"/image/height", "tall", {"image.height", "tall"}},
        {"/image/transparent", 1, {"image.transparent: found 1", "true or false"}},
        {"/image/png_bits", 12, {"image.png_bits: found 12", "expected 8 or 16"}},
        {"/image/background", {1, 2}, {"image.background", "three"}},
        {"/lighting", "bright", {"lighting: found \"bright\"", "an object"}},
        {"/lighting", {{"difuse", 1}}, {"lighting.difuse: unknown key", "\"diffuse\""}},
        {"/lighting", {{"ambient", -.1}}, {"lighting.ambient: found -0.1", "0 to 1000"}},
        {"/lighting", {{"diffuse", 1e9}}, {"lighting.diffuse: found 1000000000", "0 to 1000"}},
        {"/lighting", {{"specular", "much"}}, {"lighting.specular: found \"much\""}},
        {"/lighting", {{"power", 0.5}}, {"lighting.power: found 0.5", "1 to 1000"}},
        {"/lighting", {{"smallest_gradient", 0}}, {"lighting.smallest_gradient: found 0"}},
        {"/lighting",
         {{"smallest_gradient", "small"}},
         {"lighting.smallest_gradient: found \"small\"", "\"auto\""}},
        {"/lighting", {{"lights", nlohmann::json::array()}}, {"lighting.lights: found 0 lights"}},
        {"/lighting",
         {{"lights", nlohmann::json::array_t(9, nlohmann::json::object())}},
         {"lighting.lights: found 9 lights", "1 to 8"}},
        {"/lighting",
         {{"lights", {{{"direction", {0, 0, 0}}}}}},
         {"lighting.lights.0.direction: found [0, 0, 0]", "not 0"}},
        {"/lighting",
         {{"lights", {{{"direction", "left"}}}}},
         {"lighting.lights.0.direction: found \"left\"", "\"headlight\""}},
        {"/lighting",
         {{"lights", {{{"color", {1, -1, 1}}}}}},
         {"lighting.lights.0.color: found [1, -1, 1]", "0 to 1000"}},
        {"/camera/eye", {0.5, 0.5, 0.5}, {"camera", "same point"}},
        {"/camera", "automatic", {"camera: found \"automatic\"", "or \"auto\""}},
        {"/transfer_function", 3, {"transfer_function: found 3", "or \"auto\""}},
        {"/camera/up", {0, 0, 0}, {"camera", "up"}},
        {"/camera/up", {1.5, 0.5, 2.5}, {"camera", "up"}},
        {"/camera/fov_y", 180, {"camera.fov_y: found 180"}},
        {"/camera/projection", "orthographic", {"camera.height", "missing"}},
        {"/transfer_function/points/1/opacity",
         1.5,
         {"transfer_function.points.1.opacity: found 1.5", "0 to 1"}},
        {"/transfer_function/points/0/extinction", -1, {"points.0.extinction: found -1", ">= 0"}},
        {"/transfer_function/points/0/value", 300, {"points.1.value: found 255", "at least 300"}},
        {"/transfer_function/points/1/opacity",
         -1e-9,
         {"transfer_function.points.1.opacity: found -1e-09", "0 to 1"}},
        {"/transfer_function/interpolation",
         "lineal",
         {"transfer_function.interpolation", "\"linear\", \"extinction\", \"nearest\""}},
        {"/transfer_function/points/0/opacity", 0.5, {"points.0.extinction", "beside opacity"}},
        {"/transfer_function/points/0/color", {-1, 0, 0}, {"points.0.color", "0 to 1e30"}},
        {"/transfer_function/points",
         nlohmann::json::array(),
         {"transfer_function.points", "at least one"}},
        {"/transfer_function/unit_length", 0, {"unit_length: found 0"}},
        {"/volume", 7, {"volume: found 7"}},
        {"/volume/generate", "teapot", {"volume.generate", "teapot", "gaussians"}},
        {"/volume/size", {16, 16}, {"volume.size"}},
        {"/volume/size", {16, 16, 100000}, {"volume.size", "2048"}},
        {"/nan", "maybe", {"nan: found \"maybe\""}},
    };
    for (const BadScene& bad : cases) {
        const std::string message =
            error_of([&] { read_scene(with(bad.pointer, bad.value), "dir/bad.json"); });
        EXPECT_EQ(message.find("dir/bad.json: "), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        for (const std::string& part : bad.parts)
            EXPECT_NE(message.find(part), std::string::npos) << message;
    }
}

TEST(SceneErrors, NameMissingParts) {
    for (const char* key : {"version", "volume"}) {
        nlohmann::json document = minimal_scene();
        document.erase(key);
        expect_error([&] { read_scene(document, "bad.json"); }, {"bad.json", key, "missing"});
    }
}

TEST(SceneErrors, RefuseImagesThatAreTooLarge) {
    nlohmann::json document = with("/image/width", 32000);
    document["image"]["height"] = 32000;
    expect_error([&] { read_scene(document, "bad.json"); }, {"32000 x 32000", "at most"});
}

TEST(SceneErrors, RefuseImpossiblePaths) {
    for (const std::string& path : {std::string(), std::string("a\0b.nrrd", 8)}) {
        expect_error([&] { read_scene(with("/volume", path), "bad.json"); },
                     {"bad.json", "volume", "the path of a file"});
    }
}

TEST(SceneErrors, NameFilesThatAreNoScenes) {
    const TemporaryFolder folder;
    expect_error([&] { load_json(folder / "none.json"); }, {"none.json", "no such file"});
    expect_error([&] { load_json(folder.path()); }, {"not a file"});
    write_bytes_to(folder / "syntax.json", "{\"version\": 1,\n \"volume\" }");
    expect_error([&] { load_json(folder / "syntax.json"); }, {"syntax.json", "line 2", "column"});
    write_bytes_to(folder / "twice.json", R"({"version": 1, "a": {"b": 1, "b": 2}})");
    expect_error([&] { load_json(folder / "twice.json"); }, {"twice.json", "\"b\"", "twice"});
    write_bytes_to(folder / "deep.json", std::string(100000, '[') + std::string(100000, ']'));
    expect_error([&] { load_json(folder / "deep.json"); }, {"deep.json", "nested more than 64"});
    write_bytes_to(folder / "list.json", "[1]");
    expect_error([&] { read_scene(load_json(folder / "list.json"), folder / "list.json"); },
                 {"list.json", "object"});
}

}  // namespace
}  // namespace lamina
