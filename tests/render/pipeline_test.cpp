// SPDX-License-Identifier: Apache-2.0
// Choices that a pipeline makes between a scene and its renderer.
#include "render/pipeline.h"

#include <fstream>

#include "scene/given_transfer.h"
#include "support/heard_warnings.h"
#include "support/scene_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

nlohmann::json with_open_map() {
    return with("/transfer_function",
                {{"colormap", "greys"}, {"points", {{{"value", 0}, {"extinction", 1}}}}});
}

// The files of one process are not mixed up: each channel has its own range.
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
        const TransferFunction& function = pipeline.scene().transfer_function;
        EXPECT_EQ(function.at(highest).color, glm::dvec3(1)) << channel;
        EXPECT_NEAR(function.at(highest / 2).color.g, .5, 1e-15) << channel;  // a few roundings
        EXPECT_TRUE(has_open_colormap(pipeline.asked()));
    }
}

TEST(Pipeline, StretchesAnotherColormapOverTheDataItHas) {
    Pipeline pipeline(read_scene(minimal_scene(), "s"));
    pipeline.set_transfer_function_of(read_scene(with_open_map(), "s"));
    Pipeline fresh(read_scene(with_open_map(), "s"));
    EXPECT_EQ(pipeline.scene().transfer_function, fresh.scene().transfer_function);
    EXPECT_TRUE(has_open_colormap(pipeline.asked()));
    nlohmann::json automatic = minimal_scene();
    automatic.erase("transfer_function");
    pipeline.set_transfer_function_of(read_scene(automatic, "s"));
    Pipeline chosen(read_scene(automatic, "s"));
    EXPECT_EQ(pipeline.scene().transfer_function, chosen.scene().transfer_function);
}

// Pictures of a volume and of its mesh have the same colours.
TEST(Pipeline, StretchesAColormapOverTheVolumeForItsMeshToo) {
    nlohmann::json document = with_open_map();
    document["mesh"] = {{"kuhn", true}};
    Pipeline slices(read_scene(document, "s"));
    document["render"]["method"] = "project";
    Pipeline tets(read_scene(document, "s"));
    EXPECT_EQ(slices.scene().transfer_function, tets.scene().transfer_function);
}

TEST(Pipeline, SaysThatOpacityOneWasReplaced) {
    test::HeardWarnings heard;
    Pipeline pipeline(read_scene(with("/transfer_function/points/1/opacity", 1), "s"));
    pipeline.scene();
    ASSERT_EQ(heard.texts.size(), 1u);
    EXPECT_NE(heard.texts[0].find("optical depth of 17 per unit_length"), std::string::npos);
}

}  // namespace
}  // namespace lamina
