// SPDX-License-Identifier: Apache-2.0
// Renderers that draw with OpenGL.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "gl/context.h"
#include "projection/gl_mesh_walk.h"
#include "projection/gl_project_renderer.h"
#include "render/draw_context.h"
#include "render/scene_renderer.h"
#include "renderer_scenes.h"
#include "slicing/gl_slice_renderer.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

bool has_egl() {
    return dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL) != nullptr;
}

struct DrawnFrames {
    std::vector<Image> volume, mesh;
};

// Draws the frames of two renderers that take turns in one context.
DrawnFrames draw_frames(gl::ContextKind kind, double first_degrees) {
    const DrawContext context(kind);
    const auto current = context.make_current();
    SceneRenderer volume(volume_scene(), blobs(), context.capabilities());
    SceneRenderer mesh(mesh_scene(), split_box(), context.capabilities());
    DrawnFrames frames;
    for (int frame = 0; frame < 6; ++frame) {
        const Camera camera = orbit(first_degrees + 25 * frame);
        volume.set_camera(camera);
        mesh.set_camera(camera);
        frames.volume.push_back(volume.draw_picture());
        frames.mesh.push_back(mesh.draw_picture());
    }
    return frames;
}

void expect_equal(const DrawnFrames& drawn, const DrawnFrames& alone) {
    for (std::size_t frame = 0; frame < alone.mesh.size(); ++frame) {
        EXPECT_EQ(drawn.volume[frame].rgba, alone.volume[frame].rgba) << frame;
        EXPECT_EQ(drawn.mesh[frame].rgba, alone.mesh[frame].rgba) << frame;
    }
}

TEST(OpenGlSessions, DrawInSeveralThreadsAsAlone) {
    const auto osmesa = gl::ContextKind::osmesa;
    const auto other_kind = has_egl() ? gl::ContextKind::egl : osmesa;
    const DrawnFrames alone = draw_frames(osmesa, 20);
    const DrawnFrames alone_turned = draw_frames(osmesa, 200);
    const DrawnFrames alone_elsewhere = draw_frames(other_kind, 200);
    EXPECT_NE(alone.volume[0].rgba, alone_turned.volume[0].rgba);
    for (int round = 0; round < 3; ++round) {
        DrawnFrames turned, elsewhere;
        std::thread second([&] { turned = draw_frames(osmesa, 200); });
        std::thread third([&] { elsewhere = draw_frames(other_kind, 200); });
        const DrawnFrames first = draw_frames(osmesa, 20);
        second.join();
        third.join();
        expect_equal(first, alone);
        expect_equal(turned, alone_turned);
        expect_equal(elsewhere, alone_elsewhere);
    }
}

TransferFunction one_colored(double extinction) {
    return TransferFunction::linear(
        {test::knot(0, {.1, .2, .6}, 0), test::knot(255, {.1, .2, .6}, extinction)});
}

auto textures_of(SceneRenderer& frames) {
    return dynamic_cast<const GlSliceRenderer&>(frames.renderer()).volume();
}

const GlProjectRenderer& gl_renderer(SceneRenderer& frames) {
    return dynamic_cast<const GlProjectRenderer&>(frames.renderer());
}

// Fixture with an OpenGL context that is current.
class OpenGlSession : public testing::Test {
  protected:
    const Capabilities& capabilities() const { return context_.capabilities(); }

  private:
    const DrawContext context_{gl::ContextKind::osmesa};
    const std::unique_ptr<gl::CurrentContext> current_ = context_.make_current();
};

// Counts of what the current context has done so far.
struct Done {
    std::int64_t bytes_uploaded = gl::current_context()->counts().bytes_uploaded;
    int programs_compiled = gl::current_context()->programs().compiled();
    friend bool operator==(const Done&, const Done&) = default;
};
// Expects that at most so many bytes were uploaded since then, and that nothing was compiled.
void expect_little(const Done& before, std::int64_t most_bytes) {
    const Done now;
    EXPECT_LE(now.bytes_uploaded - before.bytes_uploaded, most_bytes);
    EXPECT_EQ(now.programs_compiled, before.programs_compiled);
}
std::ostream& operator<<(std::ostream& out, const Done& done) {
    return out << done.bytes_uploaded << " bytes, " << done.programs_compiled << " programs";
}

template <typename Data>
void expect_fresh(SceneRenderer& frames, const Data& data, const Image& drawn,
                  const std::string& what) {
    SceneRenderer other(frames.resolved().scene(), data, frames.capabilities());
    EXPECT_EQ(drawn.rgba, other.draw_picture().rgba) << what;
}

struct VolumeCase {
    Scene scene;
    // Returns functions with the same number of points.
    TransferFunction (*transfer_function)(double extinction);
};

// Returns cases of slabs with two classifications, and of trees with nodes in shaders and in codes.
std::vector<VolumeCase> volume_cases() {
    std::vector<VolumeCase> cases(4, {volume_scene(), smooth});
    cases[0].scene.slice.classification = Classification::post;
    cases[2].scene.slice.tree = cases[3].scene.slice.tree = TreeSettings{.factors = {4}};
    cases[2].scene.target = cases[3].scene.target = Target::fixed8;
    (*cases[3].scene.slice.tree)->nodes = NodeArithmetic::fixed;
    cases[3].transfer_function = one_colored;
    for (VolumeCase& one : cases) one.scene.transfer_function = one.transfer_function(6);
    return cases;
}

// Marched rays take uniforms alone, the rasteriser takes the polygons of the slabs.
TEST_F(OpenGlSession, NewCamerasUploadPolygonsAloneAndCompileNothing) {
    // A slab of a box has up to 12 corners on its planes and 8 between them.
    constexpr std::int64_t polygon_bytes = 3 * (12 + 8 - 2) * sizeof(SlabVertex);
    const auto data = blobs();
    for (VolumeCase& one : volume_cases()) {
        // Segments are short, so a table of one layer serves every view.
        one.scene.transfer_function = one.transfer_function(1);
        SceneRenderer frames(one.scene, data, capabilities());
        frames.draw();
        frames.set_camera(orbit(40));
        frames.draw();
        const int renderers = frames.counts().renderers, rays = frames.counts().rays;
        EXPECT_EQ(rays, 1);
        const SlicePlan& plan = frames.plan().slice;
        const bool rasterized = plan.has_tree(NodeArithmetic::fixed);
        for (int degrees = 50; degrees < 400; degrees += 30) {
            const Done before;
            frames.set_camera(orbit(degrees));
            const Image drawn = frames.draw_picture();
            expect_little(before, rasterized ? plan.slabs * polygon_bytes : 0);
            EXPECT_EQ(frames.counts().renderers, renderers);
            EXPECT_EQ(frames.counts().rays, rays);
            expect_fresh(frames, data, drawn, std::to_string(degrees));
        }
    }
}

// Rays through the whole fog end early, and those along an edge do not. What the first view with
// the box in sight chose stays until the data or the transfer function change.
TEST_F(OpenGlSession, NewCamerasKeepTheChoicesOfRays) {
    const auto data = blobs();
    const TransferFunction fog =
        TransferFunction::linear({test::knot(0, {1, 1, 1}, 20), test::knot(255, {1, 0, 0}, 20)});
    const Camera whole = orbit(0);
    Camera edge = orbit(0), away = orbit(0);
    edge.projection = Projection::orthographic;
    edge.height = .05;
    edge.center = {.05, .5, .05};
    edge.eye = edge.center + glm::dvec3{-2, 0, 2};
    away.center = 2. * away.eye;
    for (const bool ends : {false, true}) {
        Scene scene = volume_scene();
        scene.slice.classification = Classification::exact;
        scene.transfer_function = fog;
        scene.camera = away;
        SceneRenderer frames(scene, data, capabilities());
        frames.draw();
        frames.set_camera(ends ? whole : edge);
        frames.draw();
        EXPECT_EQ(frames.counts().rays, 2);
        for (const Camera& camera : {edge, whole, away, edge}) {
            frames.set_camera(camera);
            frames.draw();
            EXPECT_EQ(frames.plan().slice.ends_early(),
                      ends && !frames.plan().slice.nothing_visible);
        }
        EXPECT_EQ(frames.counts().rays, 2);
        frames.set_transfer_function(fog);
        frames.set_camera(whole);
        frames.draw();
        EXPECT_EQ(frames.counts().rays, 3);
        EXPECT_TRUE(frames.plan().slice.ends_early());
    }
}

// These cameras need other programs, or none: orthographic, looking past the box, inside it.
TEST_F(OpenGlSession, CamerasOfOtherKindsKeepTheVolume) {
    const auto data = blobs();
    Camera parallel = orbit(70);
    parallel.projection = Projection::orthographic;
    parallel.height = 1.5;
    Camera away = orbit(30);
    away.center = 2. * away.eye;
    for (const VolumeCase& one : volume_cases()) {
        SceneRenderer frames(one.scene, data, capabilities());
        frames.draw();
        const auto textures = textures_of(frames);
        for (const Camera& camera :
             {parallel, orbit(71), away, orbit(20, .6), orbit(200, .05), parallel, orbit(20)}) {
            frames.set_camera(camera);
            const Image drawn = frames.draw_picture();
            EXPECT_EQ(textures_of(frames), textures);
            expect_fresh(frames, data, drawn, "");
        }
    }
}

TEST_F(OpenGlSession, TransferFunctionsOfOneKindCompileNothing) {
    const auto data = blobs();
    for (VolumeCase& one : volume_cases()) {
        // The sizes of the tables are fixed, whatever their errors, because programs are compiled
        // for sizes.
        one.scene.slice.table = SliceTableSettings{256, 4, 2};
        SceneRenderer frames(one.scene, data, capabilities());
        frames.draw();
        const auto textures = textures_of(frames);
        const Done before;
        for (const double extinction : {7., 8., 5.}) {
            frames.set_transfer_function(one.transfer_function(extinction));
            frames.draw();
            EXPECT_EQ(textures_of(frames), textures);
            EXPECT_EQ(frames.renderer().stages_ms().at("upload"), 0);
            EXPECT_EQ(Done().programs_compiled, before.programs_compiled);
            expect_fresh(frames, data, frames.picture(), std::to_string(extinction));
        }
        frames.set_size(53, 21);
        const Image drawn = frames.draw_picture();
        EXPECT_EQ(textures_of(frames), textures);
        EXPECT_EQ(Done().programs_compiled, before.programs_compiled);
        expect_fresh(frames, data, drawn, "another size");
    }
}

// Both renderers use the same programs with different uniforms.
TEST_F(OpenGlSession, TwoRenderersShareTheirPrograms) {
    const auto data = blobs();
    for (const VolumeCase& one : volume_cases()) {
        SceneRenderer first(one.scene, data, capabilities());
        Scene others = one.scene;
        others.width = 31;
        others.transfer_function = one.transfer_function(3);
        SceneRenderer second(others, data, capabilities());
        for (int degrees = 0; degrees < 90; degrees += 30) {
            for (SceneRenderer* const frames : {&first, &second}) {
                frames->set_camera(orbit(degrees));
                frames->draw();
            }
            expect_fresh(second, data, second.picture(), std::to_string(degrees));
            expect_fresh(first, data, first.picture(), std::to_string(degrees));
        }
    }
}

TEST_F(OpenGlSession, MeshesKeepOrderBuffersAndPrograms) {
    const auto data = split_box();
    Capabilities rasterizer = capabilities();
    rasterizer.max_buffer_texels = 0;  // no walks
    for (const auto& geometry :
         {Auto<ProjectGeometry>(automatic), Auto<ProjectGeometry>(ProjectGeometry::triangles)}) {
        Scene scene = mesh_scene();
        scene.project.geometry = geometry;
        SceneRenderer frames(scene, data, rasterizer);
        frames.draw();
        for (int degrees = 30; degrees < 360; degrees += 30) {
            const Done before;
            frames.set_camera(orbit(degrees));
            frames.draw();
            EXPECT_EQ(Done(), before);
            EXPECT_EQ(frames.counts().renderers, 1);
            expect_fresh(frames, data, frames.picture(), std::to_string(degrees));
        }
        const Done before;
        const auto [order, stream] = gl_renderer(frames).reusable();
        frames.set_transfer_function(
            TransferFunction::linear({test::knot(0, {1, .2, 0}, .2), test::knot(.4, {1, 1, .5}, 2),
                                      test::knot(1, {0, .3, 1}, 5)}));
        frames.draw();
        EXPECT_EQ(frames.counts().renderers, 2);
        EXPECT_EQ(gl_renderer(frames).reusable().order, order);
        EXPECT_EQ(gl_renderer(frames).reusable().stream, stream);
        EXPECT_EQ(Done().programs_compiled, before.programs_compiled);
        expect_fresh(frames, data, frames.picture(), "another transfer function");
    }
}

// A new camera uploads, for each tile of 8 x 8 pixels, its place and the faces by which rays may
// enter it.
TEST_F(OpenGlSession, WalkedMeshesStayOnTheDevice) {
    const auto data = split_box();
    constexpr double distance = 9;  // the whole mesh is in front of the eye
    Scene scene = mesh_scene();
    scene.camera = orbit(20, distance);
    SceneRenderer frames(scene, data, capabilities());
    frames.draw();
    EXPECT_NE(dynamic_cast<const GlMeshWalk*>(&frames.renderer()), nullptr);
    // At this distance six tiles see the mesh, and each face lies in four of these at most.
    const std::int64_t most = 6 * 16 + 4 * 4 * std::ssize(data->mesh.open_faces());
    for (int degrees = 30; degrees < 360; degrees += 60) {
        const Done before;
        frames.set_camera(orbit(degrees, distance));
        frames.draw();
        expect_little(before, most);
        EXPECT_EQ(frames.counts().renderers, 1);
        expect_fresh(frames, data, frames.picture(), std::to_string(degrees));
    }
}

TEST(SessionOfTheCpuEngine, KeepsAMeshsOrder) {
    const auto data = split_box();
    SceneRenderer frames(mesh_scene(), data, cpu_capabilities());
    const auto order = [&] {
        return dynamic_cast<const ProjectRenderer&>(frames.renderer()).reusable().order;
    };
    frames.draw();
    const auto first = order();
    frames.set_transfer_function(
        TransferFunction::linear({test::knot(0, {1, 1, 1}, 0), test::knot(1, {1, .5, 0}, 5)}));
    frames.draw();
    EXPECT_EQ(order(), first);
    expect_fresh(frames, data, frames.picture(), "another transfer function");
}

TEST(OpenGlSessions, TheCpuEngineNeedsNoCurrentContext) {
    EXPECT_EQ(DrawContext(ContextChoice::cpu).make_current(), nullptr);
}

}  // namespace
}  // namespace lamina
