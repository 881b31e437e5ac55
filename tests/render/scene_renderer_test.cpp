// SPDX-License-Identifier: Apache-2.0
// A renderer whose scene changes draws the same as a new one with its resolved scene, bit for bit
// on the cpu engine, and repeats only the steps that a change makes necessary.
#include "render/scene_renderer.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "base/error.h"
#include "renderer_scenes.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

using test::knot;

// Returns the picture of a new renderer with the resolved scene.
Image fresh(SceneRenderer& frames, const std::shared_ptr<const VolumeData>& data) {
    return SceneRenderer(frames.resolved().scene(), data, frames.capabilities()).draw_picture();
}

TEST(SceneRenderer, DrawsEveryFrameAsANewOne) {
    const auto data = blobs();
    SceneRenderer frames(volume_scene(), data, cpu_capabilities());
    const auto expect_fresh = [&](const std::string& what) {
        const Image drawn = frames.draw_picture();
        EXPECT_EQ(drawn.rgba, fresh(frames, data).rgba) << what;
    };
    expect_fresh("the first picture");
    for (int degrees = 0; degrees < 360; degrees += 15) {
        frames.set_camera(orbit(degrees));
        expect_fresh("turned by " + std::to_string(degrees));
    }
    // The camera goes into the box and out again, and looks past it, where nothing is seen.
    for (const double distance : {1.2, .6, .3, .05, 1e-3, .3, 40., 2.}) {
        frames.set_camera(orbit(200, distance));
        expect_fresh("from " + std::to_string(distance));
    }
    Camera away = orbit(30);
    away.center = 2. * away.eye;
    frames.set_camera(away);
    expect_fresh("seen from behind");
    frames.set_camera(orbit(30));
    expect_fresh("and again from the front");
    Camera parallel = orbit(70);
    parallel.projection = Projection::orthographic;
    parallel.height = 1.5;
    for (const Camera& camera : {parallel, orbit(71), parallel}) {
        frames.set_camera(camera);
        expect_fresh("orthographic and perspective in turn");
    }
    for (const double extinction : {.5, 20., 300., 4.}) {
        frames.set_transfer_function(smooth(extinction));
        expect_fresh("extinction " + std::to_string(extinction));
        frames.set_camera(orbit(extinction));
        expect_fresh("turned, extinction " + std::to_string(extinction));
    }
    frames.set_size(53, 21);
    expect_fresh("another size");
}

TEST(SceneRenderer, ChoosesSettingsAgain) {
    const auto data = blobs();
    SceneRenderer frames(volume_scene(), data, cpu_capabilities());
    for (const Target target : {Target::fixed8, Target::float16, Target::float32}) {
        for (const bool chosen : {false, true}) {
            Scene scene = volume_scene();
            if (chosen)
                scene.target = automatic;
            else
                scene.target = target;
            scene.max_error = target == Target::fixed8 ? 4 : 1;
            if (target == Target::fixed8 && !chosen) scene.slice.tree = automatic;
            scene.slice.samples = automatic;
            frames.set_scene(scene);
            const Image drawn = frames.draw_picture();
            EXPECT_EQ(drawn.rgba, fresh(frames, data).rgba)
                << name_of(target) << (chosen ? " or another" : "");
            EXPECT_EQ(open_keys(frames.resolved().scene()), std::vector<std::string>());
        }
    }
}

TEST(OpenKeys, NameLightOrItsSmallestGradient) {
    Scene scene = volume_scene();
    const std::vector<std::string> others = open_keys(scene);
    const auto added = [&] {
        std::vector<std::string> keys = open_keys(scene);
        std::erase_if(keys,
                      [&](const std::string& key) { return std::ranges::count(others, key); });
        return keys;
    };
    scene.lighting = automatic;
    EXPECT_EQ(added(), std::vector<std::string>{"lighting"});
    scene.lighting = Lighting{};
    EXPECT_EQ(added(), std::vector<std::string>{"lighting.smallest_gradient"});
}

TEST(SceneRenderer, RepeatsOnlyWhatAChangeNeeds) {
    Scene scene = volume_scene();
    // Segments are short, so one layer of a table serves all views.
    scene.transfer_function = smooth(1);
    SceneRenderer frames(scene, blobs(), cpu_capabilities());
    frames.draw();
    SceneRenderer::Counts expected{1, 1, 1, 1, 1, 1};
    EXPECT_EQ(frames.counts(), expected);
    frames.draw();
    EXPECT_EQ(frames.counts(), expected);
    frames.set_camera(orbit(40));
    frames.draw();
    ++expected.views;
    ++expected.rays;
    ++expected.plans;
    const int renderers = frames.counts().renderers;
    EXPECT_LE(renderers, 2);  // one new table, if any, covers longer segments in all views
    expected.renderers = renderers;
    EXPECT_EQ(frames.counts(), expected);
    for (int degrees = 50; degrees < 400; degrees += 30) {
        frames.set_camera(orbit(degrees));
        frames.draw();
        ++expected.views;
        ++expected.rays;
        ++expected.plans;
        EXPECT_EQ(frames.counts(), expected) << degrees;
    }
    frames.set_transfer_function(smooth(2));
    frames.draw();
    ++expected.data;
    ++expected.views;
    ++expected.rays;
    ++expected.plans;
    ++expected.renderers;
    EXPECT_EQ(frames.counts(), expected);
    frames.choose_again();
    frames.draw();
    ++expected.views;
    ++expected.rays;
    ++expected.trials;
    ++expected.plans;
    EXPECT_LE(frames.counts().renderers, expected.renderers + 1);
    expected.renderers = frames.counts().renderers;
    EXPECT_EQ(frames.counts(), expected);
}

TEST(SceneRenderer, KeepsCopiesOfTheVolume) {
    SceneRenderer frames(volume_scene(), blobs(), cpu_capabilities());
    frames.draw();
    frames.set_transfer_function(smooth(3));
    frames.draw();
    EXPECT_EQ(frames.renderer().stages_ms().at("upload"), 0);
    frames.set_size(20, 10);
    frames.draw();
    EXPECT_EQ(frames.renderer().stages_ms().at("upload"), 0);
}

TEST(SceneRenderer, DrawsEveryFrameOfAMeshAsANewOne) {
    const auto mesh = split_box();
    for (const auto& geometry :
         {Auto<ProjectGeometry>(automatic), Auto<ProjectGeometry>(ProjectGeometry::triangles)}) {
        Scene scene = mesh_scene();
        scene.project.geometry = geometry;
        SceneRenderer frames(scene, mesh, cpu_capabilities());
        const auto expect_fresh = [&](const std::string& what) {
            const Image drawn = frames.draw_picture();
            SceneRenderer other(frames.resolved().scene(), mesh, cpu_capabilities());
            EXPECT_EQ(drawn.rgba, other.draw_picture().rgba) << what;
        };
        for (int degrees = 0; degrees < 360; degrees += 30) {
            frames.set_camera(orbit(degrees));
            expect_fresh("turned by " + std::to_string(degrees));
        }
        for (const double distance : {.6, .2, 2.}) {
            frames.set_camera(orbit(200, distance));
            expect_fresh("from " + std::to_string(distance));
        }
        Camera parallel = orbit(70);
        parallel.projection = Projection::orthographic;
        parallel.height = 1.5;
        for (const Camera& camera : {parallel, orbit(71)}) {
            frames.set_camera(camera);
            expect_fresh("orthographic and perspective in turn");
        }
        frames.set_transfer_function(
            TransferFunction::linear({knot(0, {1, 1, 1}, 0), knot(1, {1, .5, 0}, 5)}));
        expect_fresh("another transfer function");
        EXPECT_EQ(frames.counts().trials, 1);
    }
}

// Returns the bytes that are allocated and not freed. Resident memory would include what the
// allocator keeps for itself.
std::int64_t bytes_in_use() {
    const struct mallinfo2 heap = mallinfo2();
    return static_cast<std::int64_t>(heap.uordblks + heap.hblkhd);
}

// A picture has 1.9 MB and the copy of the volume .05. 48 frames may add at most a tenth of their
// pictures' size.
TEST(SceneRenderer, NeedsNoMoreMemoryAfterTheFirstRound) {
    SceneRenderer frames(volume_scene(), blobs(), cpu_capabilities());
    frames.set_size(400, 300);
    const auto round = [&] {
        for (int degrees = 0; degrees < 360; degrees += 15) {
            frames.set_camera(orbit(degrees));
            if (degrees % 90 == 0) frames.set_transfer_function(smooth(1 + degrees / 90));
            frames.draw_picture();
        }
    };
    round();
    const std::int64_t before = bytes_in_use();
    round();
    round();
    EXPECT_LE(bytes_in_use() - before, 48 * 400 * 300 * 16 / 10);
}

TEST(SceneRenderer, AStopEndsAFrameAndTheNextIsWhole) {
    const auto data = blobs();
    SceneRenderer frames(volume_scene(), data, cpu_capabilities());
    const Image whole = frames.draw_picture();
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(frames.draw(stop.get_token()), Interrupted);
    EXPECT_EQ(frames.draw_picture().rgba, whole.rgba);
    // Measurements and trials that were done before the stop are kept.
    frames.choose_again();
    EXPECT_THROW(frames.draw(stop.get_token()), Interrupted);
    EXPECT_EQ(frames.draw_picture().rgba, whole.rgba);
}

void turn(SceneRenderer& frames) {
    for (int degrees = 40; degrees < 200; degrees += 40) {
        frames.set_camera(orbit(degrees));
        frames.draw();
    }
}

TEST(SceneRenderer, DrawsInTwoThreadsAsAlone) {
    const auto data = blobs();
    const auto mesh = split_box();
    SceneRenderer alone(volume_scene(), data, cpu_capabilities());
    SceneRenderer alone_too(mesh_scene(), mesh, cpu_capabilities());
    turn(alone);
    turn(alone_too);
    SceneRenderer first(volume_scene(), data, cpu_capabilities());
    SceneRenderer second(mesh_scene(), mesh, cpu_capabilities());
    std::thread other([&] {
        std::stop_source stop;  // the stop is for this renderer only
        stop.request_stop();
        EXPECT_THROW(second.draw(stop.get_token()), Interrupted);
        turn(second);
    });
    turn(first);
    other.join();
    EXPECT_EQ(first.picture().rgba, alone.picture().rgba);
    EXPECT_EQ(second.picture().rgba, alone_too.picture().rgba);
}

}  // namespace
}  // namespace lamina
