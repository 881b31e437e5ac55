// SPDX-License-Identifier: Apache-2.0
// Sessions that draw with OpenGL.
#include <gtest/gtest.h>

#include <dlfcn.h>

#include <string>
#include <thread>
#include <vector>

#include "render/draw_context.h"
#include "render/session.h"
#include "session_scenes.h"

namespace lamina {
namespace {

bool has_egl() {
    return dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL) != nullptr;
}

struct Frames {
    std::vector<Image> volume, mesh;
};

// Of two sessions that take turns in one context.
Frames draw_frames(gl::ContextKind kind, double first_degrees) {
    const DrawContext context(kind);
    const auto current = context.make_current();
    Session volume(volume_scene(), blobs(), context.capabilities());
    Session mesh(mesh_scene(), split_box(), context.capabilities());
    Frames frames;
    for (int frame = 0; frame < 6; ++frame) {
        const Camera camera = orbit(first_degrees + 25 * frame);
        volume.set_camera(camera);
        mesh.set_camera(camera);
        frames.volume.push_back(volume.draw_picture());
        frames.mesh.push_back(mesh.draw_picture());
    }
    return frames;
}

void expect_equal(const Frames& drawn, const Frames& alone) {
    for (std::size_t frame = 0; frame < alone.mesh.size(); ++frame) {
        EXPECT_EQ(drawn.volume[frame].rgba, alone.volume[frame].rgba) << frame;
        EXPECT_EQ(drawn.mesh[frame].rgba, alone.mesh[frame].rgba) << frame;
    }
}

TEST(OpenGlSession, SomeInTwoThreadsDrawWhatEachDrawsAlone) {
    const auto osmesa = gl::ContextKind::osmesa;
    const auto other_kind = has_egl() ? gl::ContextKind::egl : osmesa;
    const Frames alone = draw_frames(osmesa, 20);
    const Frames alone_turned = draw_frames(osmesa, 200);
    const Frames alone_elsewhere = draw_frames(other_kind, 200);
    EXPECT_NE(alone.volume[0].rgba, alone_turned.volume[0].rgba);
    for (int round = 0; round < 3; ++round) {
        Frames turned, elsewhere;
        std::thread second([&] { turned = draw_frames(osmesa, 200); });
        std::thread third([&] { elsewhere = draw_frames(other_kind, 200); });
        const Frames first = draw_frames(osmesa, 20);
        second.join();
        third.join();
        expect_equal(first, alone);
        expect_equal(turned, alone_turned);
        expect_equal(elsewhere, alone_elsewhere);
    }
}

TEST(OpenGlSession, TheNativeEngineNeedsNothingCurrent) {
    EXPECT_EQ(DrawContext(ContextChoice::cpu).make_current(), nullptr);
}

}  // namespace
}  // namespace lamina
