// SPDX-License-Identifier: Apache-2.0
// Choices that a pipeline makes before it plans.
#include "render/pipeline.h"

#include <array>
#include <fstream>
#include <memory>

#include "base/output_file.h"
#include "image/difference.h"
#include "mesh_files/mesh_file.h"
#include "scene/given_transfer.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/scene_fixture.h"
#include "support/split_box.h"
#include "support/stored_volume.h"
#include "support/temporary_folder.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

nlohmann::json with_open_map() {
    return with("/transfer_function",
                {{"colormap", "greys"}, {"points", {{{"value", 0}, {"extinction", 1}}}}});
}

// Each channel of a file has its own range.
TEST(Pipeline, StretchesAColormapOverTheChannelThatIsDrawn) {
    const TemporaryFolder folder;
    std::ofstream(folder / "two.mha")
        << "ObjectType = Image\nNDims = 3\nDimSize = 2 2 1\nElementType = MET_UCHAR\n"
           "ElementNumberOfChannels = 2\nBinaryData = False\nElementDataFile = LOCAL\n"
           "0 0 1 200 0 100 1 50\n";
    for (const auto& [channel, highest] :
         {std::pair(0, 1.), std::pair(1, 200.), std::pair(0, 1.)}) {
        nlohmann::json document = with_open_map();
        document["image"]["color_space"] = "display";
        document["volume"] = {{"path", "two.mha"}, {"channel", channel}};
        Pipeline pipeline(read_scene(document, folder / "scene.json"));
        const TransferFunction& function = *pipeline.scene().transfer_function;
        EXPECT_EQ(function.at(highest).color, glm::dvec3(1)) << channel;
        EXPECT_NEAR(function.at(highest / 2).color.g, .5, 1e-15) << channel;  // a few roundings
        EXPECT_TRUE(has_open_colormap(pipeline.asked()));
    }
}

TEST(Pipeline, KeepsItsContextCurrentWhenAsked) {
    Pipeline pipeline(read_scene(minimal_scene(), "s"), {}, {.context = ContextChoice::osmesa});
    EXPECT_EQ(pipeline.make_current(), nullptr);  // it opens one for its first frame
    Image alone, held;
    pipeline.draw(alone);
    EXPECT_EQ(gl::current_context(), nullptr);
    {
        const auto current = pipeline.make_current();
        gl::Context* const context = gl::current_context();
        EXPECT_NE(context, nullptr);
        pipeline.draw(held);
        EXPECT_EQ(gl::current_context(), context);
    }
    EXPECT_EQ(gl::current_context(), nullptr);
    EXPECT_EQ(held.rgba, alone.rgba);
}

TEST(Pipeline, IntegratesVoxelsExactlyAndUnlit) {
    nlohmann::json document = minimal_scene();
    document["volume"]["lookup"] = "nearest";
    document["lighting"] = nlohmann::json::object();
    test::HeardWarnings heard;
    Pipeline pipeline(read_scene(document, "s"));
    EXPECT_EQ(pipeline.scene().slice.classification, Classification::exact);
    EXPECT_FALSE(pipeline.scene().lighting);
    ASSERT_EQ(heard.texts.size(), 1u);
    EXPECT_NE(heard.texts[0].find("nothing is lit"), std::string::npos) << heard.texts[0];
    // Light that was left open is not chosen, for a reason.
    document["lighting"] = "auto";
    Pipeline open(read_scene(document, "s"));
    EXPECT_FALSE(open.scene().lighting);
    ASSERT_EQ(open.reasons().size(), 1u);
    EXPECT_NE(open.reasons()[0].find("lighting: not lit, because"), std::string::npos);
    EXPECT_EQ(heard.texts.size(), 1u);
    document["render"]["slice"]["classification"] = "preintegrated";
    Pipeline slabs(read_scene(document, "s"));
    expect_error([&] { slabs.scene(); },
                 {"s: render.slice.classification: found \"preintegrated\"", "\"nearest\""});
}

// Measuring what light costs leaves no trace in the picture that is drawn next.
TEST(Pipeline, MeasuresWhatLightCosts) {
    nlohmann::json document = minimal_scene();
    document["image"] = {{"width", 48}, {"height", 40}};
    Pipeline unlit(read_scene(document, "s"));
    EXPECT_EQ(unlit.light_cost(), "");
    document["lighting"] = nlohmann::json::object();
    Pipeline lit(read_scene(document, "s")), measured(read_scene(document, "s"));
    const std::string cost = measured.light_cost();
    EXPECT_NE(cost.find("times as long as without light (measured at 12 x 10"), std::string::npos)
        << cost;
    Image expected, picture;
    lit.draw(expected);
    measured.draw(picture);
    ASSERT_EQ(picture.width, 48);
    EXPECT_TRUE(picture.rgba == expected.rgba);
}

// The plan is explained all the same, and the picture has its size again.
TEST(Pipeline, SaysWhyItCannotMeasureWhatLightCosts) {
    nlohmann::json document = minimal_scene();
    document["image"] = {{"width", 48}, {"height", 40}};
    document["lighting"] = nlohmann::json::object();
    const Volume volume =
        test::volume_of<float>(test::grid_of({8, 8, 8}, Centering::node),
                               [](double i, double j, double k) { return (i + j + k) / 21; });
    auto source = std::make_unique<test::SourceInMemory>(volume);
    test::SourceInMemory& files = *source;
    PipelineOptions options;
    options.context = ContextChoice::cpu;
    Pipeline pipeline(read_scene(document, "s"),
                      SceneData(Volume(volume.grid(), volume.type(),
                                       std::make_shared<const VolumeStore>(
                                           volume.grid(), volume.type(), std::move(source)))),
                      options);
    pipeline.plan();
    files.changed = true;
    const std::string cost = pipeline.light_cost();
    EXPECT_NE(cost.find("light\n  what it costs cannot be measured: "), std::string::npos) << cost;
    EXPECT_NE(cost.find("the files were changed"), std::string::npos) << cost;
    files.changed = false;
    Image picture;
    pipeline.draw(picture);
    EXPECT_EQ(picture.width, 48);
}

// Writes 40 samples each of the labels 0, 9 and `last`.
void write_labels(const std::filesystem::path& file, std::int64_t last) {
    std::string samples;
    for (const std::int64_t label : {std::int64_t{0}, std::int64_t{9}, last})
        for (int i = 0; i < 40; ++i)
            samples.append(reinterpret_cast<const char*>(&label), sizeof label);
    write_bytes_to(file,
                   "NRRD0004\ntype: int64\ndimension: 3\nsizes: 120 1 1\nencoding: raw\n"
                   "endian: little\n\n" +
                       samples);
}

// Labels 0, 9 and 5000000000 have the codes 0 to 2; functions that are given mean the labels.
TEST(Pipeline, GivesLabelsTheOpticsOfTheirNumbers) {
    const TemporaryFolder folder;
    write_labels(folder / "a.nrrd", 5000000000);
    nlohmann::json document = minimal_scene();
    document["volume"] = {{"path", "a.nrrd"}};
    document["transfer_function"] = {{"interpolation", "nearest"},
                                     {"points",
                                      {{{"value", 0}, {"color", {0, 0, 0}}, {"extinction", 0}},
                                       {{"value", 9}, {"color", {1, 0, 0}}, {"extinction", 1}},
                                       {{"value", 5e9}, {"color", {0, 0, 1}}, {"extinction", 2}}}}};
    Pipeline pipeline(read_scene(document, folder / "scene.json"));
    const auto expect_colours = [&](const TransferFunction& function) {
        EXPECT_TRUE(function.of_codes());
        EXPECT_EQ(function.at(1).color, glm::dvec3(1, 0, 0));
        EXPECT_EQ(function.at(2).color, glm::dvec3(0, 0, 1));
    };
    expect_colours(*pipeline.scene().transfer_function);
    // A saved scene names codes, and is not converted again.
    Pipeline saved(read_scene(scene_json(pipeline.scene()), folder / "saved.json"));
    EXPECT_EQ(saved.scene().transfer_function, pipeline.scene().transfer_function);
    pipeline.set_transfer_function(*pipeline.asked().transfer_function);
    expect_colours(*pipeline.scene().transfer_function);
    // A range is one of numbers, over which labels are not spread.
    PipelineOptions ranged;
    ranged.adjustments.transfer.range = ValueRange{0, 9};
    expect_error([&] { Pipeline(read_scene(document, folder / "scene.json"), {}, ranged).scene(); },
                 {"a.nrrd: found a range of values and a transfer function of labels"});
    document.erase("transfer_function");
    Pipeline chosen(read_scene(document, folder / "scene.json"));
    EXPECT_TRUE(chosen.scene().transfer_function->of_codes());
    EXPECT_EQ(chosen.scene().transfer_function->at(0).extinction, 0);
    EXPECT_NE(chosen.scene().transfer_function->at(1).color,
              chosen.scene().transfer_function->at(2).color);
}

// Codes are those of the labels that a file had when the scene was saved.
TEST(Pipeline, RefusesCodesOfOtherLabels) {
    const TemporaryFolder folder;
    write_labels(folder / "a.nrrd", 5000000000);
    nlohmann::json document = minimal_scene();
    document["volume"] = {{"path", (folder / "a.nrrd").string()}};
    document.erase("transfer_function");
    Pipeline first(read_scene(document, folder / "scene.json"));
    const nlohmann::json saved = scene_json(first.scene());
    EXPECT_TRUE(saved["transfer_function"]["codes_of"].is_string());
    write_labels(folder / "a.nrrd", 6000000000);
    const auto draw = [&](const nlohmann::json& scene) {
        Pipeline(read_scene(scene, folder / "saved.json")).scene();
    };
    expect_error([&] { draw(saved); },
                 {"saved.json: transfer_function.codes_of: ", "codes of other labels"});
    nlohmann::json linear = saved;
    linear["volume"]["lookup"] = "linear";
    expect_error([&] { draw(linear); }, {"codes of other labels"});
    nlohmann::json trusted = saved;  // as a user writes codes
    trusted["transfer_function"].erase("codes_of");
    draw(trusted);
}

// 2^53 and 2^53 + 1 are one double.
TEST(Pipeline, SaysWhichLabelsTransferFunctionsDoNotTellApart) {
    const TemporaryFolder folder;
    std::string values;
    for (const char* const label : {" 0", " 9007199254740992", " 9007199254740993"})
        for (int i = 0; i < 40; ++i) values += label;
    write_bytes_to(
        folder / "a.nrrd",
        "NRRD0004\ntype: int64\ndimension: 3\nsizes: 120 1 1\nencoding: ascii\n\n" + values + "\n");
    nlohmann::json document = minimal_scene();
    document["volume"] = {{"path", (folder / "a.nrrd").string()}};
    test::HeardWarnings heard;
    Pipeline pipeline(read_scene(document, folder / "scene.json"));
    pipeline.scene();
    EXPECT_NE(heard.all().find("do not tell labels 9007199254740992 and 9007199254740993 apart"),
              std::string::npos)
        << heard.all();
}

TEST(Pipeline, SaysThatALabelHasTheColourOfTheBackground) {
    const TemporaryFolder folder;
    std::string values;
    for (const char* const label : {" 0", " 1", " 2"})
        for (int i = 0; i < 40; ++i) values += label;
    write_bytes_to(folder / "a.nrrd",
                   "NRRD0005\ntype: uint8\ndimension: 3\nsizes: 120 1 1\nencoding: ascii\n"
                   "Segment0_ID:=a\nSegment0_LabelValue:=1\nSegment0_Color:=0 0 0\n"
                   "Segment1_ID:=b\nSegment1_LabelValue:=2\nSegment1_Color:=1 1 1\n\n" +
                       values + "\n");
    nlohmann::json document = minimal_scene();
    document["volume"] = {{"path", (folder / "a.nrrd").string()}};
    document.erase("transfer_function");
    test::HeardWarnings heard;
    Pipeline pipeline(read_scene(document, folder / "scene.json"));
    EXPECT_EQ(pipeline.scene().transfer_function->at(1).color, glm::dvec3(0));  // as the file says
    EXPECT_NE(heard.all().find("gives the background's colour to 1 of its labels (1)"),
              std::string::npos)
        << heard.all();
    heard.texts.clear();
    document["image"]["background"] = {1, 1, 1};
    Pipeline white(read_scene(document, folder / "scene.json"));
    white.scene();
    EXPECT_NE(heard.all().find("to 1 of its labels (2)"), std::string::npos) << heard.all();
}

TEST(Pipeline, StretchesAnotherColormapOverTheDataItHas) {
    Pipeline pipeline(read_scene(minimal_scene(), "s"));
    pipeline.set_transfer_function_of(read_scene(with_open_map(), "s"));
    Pipeline fresh(read_scene(with_open_map(), "s"));
    EXPECT_EQ(pipeline.scene().transfer_function, fresh.scene().transfer_function);
    EXPECT_TRUE(has_open_colormap(pipeline.asked()));
    nlohmann::json open = minimal_scene();
    open.erase("transfer_function");
    pipeline.set_transfer_function_of(read_scene(open, "s"));
    Pipeline chosen(read_scene(open, "s"));
    EXPECT_EQ(pipeline.scene().transfer_function, chosen.scene().transfer_function);
}

// The pictures of a volume and of a mesh beside it have the same colours.
TEST(Pipeline, StretchesAColormapOverTheVolumeForItsMeshToo) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "wide.vtu");
    write_vtu(file, test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return 5000 * p.x; }));
    file.commit();
    nlohmann::json document = with_open_map();
    document["mesh"] = (folder / "wide.vtu").string();
    Pipeline slices(read_scene(document, "s"));
    document["render"]["method"] = "project";
    Pipeline tets(read_scene(document, "s"));
    EXPECT_EQ(slices.scene().transfer_function, tets.scene().transfer_function);
    document.erase("volume");
    Pipeline alone(read_scene(document, "s"));
    // 5000 x, where x goes to 2.
    EXPECT_EQ(alone.scene().transfer_function->knots().back().value, 10000);
}

TEST(Pipeline, StretchesAColormapOverDataInMemory) {
    const nlohmann::json document = with_open_map();
    // The scene names a volume with values from 0 to 255.
    const Scene scene = read_scene(document, "s");
    const MeshData mesh = test::kuhn_box({2, 2, 2}, [](const glm::dvec3& p) { return 7 * p.x; });
    Scene projected = scene;
    projected.method = Method::project;
    Pipeline of_mesh(projected, SceneData(projected, mesh));
    // 7 x, where x goes to 2.
    EXPECT_EQ(of_mesh.scene().transfer_function->knots().back().value, 14);
    Grid grid;
    grid.size = {2, 2, 2};
    grid.centering.fill(Centering::cell);
    const auto samples =
        std::make_shared<const std::array<float, 8>>(std::array<float, 8>{0, 1, 2, 9, 1, 1, 1, 1});
    const Volume volume(grid, SampleType::float32, {samples, samples->data()});
    Pipeline of_volume(scene, SceneData(volume));
    EXPECT_EQ(of_volume.scene().transfer_function->knots().back().value, 9);
}

TEST(Pipeline, ChoosesAFunctionInPlaceOfAFileThatGivesOne) {
    Scene scene = read_scene(minimal_scene(), "s");
    const TransferFunction given = *scene.transfer_function;
    scene.transfer_function = automatic;
    EXPECT_NE(Pipeline(scene).scene().transfer_function, given);
    // A transfer function that replaces an open colour map in the scene is kept.
    Scene open = read_scene(with_open_map(), "s");
    open.transfer_function = given;
    EXPECT_EQ(Pipeline(open).scene().transfer_function, given);
}

TEST(Pipeline, SaysThatOpacityOneWasReplaced) {
    test::HeardWarnings heard;
    Pipeline pipeline(read_scene(with("/transfer_function/points/1/opacity", 1), "s"));
    pipeline.scene();
    ASSERT_EQ(heard.texts.size(), 1u);
    EXPECT_NE(heard.texts[0].find("optical depth of 17 per unit_length"), std::string::npos);
}

// Data without a finite number are refused by both tracers.
TEST(Pipeline, RefusesToTraceAVolumeWithoutANumber) {
    Scene scene = read_scene(minimal_scene(), "s");
    scene.method = Method::trace;
    scene.nan = NanPolicy::transparent;
    const Volume volume = test::volume_of(test::grid_of({3, 3, 3}, Centering::node),
                                          [](double, double, double) { return NAN; });
    for (const bool plainly : {false, true}) {
        Pipeline pipeline(scene, SceneData(volume), {.trace_plainly = plainly});
        expect_error([&] { pipeline.trace(); }, {"all 27 samples are NaN or infinite"});
    }
}

// Both tracers follow both policies for NaN: an error, or transparent cells.
TEST(Pipeline, ThePlainTracerMatchesTheTracer) {
    Scene scene = read_scene(minimal_scene(), "s");
    scene.method = Method::trace;
    const Volume volume = test::volume_of(
        test::grid_of({5, 5, 5}, Centering::node),
        [](double i, double j, double k) { return i + j + k == 6 ? NAN : 30 * i + 20 * j; });
    Pipeline traced(scene, SceneData(volume));
    Pipeline plain(scene, SceneData(volume), {.trace_plainly = true});
    for (Pipeline* const pipeline : {&traced, &plain})
        expect_error([&] { pipeline->trace(); }, {"NaN", "transparent"});
    scene.nan = NanPolicy::transparent;
    traced.set_scene(scene);
    plain.set_scene(scene);
    const PreciseImage &a = traced.trace().image, &b = plain.trace().image;
    EXPECT_LE(image_error(to_float(a), to_float(b)).all.linf, 255 * 1e-5);
    EXPECT_NE(a.rgba, b.rgba);
    EXPECT_EQ(plain.statistics().drawn_by, "plain tracer");
}

// A picture has one colour space whichever way it is drawn or read, also after the scene changed.
TEST(Pipeline, LabelsEveryPictureWithTheSpaceOfItsNumbers) {
    Pipeline pipeline(read_scene(minimal_scene(), "s"), {}, {.context = ContextChoice::cpu});
    for (const auto* const word : {"display", "linear", "display"}) {
        Scene scene = read_scene(with("/image/color_space", word), "s");
        Image drawn, read;
        pipeline.set_scene(scene);
        pipeline.draw(drawn);
        EXPECT_EQ(drawn.space, scene.color_space);
        pipeline.draw_frame();
        pipeline.read(read);
        EXPECT_EQ(read.space, scene.color_space);
        EXPECT_EQ(pipeline.trace().image.space, scene.color_space);
        scene.method = Method::trace;
        pipeline.set_scene(scene);
        pipeline.draw(drawn);
        EXPECT_EQ(drawn.space, scene.color_space);
    }
}

}  // namespace
}  // namespace lamina
