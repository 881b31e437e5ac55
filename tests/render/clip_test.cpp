// SPDX-License-Identifier: Apache-2.0
// A clip that changes: every frame equals that of a new renderer; the volume and the choices stay.
#include <gtest/gtest.h>

#include "choice/field.h"
#include "render/scene_renderer.h"
#include "render/warnings.h"
#include "renderer_scenes.h"
#include "support/clips.h"
#include "support/heard_warnings.h"
#include "support/overlapping_tets.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

TEST(ChangedClip, DrawsEveryFrameAsANewRenderer) {
    const auto data = blobs();
    for (const auto& classification :
         {Auto<Classification>(automatic), Auto<Classification>(Classification::preintegrated)}) {
        Scene scene = volume_scene();
        scene.slice.classification = classification;
        SceneRenderer frames(scene, data, cpu_capabilities());
        frames.draw();
        for (const test::NamedClip& named : test::clips_of_unit_box()) {
            frames.set_clip(named.clip);
            const Image drawn = frames.draw_picture();
            EXPECT_EQ(frames.renderer().stages_ms().contains("upload")
                          ? frames.renderer().stages_ms().at("upload")
                          : 0,
                      0);
            SceneRenderer other(frames.resolved().scene(), data, cpu_capabilities());
            EXPECT_EQ(drawn.rgba, other.draw_picture().rgba) << named.name;
        }
        EXPECT_EQ(frames.counts().trials, 1);
    }
}

TEST(ChangedClip, DrawsEveryFrameOfAMeshAsANewRenderer) {
    const auto mesh = split_box();
    SceneRenderer frames(mesh_scene(), mesh, cpu_capabilities());
    const Image whole = frames.draw_picture();
    const int views = frames.counts().data;
    for (const test::NamedClip& named : test::clips_of_unit_box()) {
        frames.set_clip(named.clip);
        const Image drawn = frames.draw_picture();
        frames.set_camera(orbit(20));  // the mesh is not cut again
        EXPECT_EQ(frames.draw_picture().rgba, drawn.rgba) << named.name;
        SceneRenderer other(frames.resolved().scene(), mesh, cpu_capabilities());
        EXPECT_EQ(drawn.rgba, other.draw_picture().rgba) << named.name;
    }
    EXPECT_EQ(frames.counts().data, views + static_cast<int>(test::clips_of_unit_box().size()));
    frames.set_clip({});
    EXPECT_EQ(frames.draw_picture().rgba, whole.rgba);
}

// The clip removes the whole mesh, with omissions and without.
TEST(ChangedClip, CanRemoveAWholeMesh) {
    OmissionSwitch nothing_left_out;
    nothing_left_out.none = true;
    for (const OmissionSwitch& omissions : {OmissionSwitch{}, nothing_left_out}) {
        Scene scene = mesh_scene();
        scene.clip.planes = {{{5, 0, 0}, {1, 0, 0}}};  // beside the box, which is 3 wide
        SceneRenderer frames(scene, split_box(), cpu_capabilities(), omissions);
        EXPECT_EQ(frames.draw_picture().rgba, Image(scene.width, scene.height).rgba);
        EXPECT_NE(frames.explanation().find("the clip cuts the whole mesh away"),
                  std::string::npos);
    }
}

TEST(ChangedClip, SaysWhyAPictureShowsNothing) {
    const auto data = blobs();
    const auto warning_of = [&](const Clip& clip) {
        Scene scene = volume_scene();
        scene.clip = clip;
        const test::HeardWarnings heard;
        warn_of_picture(scene, VolumeField(data->volume, data->bricks),
                        Image(scene.width, scene.height));
        return heard.all();
    };
    const std::string all =
        "shows nothing: the clip cuts all of the data away, which lie in x from 0 to 1, y from 0 "
        "to 1 and z from 0 to 1";
    const ClipPlane right{{.6, 0, 0}, {1, 0, 0}}, left{{.4, 0, 0}, {-1, 0, 0}};
    const ClipPlane beyond{{1.1, 1.1, 0}, {1, 1, 0}};
    EXPECT_NE(warning_of({{}, ClipBox{{1.5, 0, 0}, {2, 1, 1}}}).find(all), std::string::npos);
    EXPECT_NE(warning_of({{}, ClipBox{{.5, 0, 0}, {.5, 1, 1}}}).find(all), std::string::npos);
    EXPECT_NE(warning_of({{right, left}, {}}).find(all), std::string::npos);
    EXPECT_NE(warning_of({{beyond}, {}}).find(all), std::string::npos);
    // No single half-space cuts all of this away.
    EXPECT_NE(warning_of({{left}, ClipBox{{.5, 0, 0}, {1, 1, 1}}}).find(all), std::string::npos);
    EXPECT_NE(warning_of({{right}, {}}).find("in what the clip keeps"), std::string::npos);
    EXPECT_EQ(warning_of({}).find("clip"), std::string::npos);
}

// Only orders of tets that overlap say so. A clip that is removed again leaves no trace.
TEST(ChangedClip, LeavesTheErrorOfOverlappingTetsUnknown) {
    Scene scene = mesh_scene();
    const auto soup = std::make_shared<const SceneMesh>(scene_mesh(scene, test::tet_soup(20, 8)));
    SceneRenderer frames(scene, soup, cpu_capabilities());
    const auto warns_of = [&](const std::string& text) {
        return std::ranges::any_of(frames.warnings(), [&](const std::string& warning) {
            return warning.find(text) != std::string::npos;
        });
    };
    const Image whole = frames.draw_picture();
    EXPECT_TRUE(warns_of("a ray shows them one after the other"));
    EXPECT_EQ(frames.plan().project.error.kind, ErrorKind::sampled);
    Clip clip;
    clip.planes = {{{.5, .5, .5}, {0, 0, 1}}};
    frames.set_clip(clip);
    frames.draw_picture();
    EXPECT_TRUE(warns_of("the error of a picture is unknown"));
    EXPECT_EQ(frames.plan().project.error.kind, ErrorKind::unknown);
    frames.set_clip({});
    EXPECT_EQ(frames.draw_picture().rgba, whole.rgba);
    EXPECT_TRUE(warns_of("a ray shows them one after the other"));
    // Each view decides anew whether it has too many pixels.
    frames.set_size(8000, 6000);
    EXPECT_TRUE(warns_of("\"exact\" orders them in all pixels, slowly"));
    frames.set_size(scene.width, scene.height);
    EXPECT_EQ(frames.draw_picture().rgba, whole.rgba);
}

TEST(ChangedClip, CutsAMeshAwayThatIsSmallerThanItsBox) {
    MeshData data;
    data.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    data.tets = {{0, 1, 2, 3}};
    data.point_scalars = {{"s", {0, 1, 2, 3}}};
    const SceneMesh tet = scene_mesh(Scene(), std::move(data));
    const MeshField field(tet);
    EXPECT_TRUE(field.cut_away_by({{{{.5, .5, .1}, {1, 1, 1}}}, {}}));
    EXPECT_FALSE(field.cut_away_by({{{{.4, .4, .1}, {1, 1, 1}}}, {}}));
    EXPECT_FALSE(field.cut_away_by({}));
}

}  // namespace
}  // namespace lamina
