// SPDX-License-Identifier: Apache-2.0
#include "papers/kraus.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gl/gl_fixture.h"
#include "image/difference.h"
#include "mesh/mesh_shape.h"
#include "papers/compared_pictures.h"
#include "papers/figure_files.h"
#include "papers/paper_item.h"
#include "render/pipeline.h"
#include "support/temporary_folder.h"

namespace lamina::papers {
namespace {

using Json = nlohmann::ordered_json;

KrausSizes small_sizes() {
    KrausSizes sizes;
    sizes.width = sizes.timed_width = 64;
    sizes.height = sizes.timed_height = 48;
    sizes.graded_cells = 6;
    sizes.graded_layers = 24;
    sizes.box_cells = 6;
    sizes.timed_box_cells = {2, 3, 4};
    return sizes;
}

double largest_opacity(const PreciseImage& image) {
    double largest = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        largest = std::max(largest, image.rgba[i]);
    return largest;
}

double volume(const TetMesh& mesh) {
    double sum = 0;
    for (const Tet& tet : mesh.tets()) {
        const auto at = [&](std::size_t i) {
            return mesh.points()[static_cast<std::size_t>(tet[i])];
        };
        sum += glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
    }
    return sum;
}

TEST(GridMesh, BoxFillsTheUnitCube) {
    const SceneMesh box = make_box_mesh({3, 4, 5});
    EXPECT_EQ(box.mesh.tets().size(), 6u * 3 * 4 * 5);
    EXPECT_NEAR(volume(box.mesh), 1, 1e-12);  // sum of 360 terms, each rounded by about 1e-16
    EXPECT_TRUE(convex(box.mesh));
    const auto [low, high] = std::ranges::minmax(box.scalar.values);
    EXPECT_GE(low, 0);
    EXPECT_GT(high, 0.5);
}

TEST(GridMesh, HasTheGivenEdgeRatioIfGraded) {
    for (const double bump : {0.0, 0.25}) {
        const SceneMesh graded = make_graded_mesh(5, 20, 1e4, bump);
        EXPECT_EQ(graded.mesh.tets().size(), 6u * 5 * 5 * 20);
        // The first layer is exact. It changes the longest edge, in the outermost layer, by about
        // 1e-4 of it.
        EXPECT_NEAR(edge_lengths(graded.mesh).ratio(), 1e4, 10);
        EXPECT_TRUE(graded.mesh.findings().conforming());
        EXPECT_EQ(graded.mesh.findings().inverted, 0);
        EXPECT_EQ(convex(graded.mesh), bump == 0);
    }
}

TEST(Panels, AreTakenOutOfAResultWhereverTheyAre) {
    Panels first, second;
    first.add("", "dark", Image(3, 2));
    Image light(3, 2);
    std::fill(light.rgba.begin(), light.rgba.end(), 2.0f);  // clamped
    second.add("group", "light", light);
    const Difference e{1, 2, {"Y"}, {-3, 2}};
    second.add_difference("group", "e", e, 2, CodedImage(1, 2, 3, 8));
    Json result{{"values", {{"panels", first.json()}, {"meshes", {{{"panels", second.json()}}}}}},
                {"note", "Agrees."},
                {"verdict", "agrees"},
                {"remark", "More."},
                {"checks", Json::array()},
                {"own", Json::array()}};
    const Json panels = take_panels(result);
    ASSERT_EQ(panels.size(), 3u);
    EXPECT_EQ(panels[0]["title"], "dark");
    EXPECT_EQ(panels[1]["group"], "group");
    EXPECT_NE(panels[0]["image"], panels[1]["image"]);
    EXPECT_EQ(panels[2]["scale"], 2);
    EXPECT_EQ(panels[2]["largest"], 3);
    EXPECT_EQ(panels[0]["width"], 3);
    EXPECT_EQ(panels[0]["height"], 2);
    EXPECT_EQ(result["values"], Json::parse(R"({"meshes": [{}]})"));
    // Plots (.svg) among the files come after the panels; errors of curves become the table.
    const TemporaryFolder folder;
    write_bytes_to(folder / "f.svg", "<svg/>");
    result["values"] = {{"files", {"f.csv", "f.svg"}},
                        {"caption", "Two curves."},
                        {"errors", {{"high", {{"linf", 2}, {"l1", 1}, {"l2", 1.5}}}}}};
    const Json section = page_section("figure", result, panels, folder.path());
    ASSERT_EQ(section["pictures"].size(), 4u);
    EXPECT_EQ(section["pictures"][3]["title"], "f");
    EXPECT_EQ(section["pictures"][3]["image"], "data:image/svg+xml;base64,PHN2Zy8+");
    EXPECT_EQ(section["rows"],
              Json::parse(R"([{"curve": "high", "linf": 2, "l1": 1, "l2": 1.5}])"));
    EXPECT_EQ(section["verdict"], "agrees");
    EXPECT_EQ(section["note"], "More.");
    EXPECT_EQ(section["anchor"], "figure");
    EXPECT_EQ(section["caption"], "Two curves.");
}

// Expects the keys of a result without data sets, its files, and no file that the item does not
// name.
void expect_complete(const std::string& name, const Json& result, const TemporaryFolder& folder) {
    const auto item = std::find_if(kraus_items().begin(), kraus_items().end(),
                                   [&](const KrausItem& each) { return each.name == name; });
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const std::string file = entry.path().filename();
        EXPECT_EQ(std::count(item->files.begin(), item->files.end(), file), 1) << file;
    }
    for (const char* key : {"values", "paper", "verdict", "agrees", "note", "checks", "own"})
        ASSERT_TRUE(result.contains(key)) << key;
    EXPECT_TRUE(result["agrees"].is_null());  // the paper's statements are about measured meshes
    EXPECT_EQ(result["note"].get<std::string>().find("Set LAMINA_DATA to a folder that holds"), 0u);
    EXPECT_FALSE(result["checks"].empty() && result["own"].empty());
    for (const Json& check : result["checks"])
        EXPECT_EQ(check["verdict"], "cannot be tested here") << check["says"];
    Json without_panels = result;
    EXPECT_EQ(take_panels(without_panels).empty(), !result["values"].contains("caption")) << name;
    ASSERT_FALSE(result["values"]["files"].empty());
    for (const Json& file : result["values"]["files"])
        EXPECT_GT(std::filesystem::file_size(folder / file.get<std::string>()), 0u) << file;
}

class Kraus : public gl::GlTest {};

TEST_F(Kraus, TransferFunctionsGiveTheOpacityWanted) {
    KrausStage stage(capabilities(), small_sizes(), {});
    KrausSubject& box = stage.subject("bluntfin");
    EXPECT_EQ(box.name, "box");  // the stand-in for a missing data set
    const auto largest = [&](Scene scene) {
        scene.width /= 4;  // size of the coarse picture that the factor was measured on
        scene.height /= 4;
        return largest_opacity(box.mesh.exact(scene));
    };
    // Optical depth is proportional to extinction (Beer's law). The tracer's error is 1e-12 at a
    // depth of 1e-3.
    EXPECT_NEAR(largest(box.smooth), 0.48, 1e-8);
    EXPECT_NEAR(largest(box.dense), 0.95, 1e-8);
    EXPECT_NEAR(largest(box.isosurface), 0.98, 1e-8);
}

TEST_F(Kraus, TracesASceneOnce) {
    KrausStage stage(capabilities(), small_sizes(), {});
    KrausSubject& plate = stage.subject("plate");
    const PreciseImage* const traced = &plate.mesh.exact(plate.smooth);
    EXPECT_EQ(&plate.mesh.exact(with_target(plate.smooth, Target::fixed8)), traced);
    EXPECT_NE(&plate.mesh.exact(plate.dense), traced);
    Scene moved = plate.smooth;
    moved.camera->eye.x += 1e-9;
    EXPECT_NE(&plate.mesh.exact(moved), traced);
    EXPECT_EQ(&plate.mesh.exact(plate.smooth), traced);
}

TEST_F(Kraus, PicturesAgreeWithTheTracer) {
    KrausStage stage(capabilities(), small_sizes(), {});
    KrausSubject& box = stage.subject("box");
    const Image image = plain_picture(with_default_integration(box.dense), box.mesh.data(),
                                      capabilities(), box.tables);
    // With default settings the error is below the default of render.max_error (docs/scene.md).
    EXPECT_LE(image_error(image, box.mesh.exact(box.dense)).all.linf, 1);
}

// Draws all items but figure 10 and the artifacts, whose tests are below, without data sets.
TEST_F(Kraus, EveryItemHasItsKeysAndWritesItsFiles) {
    KrausStage stage(capabilities(), small_sizes(), {});
    for (const KrausItem& item : kraus_items()) {
        ASSERT_NE(item.draw, nullptr) << item.name;
        if (item.name == "figure10" || item.name == "artifacts") continue;
        const TemporaryFolder folder;
        expect_complete(item.name, item.draw(folder.path(), stage), folder);
    }
}

// Figure 10 of the paper: with equally spaced lengths, thin cells lose most of their opacity.
TEST_F(Kraus, LinearLengthsMakeFigure10TooDark) {
    KrausStage stage(capabilities(), small_sizes(), {});
    const TemporaryFolder folder;
    const Json figure = draw_kraus_figure10(folder.path(), stage);
    expect_complete("figure10", figure, folder);
    const Json& plate = figure["values"]["meshes"][1];
    EXPECT_EQ(plate["mesh"], "plate");
    EXPECT_NEAR(plate["edge_ratio"].get<double>(), 1e4, 10);
    EXPECT_LT(plate["rows"][0]["l1"], 0);
    // Their L2 is some tens against some units.
    EXPECT_GT(plate["rows"][0]["l2"], 5 * plate["rows"][1]["l2"].get<double>());
    EXPECT_GT(plate["rows"][0]["l2"], 5 * plate["rows"][2]["l2"].get<double>());
}

TEST_F(Kraus, ArtifactsHaveARowForEveryRemedy) {
    KrausStage stage(capabilities(), small_sizes(), {});
    const TemporaryFolder folder;
    const Json artifacts = draw_kraus_artifacts(folder.path(), stage);
    expect_complete("artifacts", artifacts, folder);
    std::map<std::string, double> l2;
    for (const Json& row : artifacts["values"]["rows"]) {
        l2[row["mesh"].get<std::string>() + ", " + row["transfer_function"].get<std::string>() +
           ", " + row["picture"].get<std::string>()] = row["l2"];
    }
    EXPECT_EQ(l2.size(), 3u * (2 * 14 + 4));  // smooth and isosurface, faint
    EXPECT_GT(l2.at("box, faint, fixed8 buffer"), l2.at("box, faint, fixed8 buffer, after_blend"));
    EXPECT_GT(l2.at("box, smooth, linear interpolation"), l2.at("box, smooth, all remedies"));
    EXPECT_GT(l2.at("box, smooth, fixed8 table"), l2.at("box, smooth, all remedies"));
    EXPECT_GT(l2.at("box, smooth, fixed8 buffer"), l2.at("box, smooth, float16 buffer"));
}

}  // namespace
}  // namespace lamina::papers
