// SPDX-License-Identifier: Apache-2.0
// The command line and the library give the same warnings, word for word.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "lamina/session.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class SameWarnings : public testing::Test {
  protected:
    // Expects equal warnings of both, one of which contains `part`.
    void expect_both_say(const json& scene, const std::string& part) const {
        SCOPED_TRACE(part);
        write_bytes_to(folder / "scene.json", scene.dump());
        const auto by_program = said_by_program();
        EXPECT_EQ(said_by_library(), by_program);
        EXPECT_TRUE(std::ranges::any_of(by_program, [&](const std::string& warning) {
            return warning.find(part) != std::string::npos;
        }));
    }
    json traced(json scene) const {
        scene["render"]["method"] = "trace";
        return scene;
    }
    json volume_scene(const std::string& nrrd) const {
        write_bytes_to(folder / "v.nrrd", "NRRD0004\ndimension: 3\n" + nrrd);
        json scene = gaussians_scene(12, 24, 18, 4);
        scene["volume"] = "v.nrrd";
        return scene;
    }
    json mesh_scene(const std::string& nodes, const std::string& tets) const {
        write_bytes_to(folder / "m.node", nodes);
        write_bytes_to(folder / "m.ele", tets);
        json scene = gaussians_scene(12, 24, 18, 4);
        scene.erase("volume");
        scene["render"] = {{"method", "project"}};
        scene["mesh"] = "m.node";
        return scene;
    }

    const TemporaryFolder folder;

  private:
    std::set<std::string> said_by_program() const {
        const ProgramResult result = lamina_run(
            {"render", folder / "scene.json", "-o", folder / "a.exr", "--context", "cpu"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const std::string begin = "lamina: warning: ";
        std::set<std::string> found;
        std::istringstream lines(result.err);
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with(begin)) continue;
            EXPECT_TRUE(found.insert(line.substr(begin.size())).second) << line;
        }
        return found;
    }
    std::set<std::string> said_by_library() const {
        const Scene scene = load_scene(folder / "scene.json");
        Session session(scene, {ContextChoice::cpu});
        scene.method == Method::trace ? void(session.trace()) : void(session.draw());
        const std::vector<std::string> all = session.take_warnings();
        std::set<std::string> found(all.begin(), all.end());
        EXPECT_EQ(found.size(), all.size());
        return found;
    }
};

TEST_F(SameWarnings, AreGivenForABoundThatIsNotKept) {
    json scene = gaussians_scene(12, 24, 18, 4);
    scene["render"] = {{"max_error", 1e-5}, {"slice", {{"tree", "auto"}}}};
    expect_both_say(scene, "render.max_error: 1e-05 is not kept");
}

TEST_F(SameWarnings, AreGivenForColorsThatTheTargetClamps) {
    json scene = gaussians_scene(12, 24, 18, 4);
    scene["transfer_function"]["points"][1]["color"] = {1.5, 1, 0};
    scene["render"]["target"] = "fixed8";
    expect_both_say(scene, "1 transfer-function points have a colour above 1");
}

// The unit box's diagonal is the longest ray: the largest opacity is below 3^.5 times the
// extinction, .0099, and .0002 of the second one, which is less than half a code.
TEST_F(SameWarnings, AreGivenForPicturesThatShowAlmostNothing) {
    json scene = gaussians_scene(12, 24, 18, 4);
    json& extinction = scene["transfer_function"]["points"][1]["extinction"];
    extinction = .0057;
    expect_both_say(scene, "the picture shows almost nothing: the largest opacity is 0.00");
    expect_both_say(traced(scene), "the picture shows almost nothing: the largest opacity is 0.00");
    extinction = .0001;
    expect_both_say(scene, "the picture shows nothing: the largest opacity is ");
    expect_both_say(scene, " times as much (--density; in Python density) gives 0.9");
}

// Rays meet a sliver of .0001 at cosines above .29. At an extinction of 3, opacities are below
// .0011, which is less than half a code.
TEST_F(SameWarnings, DoNotBlameTheExtinctionForWhatAClipLeaves) {
    json scene = gaussians_scene(12, 24, 18, 4);
    scene["transfer_function"]["points"][1]["extinction"] = 3;
    scene["clip"]["box"] = {{"min", {0, 0, .5}}, {"max", {1, 1, .5001}}};
    expect_both_say(scene, "shows nothing: the largest opacity in what the clip keeps is ");
}

TEST_F(SameWarnings, AreGivenForABackgroundOfCodes) {
    json scene = gaussians_scene(12, 24, 18, 4);
    scene["image"]["background"] = {255, 255, 255};
    expect_both_say(scene, "image.background: found 255, 255, 255: colours are from 0 to 1");
}

TEST_F(SameWarnings, AreGivenForNonFiniteSamples) {
    json scene = volume_scene(
        "type: float\nsizes: 3 2 2\nencoding: ascii\n\n1 2 250 4 5 6 7 nan 9 80 200 30\n");
    scene["nan"] = "transparent";
    expect_both_say(scene, "1 samples are NaN or infinite");
    expect_both_say(traced(scene), "1 samples are NaN or infinite");
}

TEST_F(SameWarnings, AreGivenForPadding) {
    std::string samples;
    for (int i = 0; i < 512; ++i)
        samples += (i % 8 < 2 ? "-30000" : std::to_string(i * 37 % 211)) + " ";
    json scene = volume_scene("type: short\nsizes: 8 8 8\nencoding: ascii\n\n" + samples + "\n");
    scene.erase("transfer_function");
    scene.erase("camera");
    expect_both_say(scene, "-30000, ");
    expect_both_say(traced(scene), "is padding, which");
}

TEST_F(SameWarnings, AreGivenForQuadraticCells) {
    std::string nodes = "10 3 1 0\n1 0 0 0 0\n2 1 0 0 90\n3 0 1 0 200\n4 0 0 1 255\n";
    nodes += "5 0 .5 .5 9\n6 0 0 .5 9\n7 .5 0 0 9\n8 .5 .5 0 9\n9 .5 0 .5 9\n10 0 .5 0 9\n";
    const json scene = mesh_scene(nodes, "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n");
    expect_both_say(scene, "1 quadratic or higher cells are drawn as straight pieces");
    expect_both_say(traced(scene), "1 quadratic or higher cells are drawn as straight pieces");
}

TEST_F(SameWarnings, AreGivenForOverlappingTets) {
    const json scene = mesh_scene(
        "8 3 1 0\n1 0 0 0 0\n2 1 0 0 90\n3 0 1 0 200\n4 0 0 1 255\n"
        "5 .1 .1 .1 0\n6 1.1 .1 .1 90\n7 .1 1.1 .1 200\n8 .1 .1 1.1 255\n",
        "2 4 0\n1 1 2 3 4\n2 5 6 7 8\n");
    expect_both_say(scene, "2 tets overlap others");
    expect_both_say(traced(scene), "the mesh overlaps itself on the rays of");
}

TEST_F(SameWarnings, AreGivenForMeshesThatStopAtMaxTets) {
    const std::filesystem::path maker = LAMINA_TETRAHEDRALIZE_BINARY;
    if (maker.empty()) GTEST_SKIP() << "built without TetGen";
    // The library searches for lamina-tetrahedralize in PATH.
    setenv("PATH", (maker.parent_path().string() + ":" + std::getenv("PATH")).c_str(), 1);
    json scene = gaussians_scene(12, 24, 18, 4);
    scene["mesh"] = {{"tolerance", 1e-3}, {"max_tets", 60}};
    scene["render"] = {{"method", "project"}};
    expect_both_say(scene, "the mesh stopped at max_tets");
}

}  // namespace
}  // namespace lamina
