// SPDX-License-Identifier: Apache-2.0
#include "lamina/annotations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/png.h"
#include "lamina/session.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

Scene annotated_scene(const std::string& annotations, const std::string& more = "") {
    return parse_scene(
        R"({"version": 1, "volume": {"generate": "gaussians", "size": [24, 24, 24]},
            "image": {"width": 300, "height": 200, "annotations": )" +
            annotations + "}" + more + "}",
        "scene.json");
}

const char* const everything =
    R"({"colorbar": true, "scale_bar": true, "axes": true, "box": true, "title": "A title"})";
const char* const given_camera = R"(, "camera": {"eye": [1, 2, 3], "center": [0.5, 0.5, 0.5]})";

SessionOptions with_cpu_engine() {
    SessionOptions options;
    options.context = ContextChoice::cpu;
    return options;
}

TEST(Annotations, ChangeNoNumberOfAPictureAndAreInItsPng) {
    Session plain(annotated_scene("{}", given_camera), with_cpu_engine());
    Session annotated(annotated_scene(everything, given_camera), with_cpu_engine());
    const Image a = plain.draw(), b = annotated.draw();
    EXPECT_EQ(a.annotations, nullptr);
    ASSERT_NE(b.annotations, nullptr);
    EXPECT_EQ(a.rgba, b.rgba);
    EXPECT_EQ(error_of(b, a).linf, 0);
    EXPECT_NE(picture_png(a), picture_png(b));

    const TemporaryFolder folder;
    save_picture(a, folder / "a.exr");
    save_picture(b, folder / "b.exr");
    EXPECT_EQ(compare_files(folder / "a.exr", folder / "b.exr").all.linf, 0);
    EXPECT_EQ(load_picture(folder / "b.exr").image.rgba, to_double(a).rgba);
    save_picture(b, folder / "b.npy");
    EXPECT_EQ(load_picture(folder / "b.npy").image.rgba, to_double(a).rgba);
}

TEST(Annotations, AreThoseOfTheResolvedScene) {
    Session first(annotated_scene(everything), with_cpu_engine());
    const Image a = first.draw();
    Session second(first.resolved_scene(), with_cpu_engine());
    const Image b = second.draw();
    EXPECT_EQ(a.rgba, b.rgba);
    EXPECT_EQ(a.annotations->rgba, b.annotations->rgba);
}

TEST(Annotations, AreBesideTracedPicturesToo) {
    Scene scene = annotated_scene(everything, given_camera);
    scene.width = 48;
    scene.height = 32;
    Session session(scene, with_cpu_engine());
    EXPECT_NE(session.trace().annotations, nullptr);
}

// Objects that an automatic camera fits leave the colour bar's part of the picture free.
TEST(Annotations, GetRoomFromAnAutomaticCamera) {
    Session session(annotated_scene(R"({"colorbar": true, "title": "Above"})"), with_cpu_engine());
    const Image& picture = session.draw();
    const Image& layer = *picture.annotations;
    int shown = 0, both = 0;
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
        shown += picture.rgba[i] > 0.05;
        both += picture.rgba[i] > 0.05 && layer.rgba[i] > 0;
    }
    EXPECT_GT(shown, 300 * 200 / 8);
    EXPECT_EQ(both, 0);
}

TEST(Annotations, AreReadAndWrittenByTheirKeys) {
    const Scene scene = annotated_scene(
        R"({"colorbar": {"position": "left", "format": "{:.1f} K", "text": "T"}, "axes": true,
            "box": {"size": 0.5}, "title": {"text": "Größe", "size": 2}, "labels": false,
            "texts": [{"text": "one\ntwo", "position": "top_left"}]})");
    const Annotations& read = scene.annotations;
    ASSERT_TRUE(read.colorbar && read.axes && read.box && read.title);
    EXPECT_EQ(read.colorbar->position, AnnotationPosition::left);
    EXPECT_EQ(read.colorbar->format, "{:.1f} K");
    EXPECT_EQ(*read.axes, Annotation{});
    EXPECT_EQ(read.box->size, 0.5);
    EXPECT_EQ(read.title->text, "Größe");
    EXPECT_FALSE(read.labels || read.scale_bar);
    ASSERT_EQ(read.texts.size(), 1u);
    EXPECT_EQ(parse_scene(scene_text(scene), "again.json").annotations, read);
    EXPECT_EQ(annotated_scene("{}").annotations, Annotations{});
}

TEST(Annotations, MistakesAreNamedByTheirKeys) {
    const auto read = [](const std::string& annotations) {
        return [annotations] { annotated_scene(annotations); };
    };
    expect_error(read(R"({"colorbar": 3})"), {"scene.json", "image.annotations.colorbar", "3"});
    expect_error(read(R"({"colorbar": {"format": "{}{}"}})"),
                 {"image.annotations.colorbar.format", "{}{}"});
    expect_error(read(R"({"scale_bar": {"size": 0}})"), {"image.annotations.scale_bar.size"});
    expect_error(read(R"({"colourbar": true})"), {"colourbar", "colorbar"});
    expect_error(read(R"({"axes": {"format": "{}"}})"), {"image.annotations.axes", "format"});
    expect_error(read(R"({"title": {"position": "top"}})"), {"image.annotations.title", "text"});
    expect_error(read("{\"title\": \"a\xff\"}"), {"scene.json"});
}

}  // namespace
}  // namespace lamina
