// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <variant>

#include "lamina/image.h"
#include "lamina/mesh.h"
#include "lamina/scene.h"
#include "lamina/session.h"
#include "model/frame_history.h"
#include "support/temporary_folder.h"
#include "work/session_steps.h"

namespace lamina::view {
namespace {

const SessionOptions two_threads{.context = ContextChoice::cpu, .threads = 2};

Scene pinned_scene() {
    return parse_scene(
        R"({"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]},
            "transfer_function": {"points": [{"value": 0, "color": "red", "extinction": 0},
                                             {"value": 255, "color": "blue", "extinction": 4}]},
            "camera": {"eye": [2, 1, 2], "center": [0.5, 0.5, 0.5]},
            "image": {"width": 40, "height": 30},
            "render": {"target": "fixed8", "slice": {"samples": 64, "classification": "post"}}})",
        "scene.json");
}

// A document drawn in steps by SessionSteps, as the viewer's worker does it.
class DrawnDocument {
  public:
    DrawnDocument() : steps_(two_threads, [this](const Shown& shown) { take(shown); }) {
        document.size_follows_window = false;
        document.open(pinned_scene());
    }

    void draw(bool trace = false) {
        steps_.begin({.scene = document.scene(),
                      .revisions = document.revisions(),
                      .trace = trace,
                      .pinned = precision.comparison.pinned()});
        while (steps_.unfinished()) steps_.step({});
    }
    const Shown& shown() const { return shown_; }

    Document document;
    PrecisionInSight precision;

  private:
    void take(const Shown& shown) {
        shown_ = shown;
        precision.follow(document, shown_);
    }
    Shown shown_;
    SessionSteps steps_;
};

Image drawn_alone(const Scene& scene) {
    Session session(scene, two_threads);
    return session.draw();
}

void turn(Document& document) {
    document.set_camera(turned(*document.scene().camera, 40));
}

TEST(PinnedPicture, IsDrawnAgainInTheNewView) {
    DrawnDocument drawn;
    Comparison& comparison = drawn.precision.comparison;
    comparison.by = CompareBy::difference;
    drawn.draw();
    drawn.precision.pin(drawn.document, drawn.shown());
    ASSERT_TRUE(comparison.pinned());
    const Scene a = drawn.document.scene();
    drawn.document.edit([](Scene& scene) { scene.target = Target::float32; });
    drawn.draw();
    ASSERT_TRUE(comparison.active());
    const Image b = drawn_alone(drawn.document.scene());
    EXPECT_EQ(comparison.norms().linf, error_of(b, drawn_alone(a)).linf);
    EXPECT_GT(comparison.norms().linf, 1);
    for (int i = 0; i < 2; ++i) {
        turn(drawn.document);
        drawn.draw();
        Scene a_turned = a;
        a_turned.camera = drawn.document.scene().camera;
        ASSERT_TRUE(comparison.active()) << comparison.missing();
        EXPECT_EQ(comparison.pinned()->picture->rgba, drawn_alone(a_turned).rgba);
        EXPECT_EQ(drawn.shown().full->rgba, drawn_alone(drawn.document.scene()).rgba);
    }
    // B, the current settings, is what is traced and what later frames draw, not the pinned A.
    turn(drawn.document);
    drawn.draw(true);
    EXPECT_EQ(drawn.shown().share_traced, 1);
    Session alone(drawn.document.scene(), two_threads);
    EXPECT_EQ(drawn.shown().truth->rgba, alone.trace().rgba);
    Clip clip;
    clip.planes.push_back({.point = glm::dvec3(.5), .normal = {1, 0, 0}});
    drawn.document.set_clip(clip);
    drawn.draw();
    EXPECT_EQ(drawn.shown().full->rgba, drawn_alone(drawn.document.scene()).rgba);
}

TEST(PinnedPicture, IsNotDrawnWhileTheOtherMoves) {
    DrawnDocument drawn;
    drawn.draw();
    drawn.precision.pin(drawn.document, drawn.shown());
    drawn.document.edit([](Scene& scene) { scene.target = Target::float32; });
    turn(drawn.document);
    drawn.draw();  // draws B, then A
    turn(drawn.document);
    Shown last;
    SessionSteps steps(two_threads, [&](const Shown& shown) { last = shown; });
    DrawRequest request{.scene = drawn.document.scene(),
                        .revisions = drawn.document.revisions(),
                        .trace = false,
                        .pinned = drawn.precision.comparison.pinned()};
    const auto run = [&] {
        steps.begin(request);
        while (steps.unfinished()) steps.step({});
    };
    run();
    ASSERT_TRUE(last.pinned);  // A, drawn in this view after B
    turn(drawn.document);
    request.scene = drawn.document.scene();
    request.revisions = drawn.document.revisions();
    request.moving = true;
    request.coarse = false;
    run();
    EXPECT_EQ(last.kind, PictureKind::moving);
    const Image b = drawn_alone(request.scene);
    EXPECT_EQ(last.screen->rgb, screen_codes(b));
}

TEST(PinnedPicture, ReportsThatItCannotBeDrawnAndKeepsTheOther) {
    DrawnDocument drawn;
    drawn.draw();
    drawn.precision.pin(drawn.document, drawn.shown());
    PinnedPicture impossible = *drawn.precision.comparison.pinned();
    // Nodes that are `fixed` need a volume of one colour, which is known only once a plan is made.
    impossible.scene.slice.tree = TreeSettings{.factors = {8, 8}, .nodes = NodeArithmetic::fixed};
    turn(drawn.document);
    Shown last;
    SessionSteps steps(two_threads, [&](const Shown& shown) { last = shown; });
    steps.begin({.scene = drawn.document.scene(),
                 .revisions = drawn.document.revisions(),
                 .pinned = std::make_shared<const PinnedPicture>(impossible)});
    while (steps.unfinished()) steps.step({});
    ASSERT_FALSE(last.warnings.empty());
    EXPECT_TRUE(last.warnings.back().starts_with("A cannot be drawn in this view: "));
    EXPECT_TRUE(last.failure.empty());
    EXPECT_EQ(last.share_traced, 1);
}

TEST(PrecisionInSight, RowsFollowTheTracer) {
    DrawnDocument drawn;
    const Scene first = drawn.document.scene();
    drawn.draw(true);
    drawn.document.edit([](Scene& scene) { scene.target = Target::float32; });
    drawn.draw(true);
    const std::vector<Attempt>& rows = drawn.precision.attempts.rows();
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].share_measured, 1);
    EXPECT_EQ(rows[1].error.linf, drawn.shown().error.linf);
    EXPECT_GT(rows[0].error.linf, rows[1].error.linf);
    EXPECT_EQ(drawn.precision.frames.frames().size(), 2u);
    EXPECT_NEAR(*std::max_element(drawn.shown().missed->e.begin(), drawn.shown().missed->e.end(),
                                  [](float a, float b) { return std::abs(a) < std::abs(b); }),
                0, drawn.shown().error.linf + 1e-6);
    PrecisionInSight::go_on_with(drawn.document, rows[0].scene, false);
    EXPECT_EQ(scene_text(drawn.document.scene()), scene_text(first));
    drawn.draw(true);
    EXPECT_EQ(rows.size(), 2u);
    drawn.document.undo();
    EXPECT_EQ(drawn.document.scene().target, Target::float32);
}

// Writes a .pvd of three steps: the same tet with the values 60, 120 and 240.
std::filesystem::path mesh_in_steps(const std::filesystem::path& folder) {
    std::ofstream pvd(folder / "steps.pvd");
    pvd << "<VTKFile type=\"Collection\"><Collection>";
    for (int step = 0; step < 3; ++step) {
        MeshData mesh;
        mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        mesh.tets = {{0, 1, 2, 3}};
        mesh.point_scalars = {{"s", std::vector<double>(4, 60 << step)}};
        const std::string name = "step" + std::to_string(step) + ".vtu";
        save_mesh(mesh, folder / name);
        pvd << "<DataSet timestep=\"" << step << "\" file=\"" << name << "\"/>";
    }
    pvd << "</Collection></VTKFile>";
    return folder / "steps.pvd";
}

TEST(SessionSteps, DrawTheStepOfAMeshThatIsSet) {
    const TemporaryFolder folder;
    DrawnDocument drawn;
    Scene scene = pinned_scene();
    scene.volume = std::monostate();
    scene.mesh = MeshFile{mesh_in_steps(folder.path()), 1};
    scene.trace_of = TraceOf::mesh;
    scene.method = Method::project;
    scene.target = Target::float32;
    drawn.document.open(scene);
    drawn.draw();
    for (const int time : {2, 1, 0}) {
        const Image before = *drawn.shown().full;
        drawn.document.set_setting("mesh.time", time);
        drawn.draw();
        EXPECT_EQ(drawn.shown().failure, "");
        EXPECT_EQ(drawn.shown().full->rgba, drawn_alone(drawn.document.scene()).rgba) << time;
        EXPECT_NE(drawn.shown().full->rgba, before.rgba) << time;
    }
}

// A file is read once for several pictures; a warning about it is shown with each of them.
TEST(SessionSteps, ShowWarningsOnceAndAsLongAsTheyHold) {
    const TemporaryFolder folder;
    std::ofstream(folder / "surplus.nrrd")
        << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n"
        << std::string(64, 'a') << "behind";
    DrawnDocument drawn;
    Scene scene = pinned_scene();
    scene.volume = VolumeFile{folder / "surplus.nrrd"};
    drawn.document.open(scene);
    const auto expect_one_of_the_file = [&](const std::string& picture) {
        const std::vector<std::string>& said = drawn.shown().warnings;
        EXPECT_EQ(drawn.shown().failure, "") << picture;
        EXPECT_EQ(std::set<std::string>(said.begin(), said.end()).size(), said.size()) << picture;
        EXPECT_EQ(std::ranges::count_if(
                      said, [](const auto& text) { return text.find("6 bytes") < text.size(); }),
                  1)
            << picture;
    };
    drawn.draw();
    expect_one_of_the_file("the first one");
    turn(drawn.document);
    drawn.draw();
    expect_one_of_the_file("a turned one");
    drawn.draw(true);
    ASSERT_TRUE(drawn.shown().truth);
    expect_one_of_the_file("a traced one");
    drawn.document.edit([](Scene& changed) { changed.method = Method::trace; });
    drawn.draw();
    expect_one_of_the_file("one of the method trace");
    scene = pinned_scene();
    scene.method = Method::trace;
    drawn.document.open(scene);
    drawn.draw();
    EXPECT_EQ(drawn.shown().warnings, std::vector<std::string>());
}

}  // namespace
}  // namespace lamina::view
