// SPDX-License-Identifier: Apache-2.0
#include "scene_files/scene_reader.h"

#include <filesystem>

#include "base/json_text.h"
#include "support/scene_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// Writes a scene, reads it again, and expects the same transfer function and the same text when it
// is written again.
void expect_kept(const Scene& scene, const std::string& name) {
    const nlohmann::ordered_json written = scene_json(scene);
    const Scene read = read_scene(nlohmann::json::parse(written.dump()), "s");
    EXPECT_EQ(scene_json(read), written) << name;
    const auto before = scene.transfer_function->knots(), after = read.transfer_function->knots();
    ASSERT_EQ(before.size(), after.size()) << name;
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(before[i].value, after[i].value) << name;
        EXPECT_EQ(before[i].optics, after[i].optics) << name;
        EXPECT_EQ(before[i].smooth, after[i].smooth) << name;
    }
}

TEST(SceneJson, KeepsTheScenesThatShip) {
    for (const auto& entry :
         std::filesystem::directory_iterator(LAMINA_SOURCE_DIR "/data/scenes")) {
        nlohmann::json document = load_json(entry.path());
        // Paths of data are replaced, because they do not matter here.
        for (const char* const key : {"volume", "mesh"}) {
            if (document.contains(key) && document[key].is_string()) document[key] = "data";
        }
        expect_kept(read_scene(document, entry.path()), entry.path().string());
    }
}

TEST(SceneJson, KeepsEveryKey) {
    const std::vector<std::pair<std::string, nlohmann::json>> keys{
        {"/nan", "transparent"},
        {"/mesh", {{"path", "/meshes/m.pvd"}, {"time", 3}, {"join", 1e-9}}},
        {"/mesh", {{"tolerance", .1 + .2}, {"max_tets", 77}, {"kuhn", true}}},
        {"/transfer_function/interpolation", "nearest"},
        {"/transfer_function/points/0", {{"value", 0}, {"opacity", 1}}},
        {"/transfer_function/points/0", {{"value", 0}, {"extinction", 1}, {"smooth", true}}},
        {"/camera/projection", "perspective"},
        {"/camera/up", {.1, 1, 1. / 3}},
        {"/camera/fov_y", 33.3},
        {"/clip",
         {{"planes",
           {{{"point", {.1, 0, 1. / 3}}, {"normal", {-2, 0, 1e-9}}},
            {{"point", {0, 0, 0}}, {"normal", {0, 1, 0}}}}}}},
        {"/clip", {{"box", {{"min", {-1, 0, .1}}, {"max", {.7, 1, 1}}}}}},
        {"/image/background", {.1, .2, .3}},
        {"/image/background", "tomato"},
        {"/image/color_space", "display"},
        {"/image/annotations", {{"colorbar", true}, {"labels", true}, {"title", "T"}}},
        {"/image/annotations/colorbar",
         {{"position", "top_left"}, {"size", .7}, {"text", "T"}, {"format", "{:.1f} K"}}},
        {"/image/annotations/scale_bar", {{"format", "{} m"}}},
        {"/image/annotations/box", {{"size", 1. / 3}}},
        {"/image/annotations/title", {{"text", "T"}, {"size", 2}}},
        {"/image/annotations/texts", {{{"text", "a\nb"}, {"position", "right"}}}},
        {"/transfer_function/points/1/color", {{"srgb", {.1, .2, .3}}}},
        {"/render/target", "auto"},
        {"/render/target", "emulated"},
        {"/render/emulate",
         {{"bits", 11}, {"alpha", "stochastic"}, {"over", "fused"}, {"seed", 9}}},
        {"/render/max_error", .3},
        {"/render/slice/samples", 123},
        {"/render/slice/classification", "preintegrated"},
        {"/render/slice/order", "front_to_back"},
        {"/render/slice/filter", "auto"},
        {"/render/slice/filter", "hardware"},
        {"/render/slice/dither", {{"period", "auto"}, {"seed", 4}}},
        {"/render/slice/dither", {{"period", 8}, {"color", true}, {"increment", 3}}},
        {"/render/slice/tree", "auto"},
        {"/render/slice/tree",
         {{"factors", {4, 5}}, {"nodes", "fixed"}, {"code", "phi"}, {"alpha_bits", 16}}},
        {"/render/slice/table", {{"scalar", 99}, {"length", 7}, {"max_length", 1. / 7}}},
        {"/render/project/coloring", "analytic"},
        {"/render/project/interpolation", "linear"},
        {"/render/project/thickness", "dz"},
        {"/render/project/order", "centroid"},
        {"/render/project/geometry", "triangles"},
        {"/render/project/dither", "after_blend"},
        {"/render/project/table",
         {{"scalar", 64}, {"mapping", "log2"}, {"store", "opacity"}, {"format", "float16"}}},
        {"/render/project/table", {{"length", 5}, {"construction", "incremental"}}},
        {"/render/project/tree", {{"factors", {3, 2}}, {"nodes", "fixed"}}},
        {"/render/trace/tolerance", 1e-7},
        {"/lighting", nlohmann::json::object()},
        {"/lighting",
         {{"ambient", .25},
          {"diffuse", 1. / 3},
          {"specular", 0},
          {"power", 64},
          {"smallest_gradient", 1e-7},
          {"lights",
           {{{"direction", {1, 0, -.1}}, {"color", "tomato"}}, {{"color", {0, 1, 2}}}}}}}};
    const nlohmann::ordered_json usual = scene_json(read_scene(minimal_scene(), "s"));
    for (const auto& [key, value] : keys) {
        const Scene scene = read_scene(with(key, value), "s");
        expect_kept(scene, key);
        const bool is_default = key == "/camera/projection";
        EXPECT_EQ(scene_json(scene) == usual, is_default) << key;
    }
}

TEST(SceneJson, IsSavedAsAFile) {
    const TemporaryFolder folder;
    const Scene scene = read_scene(minimal_scene(), "s");
    save_scene(scene, folder / "scene.json");
    const Scene read = read_scene(load_json(folder / "scene.json"), folder / "scene.json");
    EXPECT_EQ(scene_json(read), scene_json(scene));
}

}  // namespace
}  // namespace lamina
