// SPDX-License-Identifier: Apache-2.0
#include "lamina/session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "lamina/error.h"
#include "lamina/image.h"
#include "support/expect_error.h"
#include "support/split_box.h"
#include "support/temporary_folder.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;

Volume waves(int size) {
    auto samples = std::make_shared<std::vector<float>>();
    for (int i = 0; i < size * size * size; ++i)
        samples->push_back(.5f + .5f * std::sin(.11f * static_cast<float>(i)));
    Grid grid;
    grid.size = {size, size, size};
    grid.centering.fill(Centering::cell);
    const float* const first = samples->data();
    return {grid, SampleType::float32, {std::move(samples), first}};
}

Scene scene_for(const Grid::Bounds& box) {
    Scene scene;
    scene.transfer_function = TransferFunction::linear(
        {knot(.2, {1, .2, 0}, 0), knot(.6, {1, 1, 0}, .3), knot(1, {0, .3, 1}, .9)});
    scene.camera = orbit(box, 25, 15);
    scene.width = 50;
    scene.height = 40;
    return scene;
}

const SessionOptions cpu_session{ContextChoice::cpu, 0};

TEST(Session, DrawsAVolumeInMemoryWithoutACopy) {
    const Volume volume = waves(12);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    const Image picture = session.draw();
    ASSERT_EQ(picture.width, 50);
    // Exact segments claim an error of .05 / 255, and trace() one of 1e-5, which is .003 / 255.
    EXPECT_LE(error_of(picture, session.trace()).linf, .053);
    EXPECT_GT(error_of(picture, PreciseImage(50, 40)).linf, 20);
    EXPECT_EQ(session.plan().slabs, 1);
    EXPECT_EQ(session.plan().error.kind, ErrorKind::derived);
    EXPECT_GT(session.plan().error.value, .05);  // rounding is added to the claim
    EXPECT_LT(session.plan().error.value, .06);
    EXPECT_NE(session.explanation().find("slabs"), std::string::npos);
    EXPECT_EQ(session.statistics().drawn_by.substr(0, 4), "cpu:");
    EXPECT_TRUE(session.take_warnings().empty());
}

// The predicted error, if there is one, bounds the error. Some settings that a scene states have
// none; automatic settings have one, within max_error.
TEST(Session, PredictsABoundOfTheErrorIfOneIsKnown) {
    const Volume volume = waves(12);
    Scene scene = scene_for(volume.grid().bounds());
    scene.target = Target::fixed8;
    scene.slice.samples = 64;
    const auto expected = [&] {
        Session session(scene, volume, cpu_session);
        const PlanSummary plan = session.plan();
        const std::optional<double> error = plan.error.known();
        if (error) {
            EXPECT_LE(error_of(session.draw(), session.trace()).linf, *error);
        }
        return error;
    };
    const double blended = expected().value();
    scene.slice.tree = TreeSettings{.factors = {8, 8}};
    const double tree = expected().value();
    (*scene.slice.tree)->factors = {64};
    const double node = expected().value();
    EXPECT_LT(tree, blended / 4);
    EXPECT_LT(node, tree);
    (*scene.slice.tree)->factors = {8, 8};
    (*scene.slice.tree)->code = NodeCode::alpha;
    EXPECT_FALSE(expected());
    scene.slice.tree.reset();
    scene.target = Target::float32;
    scene.slice.classification = Classification::post;
    EXPECT_FALSE(expected());
    scene.slice.samples = automatic;
    EXPECT_LE(expected().value(), scene.max_error);
}

TEST(Session, DrawsAMeshInMemory) {
    MeshData box = test::kuhn_box({3, 2, 4}, [](const glm::dvec3& place) {
        return .5 + .5 * std::sin(9 * place.x + 5 * place.y * place.z);
    });
    Scene scene = scene_for({glm::dvec3(0), glm::dvec3(1)});
    scene.method = Method::project;
    Session session(scene, std::move(box), cpu_session);
    const Image picture = session.draw();
    // Opacity is in closed form, and colour weights are good to 1 / 255.
    EXPECT_LE(error_of(picture, session.trace()).linf, 1);
    EXPECT_GT(error_of(picture, PreciseImage(50, 40)).linf, 20);
    EXPECT_LE(session.plan().error.known().value(), 1);
    // The automatic order of a convex mesh is resolved to mpvo, which is right for it.
    Camera moved = *scene.camera;
    moved.eye.x += .1;
    session.set_camera(moved);
    EXPECT_LE(session.plan().error.known().value(), 1);
    scene.project.interpolation = Interpolation::linear;
    session.set_scene(scene);
    EXPECT_FALSE(session.plan().error.known());
}

TEST(Session, ClipsAreSetAndTakenBack) {
    const Volume volume = waves(12);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    const Image whole = session.draw();
    Clip clip;
    clip.planes = {{{5, 6, 4}, {.2, -1, 3}}};
    session.set_clip(clip);
    const Image cut = session.draw();
    EXPECT_LE(error_of(cut, session.trace()).linf, .053);  // .05 + .003, as in the first test
    EXPECT_GT(error_of(cut, whole).linf, 20);
    EXPECT_EQ(session.resolved_scene().clip, clip);
    session.set_clip({});
    EXPECT_EQ(session.draw().rgba, whole.rgba);
    clip.planes[0].normal = glm::dvec3(0);
    expect_error([&] { session.set_clip(clip); }, {"clip.planes: found the normal (0, 0, 0)"});
}

TEST(Session, SwitchesMethodsForOneVolume) {
    const Volume volume = waves(8);
    Scene scene = scene_for(volume.grid().bounds());
    scene.mesh = MeshSettings{.kuhn = true};
    Session session(scene, volume, cpu_session);
    const Image sliced = session.draw();
    scene.method = Method::project;
    session.set_scene(scene);
    const Image projected = session.draw();
    scene.method = Method::trace;
    session.set_scene(scene);
    const Image traced = session.draw();
    scene.method = Method::slice;
    session.set_scene(scene);
    EXPECT_EQ(session.draw().rgba, sliced.rgba);
    EXPECT_LE(error_of(sliced, traced).linf, 1.003);
    // Tets are linear between samples and cells are trilinear, so the pictures differ a little.
    EXPECT_LT(error_of(projected, traced).linf, 60);
    EXPECT_GT(error_of(projected, traced).linf, 0);
    EXPECT_EQ(session.trace().rgba.size(), traced.rgba.size());
}

TEST(Session, UsesAsManyThreadsAsGiven) {
    const Volume volume = waves(8);
    const Scene scene = scene_for(volume.grid().bounds());
    Session one(scene, volume, {ContextChoice::cpu, 1}),
        two(scene, volume, {ContextChoice::cpu, 2});
    EXPECT_EQ(one.draw().rgba, two.draw().rgba);
    EXPECT_TRUE(one.statistics().drawn_by.ends_with("1 thread")) << one.statistics().drawn_by;
    EXPECT_TRUE(two.statistics().drawn_by.ends_with("2 threads")) << two.statistics().drawn_by;
}

TEST(Session, ReusesThePictureMemoryForEqualSizes) {
    const Volume volume = waves(8);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    const float* const first = session.draw().rgba.data();
    session.set_camera(orbit(volume.grid().bounds(), 40, -10));
    EXPECT_EQ(session.draw().rgba.data(), first);
}

TEST(Session, SessionsOfSeveralThreadsDoNotDisturbEachOther) {
    for (const ContextChoice context : {ContextChoice::cpu, ContextChoice::osmesa}) {
        const Volume volume = waves(10);
        const auto draw = [&](double azimuth) {
            Scene scene = scene_for(volume.grid().bounds());
            scene.slice.samples = 60;
            Session session(scene, volume, {context, 1});
            Image picture;
            for (int i = 0; i < 5; ++i) {
                session.set_camera(orbit(volume.grid().bounds(), azimuth + i, 15));
                picture = session.draw();
            }
            return picture;
        };
        const Image alone[] = {draw(10), draw(100)};
        Image beside[2];
        std::thread other([&] { beside[1] = draw(100); });
        beside[0] = draw(10);
        other.join();
        for (int i = 0; i < 2; ++i) EXPECT_EQ(beside[i].rgba, alone[i].rgba);
    }
}

TEST(Session, StopsWhenAskedAndGoesOn) {
    const Volume volume = waves(10);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(session.draw(source.get_token()), Interrupted);
    EXPECT_THROW(session.trace(source.get_token()), Interrupted);
    Session fresh(scene_for(volume.grid().bounds()), volume, cpu_session);
    EXPECT_EQ(session.draw().rgba, fresh.draw().rgba);
}

TEST(Session, ReportsHowFarItIs) {
    const Volume volume = waves(10);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    session.draw();
    std::vector<double> shares;
    session.draw({}, [&](const std::string& activity, double share) {
        EXPECT_EQ(activity, "slicing");
        shares.push_back(share);
    });
    ASSERT_FALSE(shares.empty());
    EXPECT_EQ(shares.back(), 1);
}

TEST(Session, TracesTileByTile) {
    const Volume volume = waves(10);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    int pixels = 0;
    const PreciseImage truth =
        session.trace({}, {}, [&](const PictureTile& tile, const PreciseImage& picture) {
            EXPECT_EQ(picture.width, 50);
            pixels += tile.width * tile.height;
        });
    EXPECT_EQ(pixels, 50 * 40);
    EXPECT_EQ(truth.rgba, session.trace().rgba);
}

// Values are 2 x and the extinction is 1, so half of the opacity of the optical depth d is reached
// at the depth -log((1 + exp(-d)) / 2). Tolerance: some roundings of the distance.
TEST(Session, FindsThePointThatIsSeen) {
    const auto ramp = [](const glm::dvec3& p) { return 2 * p.x; };
    Scene scene;
    scene.transfer_function = TransferFunction::linear({knot(0, {1, 1, 1}, 1)});
    scene.camera = Camera{.eye = {-2, 1.2, .7}, .center = {0, 1.2, .7}};
    scene.method = Method::project;
    scene.width = scene.height = 5;
    Session session(scene, test::kuhn_box({3, 2, 2}, ramp), cpu_session);
    EXPECT_EQ(session.bounds().max, glm::dvec3(3, 2, 2));
    const PointProbe probe = session.probe();
    session.set_camera(orbit(session.bounds(), 0, 0));  // the probe keeps its own camera
    const auto point = probe.seen(2, 2);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->position.x, -std::log((1 + std::exp(-3.)) / 2), 1e-13);
    EXPECT_NEAR(point->value, 2 * point->position.x, 1e-13);
    EXPECT_NEAR(point->opacity, -std::expm1(-3), 1e-13);
    EXPECT_FALSE(probe.seen(-1e5, 2));

    const Volume volume = waves(12);
    Session other(scene_for(volume.grid().bounds()), volume, cpu_session);
    EXPECT_EQ(other.bounds().max, volume.grid().bounds().max);
    EXPECT_TRUE(other.probe().seen(25, 20));
}

TEST(Session, RefusesWhatCannotBeDrawn) {
    const Volume volume = waves(4);
    Scene scene = scene_for(volume.grid().bounds());
    scene.width = 0;
    expect_error([&] { Session(scene, volume, cpu_session); },
                 {"image: found 0 x 40 pixels, expected 1 x 1 or more"});
    scene.width = 50;
    expect_error(
        [&] {
            Session(scene, volume, {ContextChoice::cpu, -1});
        },
        {"threads: found -1, expected 0 (all) or more"});
    expect_error([&] { Session(scene, cpu_session); },
                 {"no volume was given, and the scene names none"});
    Session session(scene, volume, cpu_session);
    const TemporaryFolder folder;
    expect_error([&] { session.save_resolved_scene(folder / "a.json"); },
                 {"the scene names no data"});
    scene.method = Method::trace;
    session.set_scene(scene);
    expect_error([&] { session.plan(); }, {"\"trace\" has no plan"});
}

// The smallest gradient is .01 of the range of values, about 1, over the distance of samples, 1.
TEST(Session, TracesALitSceneAndChoosesItsSmallestGradient) {
    const Volume volume = waves(12);
    Scene scene = scene_for(volume.grid().bounds());
    scene.method = Method::trace;
    Session unlit(scene, volume, cpu_session);
    scene.lighting = Lighting{};
    Session session(scene, volume, cpu_session);
    EXPECT_TRUE((*session.scene().lighting)->smallest_gradient.is_automatic());
    EXPECT_NEAR(*(*session.resolved_scene().lighting)->smallest_gradient, .01, 1e-5);
    const auto plain = unlit.trace(), lit = session.trace();
    EXPECT_GT(error_of(session.draw(), plain).linf, 20);
    for (std::size_t i = 3; i < plain.rgba.size(); i += 4) EXPECT_EQ(lit.rgba[i], plain.rgba[i]);
    (*scene.lighting)->power = NAN;
    expect_error([&] { session.set_scene(scene); }, {"lighting.power: found nan"});
    expect_error([&] { Session(scene, volume, cpu_session); }, {"lighting.power: found nan"});
}

TEST(Session, ChoosesWhatASceneLeavesOpen) {
    const Volume volume = waves(12);
    Scene open;
    open.width = 50;
    open.height = 40;
    open.transfer_function = automatic;
    open.camera = automatic;
    Session session(open, volume, cpu_session);
    const Image picture = session.draw();
    EXPECT_TRUE(session.scene().camera.is_automatic());  // the scene as given
    const Scene resolved = session.resolved_scene();
    EXPECT_FALSE(resolved.transfer_function.is_automatic() || resolved.camera.is_automatic());
    EXPECT_EQ(Session(resolved, volume, cpu_session).draw().rgba, picture.rgba);
    EXPECT_EQ(session.explanation().find("chosen\n  transfer function: "), 0u);
    // Transfer functions follow from the data alone, whatever the camera.
    session.set_camera(orbit(volume.grid().bounds(), 40, -10));
    EXPECT_EQ(session.resolved_scene().transfer_function, resolved.transfer_function);
    EXPECT_FALSE(session.scene().camera.is_automatic());
    session.choose_again();
    EXPECT_EQ(session.resolved_scene().transfer_function, resolved.transfer_function);
    session.set_scene(open);
    EXPECT_EQ(session.draw().rgba, picture.rgba);
    // If the mesh is made from the volume, the transfer function is chosen for the volume.
    open.mesh = MeshSettings{.kuhn = true};
    open.method = Method::project;
    session.set_scene(open);
    EXPECT_EQ(session.resolved_scene().transfer_function, resolved.transfer_function);
    open.mesh = {};
    Session mesh(open, test::kuhn_box({3, 2, 4}, [](const glm::dvec3& p) { return p.x * p.y; }),
                 cpu_session);
    mesh.draw();
    EXPECT_GT(mesh.resolved_scene().transfer_function->max_extinction(0, 6), 0);
}

TEST(Session, WarnsOnceOfAPictureThatShowsNothing) {
    const Volume volume = waves(12);
    Session session(scene_for(volume.grid().bounds()), volume, cpu_session);
    session.set_transfer_function(
        TransferFunction::linear({knot(7, {1, 1, 1}, 0), knot(8, {1, 1, 1}, 1)}));
    for (int i = 0; i < 3; ++i) session.draw();
    const std::vector<std::string> warnings = session.take_warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("the transfer function shows values above 7"), std::string::npos)
        << warnings[0];
}

}  // namespace
}  // namespace lamina
