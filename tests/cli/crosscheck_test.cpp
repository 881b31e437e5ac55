// SPDX-License-Identifier: Apache-2.0
// lamina crosscheck on the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 3> part_keys{"mesh", "slicing", "projection"};

class Crosschecks : public testing::Test {
  protected:
    void SetUp() override {
        if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty())
            GTEST_SKIP() << "built without TetGen";
        scene = blobs_scene(24, 24, 8);
    }

    ProgramResult run(const std::vector<std::string>& options) {
        write_bytes_to(folder / "blobs.json", scene.dump());
        std::vector<std::string> arguments{"crosscheck", folder / "blobs.json", "-o",
                                           folder / "out"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return lamina_run(arguments);
    }
    json run_well(std::vector<std::string> options = {}, const char* tolerances = ".2,.1",
                  const char* samples = "8,32") {
        for (const char* each :
             {"--tolerances", tolerances, "--samples", samples, "--context", "cpu"})
            options.emplace_back(each);
        const ProgramResult result = run(options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        out = result.out;
        err = result.err;
        return json::parse(read_bytes_of(folder / "out" / "budget.json"));
    }
    Image picture(const char* name) const {
        return read_exr(folder / "out" / (std::string(name) + ".exr"));
    }

    TemporaryFolder folder;
    json scene;
    std::string out, err;
};

// Norms of one channel, or of all (channel -1).
struct Norms {
    double linf = 0, l1 = 0, l2 = 0;
};

Norms norms_of(const std::vector<double>& e, int channel) {
    Norms norms;
    double count = 0;
    for (std::size_t i = 0; i < e.size(); ++i) {
        if (channel >= 0 && i % 4 != static_cast<std::size_t>(channel)) continue;
        norms.linf = std::max(norms.linf, std::abs(e[i]));
        norms.l1 += e[i];
        norms.l2 += e[i] * e[i];
        ++count;
    }
    return {norms.linf, norms.l1 / count, std::sqrt(norms.l2 / count)};
}

// Rounding of sums of 24 * 24 * 4 numbers up to 255 in different orders: at most 2304 * 2304 * 255
// u = 1.5e-7 before the division by 2304, with u = 2^-53.
void expect_norms(const json& found, const std::vector<double>& e) {
    const auto expect = [](const json& norms, const Norms& wanted) {
        EXPECT_NEAR(norms["linf"].get<double>(), wanted.linf, 1e-9);
        EXPECT_NEAR(norms["l1"].get<double>(), wanted.l1, 1e-9);
        EXPECT_NEAR(norms["l2"].get<double>(), wanted.l2, 1e-9);
    };
    expect(found, norms_of(e, -1));
    const char* const channels[] = {"R", "G", "B", "A"};
    for (int channel = 0; channel < 4; ++channel)
        expect(found["channels"][channels[channel]], norms_of(e, channel));
}

std::vector<double> difference_of(const Image& a, const Image& b) {
    std::vector<double> e(a.rgba.size());
    for (std::size_t i = 0; i < e.size(); ++i) e[i] = 255 * (double{a.rgba[i]} - double{b.rgba[i]});
    return e;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

TEST_F(Crosschecks, PartsOfTheFourPicturesAddUpToTheRawDifference) {
    const json budget = run_well();
    const Image traced_volume = picture("traced_volume"), traced_mesh = picture("traced_mesh"),
                sliced = picture("sliced"), projected = picture("projected");
    ASSERT_EQ(traced_volume.width, 24);
    ASSERT_EQ(projected.rgba.size(), 24u * 24 * 4);
    const std::array<std::vector<double>, 3> parts{difference_of(traced_mesh, traced_volume),
                                                   difference_of(sliced, traced_volume),
                                                   difference_of(projected, traced_mesh)};
    const std::vector<double> raw = difference_of(projected, sliced);
    for (std::size_t i = 0; i < raw.size(); ++i)
        EXPECT_NEAR(parts[0][i] - parts[1][i] + parts[2][i], raw[i], 1e-6) << i;

    std::size_t dominant = 0;
    double shares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const json& part = budget["parts"][part_keys[i]];
        expect_norms(part, parts[i]);
        const double sign = i == 1 ? -1 : 1;
        EXPECT_NEAR(part["share"].get<double>(), sign * product(parts[i], raw) / product(raw, raw),
                    1e-9);
        shares += part["share"].get<double>();
        if (norms_of(parts[i], -1).l2 > norms_of(parts[dominant], -1).l2) dominant = i;
    }
    expect_norms(budget["raw"], raw);
    EXPECT_NEAR(shares, 1, 1e-9);
    EXPECT_EQ(budget["dominant"], part_keys[dominant]);
    EXPECT_LT(budget["residual"].get<double>(), 1e-6);
    EXPECT_GT(norms_of(raw, -1).linf, 1);  // there is a difference to split
    EXPECT_LT(budget["reference_error"].get<double>(), 0.01);
}

TEST_F(Crosschecks, WriteIntoTheirFolderAlone) {
    const auto before = std::filesystem::current_path();
    std::filesystem::create_directory(folder / "here");
    std::filesystem::current_path(folder / "here");
    run_well();
    std::filesystem::current_path(before);
    EXPECT_TRUE(std::filesystem::is_empty(folder / "here"));
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
        names.insert(entry.path().filename());
    EXPECT_EQ(names, (std::set<std::string>{"budget.json", "lamina-files.txt", "projected.exr",
                                            "report.html", "sliced.exr", "traced_mesh.exr",
                                            "traced_volume.exr"}));
}

TEST_F(Crosschecks, NameTheGradientsOfLitScenes) {
    EXPECT_FALSE(run_well({}, ".2", "8")["parts"].contains("gradients"));
    scene["lighting"] = json::object();
    const json parts = run_well({}, ".2", "8")["parts"];
    ASSERT_EQ(parts.size(), 4u);
    // A mesh of tolerance .2 has other gradients than the volume, so lighting adds to the
    // difference.
    EXPECT_GT(parts["gradients"]["linf"], .5);
    double shares = 0;
    for (const json& part : parts) shares += part["share"].get<double>();
    EXPECT_NEAR(shares, 1, 1e-9);
    EXPECT_NE(out.find(", gradients "), std::string::npos) << out;
}

TEST_F(Crosschecks, TheFourPicturesAreThoseOfRender) {
    run_well();
    const auto expect_picture = [&](const char* name, const std::vector<std::string>& options) {
        const std::string drawn = folder / "drawn.exr";
        std::vector<std::string> arguments{"render", folder / "blobs.json", "-o",
                                           drawn,    "--context",           "cpu"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        ASSERT_EQ(lamina_run(arguments).exit_code, 0);
        EXPECT_EQ(read_exr(drawn).rgba, picture(name).rgba) << name;
    };
    expect_picture("traced_volume", {"--method", "trace"});
    expect_picture("traced_mesh", {"--method", "trace", "--set", "render.trace.of=mesh"});
    expect_picture("sliced", {"--method", "slice"});
    expect_picture("projected", {"--method", "project"});
}

TEST_F(Crosschecks, TheLadderHasEveryStepWithItsErrorsAndTimes) {
    scene["mesh"]["tolerance"] = 0.15;
    scene["render"]["slice"]["samples"] = 16;
    scene["render"]["slice"]["classification"] = "post";
    const json budget = run_well();
    const json& ladder = budget["ladder"];
    json samples = json::array(), tolerances = json::array(), tets = json::array();
    for (const json& each : ladder["slicing"]) {
        samples.push_back(each["samples"]);
        EXPECT_GT(each["frame_ms"]["median"], 0);
    }
    for (const json& each : ladder["projection"]) {
        tolerances.push_back(each["tolerance"]);
        tets.push_back(each["tets"]);
        EXPECT_GT(each["frame_ms"]["median"], 0);
        EXPECT_LE(each["mesh_error"], each["tolerance"]);
    }
    EXPECT_EQ(samples, json({8, 16, 32}));  // 16 is the scene's own number of slabs
    EXPECT_EQ(tolerances, json({0.2, 0.15, 0.1}));
    EXPECT_LT(tets[0], tets[2]);
    EXPECT_LT(ladder["slicing"][2]["method"]["l2"], ladder["slicing"][0]["method"]["l2"]);
    ASSERT_EQ(ladder["pairs"].size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) {
        const json& pair = ladder["pairs"][i];
        const json &projection = ladder["projection"][i / 3], &slicing = ladder["slicing"][i % 3];
        EXPECT_EQ(pair["tolerance"], projection["tolerance"]);
        EXPECT_EQ(pair["samples"], slicing["samples"]);
        const double l2[] = {projection["mesh"]["l2"], slicing["method"]["l2"],
                             projection["method"]["l2"]};
        EXPECT_EQ(pair["dominant"],
                  part_keys[static_cast<std::size_t>(std::max_element(l2, l2 + 3) - l2)]);
    }
    // The budget is that of one of these pairs, at the scene's own settings.
    EXPECT_EQ(budget["samples"], 16);
    EXPECT_EQ(budget["tolerance"], 0.15);
    EXPECT_EQ(ladder["pairs"][4]["l2"], budget["raw"]["l2"]);
    EXPECT_EQ(ladder["pairs"][4]["linf"], budget["raw"]["linf"]);
}

// Few slabs with a fine mesh: slicing dominates. Many slabs with a coarse mesh: the mesh does.
TEST_F(Crosschecks, SayWhichPartDominates) {
    scene["mesh"]["tolerance"] = 0.02;
    scene["render"]["slice"]["samples"] = 4;
    scene["render"]["slice"]["classification"] = "post";
    json budget = run_well({}, ".02", "4");
    EXPECT_EQ(budget["dominant"], "slicing");
    EXPECT_GT(budget["parts"]["slicing"]["share"], 0.5);
    EXPECT_NE(out.find("the slicing method dominates"), std::string::npos) << out;
    scene["mesh"]["tolerance"] = 0.2;
    scene["render"]["slice"]["samples"] = 128;
    budget = run_well({}, ".2", "128");
    EXPECT_EQ(budget["dominant"], "mesh");
    EXPECT_GT(budget["parts"]["mesh"]["share"], 0.5);
    EXPECT_NE(out.find("mesh discretisation dominates"), std::string::npos) << out;
    // The coarsest and the finest settings are the scene's own, so no finding repeats them.
    EXPECT_EQ(budget["findings"].size(), 2u);
    for (const json& finding : budget["findings"])
        EXPECT_NE(out.find(finding.get<std::string>()), std::string::npos) << finding;
    const std::string page = read_bytes_of(folder / "out" / "report.html");
    EXPECT_NE(page.find("Projected tetrahedra (PT) against slicing: blobs"), std::string::npos);
}

// A finding has one L2 at most; the other numbers are in the tables and beside the pictures.
TEST_F(Crosschecks, SayEachThingOnceAndInFullWords) {
    scene["mesh"]["tolerance"] = 0.2;
    scene["render"]["slice"]["samples"] = 1;
    const json budget = run_well({"--set", "render.max_error=0.001"}, ".2,.1", "1,32");
    ASSERT_EQ(budget["findings"].size(), 3u);  // the coarsest settings are the scene's own
    const std::string first = budget["findings"][0];
    EXPECT_NE(first.find(" and 1 slab, projected tetrahedra (PT) and slicing differ by Linf "),
              std::string::npos)
        << first;
    EXPECT_EQ(out.find("1 slabs"), std::string::npos) << out;
    EXPECT_EQ(out.find("-0.0 %"), std::string::npos) << out;
    std::size_t norms = 0;
    for (std::size_t at = out.find("L2 "); at != std::string::npos; at = out.find("L2 ", at + 1))
        ++norms;
    EXPECT_EQ(norms, 1u) << out;
    const std::string page = read_bytes_of(folder / "out" / "report.html");
    EXPECT_NE(page.find("\"slicing, 1 slab\""), std::string::npos);
    EXPECT_EQ(page.find("1 slabs"), std::string::npos);
}

// If the scene states no mesh, the finest mesh of the ladder counts as the scene's, and refining
// ends at 250000 tets.
TEST_F(Crosschecks, TheDefaultLadderSaysItsCostAndEnds) {
    scene.erase("mesh");
    const std::vector<std::string> short_ladder{"--samples", "8",     "--context",
                                                "cpu",       "--set", "render.max_error=20"};
    ProgramResult result = run(short_ladder);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("meshes of up to 250000 tets: meshes take about "), std::string::npos)
        << result.err;
    json budget = json::parse(read_bytes_of(folder / "out" / "budget.json"));
    EXPECT_LE(budget["ladder"]["projection"].back()["tets"], 250000);
    // A mesh that the scene states is drawn with its own max_tets.
    scene["mesh"] = {{"tolerance", .001}, {"max_tets", 500}};
    result = run(short_ladder);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    budget = json::parse(read_bytes_of(folder / "out" / "budget.json"));
    EXPECT_EQ(budget["tolerance"], .001);
    EXPECT_LE(budget["ladder"]["projection"].back()["tets"], 500);
    EXPECT_EQ(budget["ladder"]["projection"].back()["tolerance"], .001);
}

TEST_F(Crosschecks, FindWhereBothMethodsAgree) {
    const json budget = run_well({"--set", "render.max_error=200"});
    EXPECT_EQ(budget["wanted"], 200);
    EXPECT_NE(out.find("agrees within 200/255 in every pixel"), std::string::npos) << out;
    run_well({"--set", "render.max_error=0.001"});
    EXPECT_NE(out.find("agree nowhere on this ladder within 0.001/255"), std::string::npos) << out;
}

TEST_F(Crosschecks, AMeshOfAFileIsTheOnlyStep) {
    const std::string mesh = folder / "blobs.vtu";
    write_bytes_to(folder / "blobs.json", scene.dump());
    ASSERT_EQ(lamina_run({"mesh", folder / "blobs.json", "-o", mesh}).exit_code, 0);
    scene["mesh"] = "blobs.vtu";
    const json budget = run_well();
    ASSERT_EQ(budget["ladder"]["projection"].size(), 1u);
    EXPECT_EQ(budget["ladder"]["pairs"].size(), 2u);
    EXPECT_GT(budget["ladder"]["projection"][0]["tets"], 100);
    EXPECT_NE(err.find("lamina: --tolerances: not used: the scene's mesh is a file, "),
              std::string::npos)
        << err;
    EXPECT_NE(err.find("blobs.vtu\n"), std::string::npos) << err;
    // A Kuhn mesh has no tolerance, either.
    scene["mesh"] = {{"kuhn", true}};
    EXPECT_EQ(run_well()["ladder"]["projection"].size(), 1u);
    EXPECT_NE(err.find("--tolerances: not used: the scene's mesh is Kuhn's"), std::string::npos)
        << err;
    scene["mesh"] = json::object();
    run_well({}, ".2");
    EXPECT_EQ(err.find("not used"), std::string::npos) << err;
}

// Lists are separated by commas, as the help says; each value is drawn.
TEST_F(Crosschecks, HelpSaysHowListsAreWritten) {
    const std::string help = lamina_run({"crosscheck", "--help"}).out;
    EXPECT_NE(help.find("--tolerances T,T,..."), std::string::npos) << help;
    EXPECT_NE(help.find("--samples N,N,..."), std::string::npos) << help;
    EXPECT_NE(help.find("--set KEY=VALUE"), std::string::npos) << help;
    const json budget = run_well({}, ".3,.25,.2", "8,16");
    EXPECT_EQ(budget["ladder"]["projection"].size(), 4u);  // three, and the scene's own
}

TEST_F(Crosschecks, BadArgumentsGiveOneLineAndWriteNothing) {
    const auto expect_refused = [&](int code, const std::vector<std::string>& options,
                                    const std::string& part) {
        const ProgramResult result = run(options);
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << part << ": " << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "out" / "report.html")) << part;
        EXPECT_LE(std::filesystem::remove_all(folder / "out"), code == 1 ? 1u : 0u) << part;
    };
    for (const char* bad : {"0", "-0.1", "1.5", "nan", "x", ".1,,0"})
        expect_refused(2, {std::string("--tolerances=") + bad}, "--tolerances");
    for (const char* bad : {"0", "-8", "65537", "2.5", "x"})
        expect_refused(2, {std::string("--samples=") + bad}, "--samples");
    expect_refused(2, {"--context", "directx"}, "directx");
    expect_refused(2, {"--nonsense"}, "--nonsense");
    expect_refused(2, {"--set", "render.slice.sampels=8"}, "sampels");
    const json kept = scene;
    scene["volume"] = "absent.nrrd";
    expect_refused(1, {}, "absent.nrrd");
    scene.erase("volume");
    scene["mesh"] = "absent.vtu";
    scene["render"]["method"] = "project";
    expect_refused(1, {}, "volume: is missing, expected the volume that both methods show");
    scene = kept;
    scene["render"]["slise"] = 1;
    expect_refused(1, {}, "did you mean \"slice\"");
    EXPECT_EQ(lamina_run({"crosscheck", folder / "absent.json", "-o", folder / "out"}).exit_code,
              1);
    EXPECT_EQ(lamina_run({"crosscheck", folder / "blobs.json"}).exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace lamina
