// SPDX-License-Identifier: Apache-2.0
// Tests that docs/scene.schema.json is the schema of the tables by which scene files are read.
#include "base/input_file.h"
#include "scene_files/scene_keys.h"
#include "support/scene_fixture.h"

namespace lamina {
namespace {

TEST(Schema, MatchesTheKeyTables) {
    EXPECT_EQ(read_file_bytes(LAMINA_SOURCE_DIR "/docs/scene.schema.json"), scene_schema_text())
        << "run tools/generated";
}

TEST(Schema, EverySceneThatShipsIsRead) {
    setenv("LAMINA_DATA", "data", 1);
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(LAMINA_SOURCE_DIR "/data/scenes")) {
        EXPECT_NO_THROW(read_scene(load_json(entry.path()), entry.path())) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 8);
}

}  // namespace
}  // namespace lamina
