// SPDX-License-Identifier: Apache-2.0
#include "model/document.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "lamina/error.h"
#include "lamina/scene.h"

namespace lamina::view {
namespace {

using Curve = TransferHandle::Curve;

const SymlogAxis editor_axis(0, 10, .01);

Scene document_scene() {
    return parse_scene(
        R"({"version": 1, "volume": {"generate": "gaussians"},
            "transfer_function": {"points": [{"value": 10, "extinction": 0},
                                             {"value": 200, "color": "tomato", "extinction": 0.7}]},
            "camera": {"eye": [3, 1, 2], "center": [0.5, 0.5, 0.5]}})",
        "scene.json");
}

Document opened() {
    Document document;
    document.open(document_scene());
    return document;
}

TEST(Document, OneDragIsOneStep) {
    Document document = opened();
    const TransferFunction before = *document.scene().transfer_function;
    document.transfer().select_only({Curve::density, 1});
    document.transfer().begin_move();
    for (int i = 1; i <= 20; ++i) {
        document.transfer().move({-5. * i, 0}, editor_axis);
        document.transfer_edited("drag");
    }
    document.transfer().end_move();
    document.end_step();
    EXPECT_EQ(document.scene().transfer_function->knots().back().value, 100);
    EXPECT_TRUE(document.dirty());
    document.undo();
    EXPECT_TRUE(document.scene().transfer_function == before);
    EXPECT_FALSE(document.can_undo());
    document.redo();
    EXPECT_EQ(document.scene().transfer_function->knots().back().value, 100);
    EXPECT_FALSE(document.can_redo());
}

TEST(Document, UndoBringsPointsBackThatTheFunctionDoesNotNeed) {
    Document document = opened();
    // On the line between the two points, so it changes nothing.
    document.transfer().add_density(105, .35);
    document.transfer_edited("add");
    document.end_step();
    EXPECT_EQ(document.scene().transfer_function->knots().size(), 2u);
    EXPECT_EQ(document.transfer().curves().density.size(), 3u);
    document.undo();
    EXPECT_EQ(document.transfer().curves().density.size(), 2u);
    document.redo();
    EXPECT_EQ(document.transfer().curves().density.size(), 3u);
}

TEST(Document, ChangesOfSettingsCanBeUndone) {
    Document document = opened();
    const Revisions before = document.revisions();
    document.set_setting("render.target", "fixed8");
    EXPECT_EQ(document.scene().target, Target::fixed8);
    EXPECT_EQ(document.revisions().settings, before.settings + 1);
    EXPECT_EQ(document.revisions().data, before.data);
    EXPECT_THROW(document.set_setting("render.slice.samples", -1), Error);
    document.end_step();
    document.set_setting("render.max_error", .5);
    // A slider that is dragged: one step with the value before.
    document.set_setting("render.max_error", .4);
    EXPECT_EQ(document.undo_name(), "render.max_error");
    document.undo();
    EXPECT_EQ(document.scene().max_error, 1);
    EXPECT_EQ(document.scene().target, Target::fixed8);
    document.undo();
    EXPECT_EQ(document.scene().target, Target::float32);
    EXPECT_FALSE(document.can_undo());
}

TEST(Document, CountsWhatChanges) {
    Document document = opened();
    Revisions before = document.revisions();
    document.set_setting("camera.fov_y", 30);
    EXPECT_EQ(document.revisions().camera, before.camera + 1);
    EXPECT_EQ(document.revisions().settings, before.settings);
    document.set_setting("volume", {{"generate", "sheets"}});
    EXPECT_EQ(document.revisions().data, before.data + 1);
    before = document.revisions();
    document.set_setting("clip.box", {{"min", {0, 0, 0}}, {"max", {1, 1, .5}}});
    EXPECT_EQ(document.revisions().clip, before.clip + 1);
    EXPECT_EQ(document.revisions().settings, before.settings);
    EXPECT_TRUE(document.size_follows_window);
    document.set_setting("image.width", 99);
    EXPECT_FALSE(document.size_follows_window);
}

// A session keeps a mesh that it has read, and makes one again if its settings change.
TEST(Document, CountsAnotherMeshFileOrStepAsOtherData) {
    Document document;
    document.open(parse_scene(R"({"version": 1, "mesh": {"path": "a.pvd", "time": 1},
                                  "render": {"method": "project"}})",
                              "scene.json"));
    for (const auto& [path, value] : {std::pair<std::string, nlohmann::ordered_json>("time", 2),
                                      {"time", 0},
                                      {"", {{"path", "a.pvd"}, {"time", 1}}},
                                      {"path", "b.pvd"}}) {
        const Revisions before = document.revisions();
        document.set_setting(path.empty() ? "mesh" : "mesh." + path, value);
        EXPECT_EQ(document.revisions().data, before.data + 1) << path << " " << value;
    }
    document.open(parse_scene(R"({"version": 1, "volume": {"generate": "gaussians"},
                                  "mesh": {"tolerance": 0.1}, "render": {"method": "project"}})",
                              "scene.json"));
    const Revisions before = document.revisions();
    document.set_setting("mesh.tolerance", .2);
    EXPECT_EQ(document.revisions().data, before.data);
    EXPECT_EQ(document.revisions().settings, before.settings + 1);
}

TEST(Document, UndoKeepsTheView) {
    Document document = opened();
    document.set_setting("render.target", "float16");
    Camera camera = *document.scene().camera;
    camera.eye = {9, 8, 7};
    document.set_camera(camera);
    document.undo();
    EXPECT_EQ(document.scene().camera->eye, glm::dvec3(9, 8, 7));
    document.set_setting("camera.eye", {1, 2, 3});
    document.undo();
    EXPECT_EQ(document.scene().camera->eye, glm::dvec3(9, 8, 7));
}

TEST(Document, ColorsKeepTheirLookInAnotherSpace) {
    Document document = opened();
    const TransferFunction before = *document.scene().transfer_function;
    document.set_setting("image.color_space", "display");
    EXPECT_FALSE(document.scene().transfer_function == before);
    EXPECT_TRUE(document.scene().transfer_function == document.transfer().function());
    document.undo();
    EXPECT_TRUE(document.scene().transfer_function == before);
}

Scene scene_with_open_colormap(const std::string& space) {
    return parse_scene(R"({"version": 1, "volume": {"generate": "gaussians", "size": [8, 8, 8]},
                           "transfer_function": {"colormap": "viridis",
                                                 "points": [{"value": 0, "extinction": 1}]},
                           "image": {"color_space": ")" +
                           space + R"("}})",
                       "scene.json");
}

// Before the first picture, the colours of a map that is stretched over the data are in no function
// that could be converted.
TEST(Document, ColorsOfAnOpenColormapKeepTheirLookInAnotherSpace) {
    const Scene linear = scene_with_open_colormap("linear");
    const Scene display = scene_with_open_colormap("display");
    const Volume volume = load_volume(linear);
    const TransferFunction in_linear = chosen_transfer_function(linear, volume);
    const TransferFunction in_display = chosen_transfer_function(display, volume);
    ASSERT_FALSE(in_linear == in_display);
    Document document;
    document.open(linear);
    document.set_setting("image.color_space", "display");
    EXPECT_TRUE(document.scene().transfer_function.is_automatic());
    EXPECT_TRUE(chosen_transfer_function(document.scene(), volume) == in_display);
    document.undo();
    EXPECT_TRUE(chosen_transfer_function(document.scene(), volume) == in_linear);
}

TEST(Document, TakesTheTransferFunctionChosenFromData) {
    Document document = opened();
    document.choose_transfer_function();
    EXPECT_TRUE(document.scene().transfer_function.is_automatic());
    Scene chosen = document.scene();
    chosen.transfer_function = TransferFunction::linear({{5, {{1, 1, 1}, 3}, false}});
    document.take_chosen(chosen);
    EXPECT_FALSE(document.scene().transfer_function.is_automatic());
    EXPECT_EQ(document.transfer().curves().density.front().extinction, 3);
    document.undo();
    EXPECT_EQ(document.scene().transfer_function->knots().size(), 2u);
}

TEST(Document, WordsAreOneStepThatTheSessionFills) {
    Document document = opened();
    const Scene before = document.scene();
    const Revisions revisions = document.revisions();
    document.adjust({.view = "left"}, "view left");
    EXPECT_EQ(document.revisions().settings, revisions.settings + 1);
    ASSERT_TRUE(document.words());
    EXPECT_EQ(document.words()->view, "left");
    Scene chosen = before;
    chosen.camera->eye = {-9, 1, 1};
    chosen.lighting = Lighting{};
    document.take_chosen(chosen);
    EXPECT_FALSE(document.words());
    EXPECT_EQ(document.scene().camera->eye, chosen.camera->eye);
    EXPECT_EQ(document.scene().lighting, chosen.lighting);
    EXPECT_EQ(document.undo_name(), "view left");
    document.undo();
    EXPECT_EQ(document.scene().camera->eye, before.camera->eye);
    EXPECT_FALSE(document.scene().lighting);
}

TEST(Document, ShowsOpacitiesOfAnOpenColormapForTheirUnitLength) {
    Document document;
    document.open(parse_scene(
        R"({"version": 1, "volume": {"generate": "gaussians"},
            "transfer_function": {"unit_length": 0.1, "colormap": "viridis",
                                  "points": [{"value": 0, "opacity": 0.1},
                                             {"value": 9, "opacity": 0.5}]}})",
        "scene.json"));
    Scene chosen = document.scene();
    chosen.transfer_function =
        TransferFunction::linear_opacity({{0, {1, 1, 1}, .1}, {9, {1, 1, 1}, .5}}, .1);
    document.take_chosen(chosen);
    EXPECT_NEAR(document.transfer().unit_length(), .1, 1e-9);
}

TEST(Document, AnotherSceneCannotBeUndone) {
    Document document = opened();
    document.set_setting("render.target", "float16");
    document.open(document_scene());
    EXPECT_FALSE(document.can_undo());
    EXPECT_FALSE(document.dirty());
}

}  // namespace
}  // namespace lamina::view
