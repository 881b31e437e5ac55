// SPDX-License-Identifier: Apache-2.0
// docs/stats.md documents every key that --stats writes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path source = LAMINA_SOURCE_DIR;

// Returns the words between backticks on the page.
std::set<std::string> documented() {
    const std::string page = read_bytes_of(source / "docs" / "stats.md");
    const std::regex code("`([^`]+)`");
    std::set<std::string> words;
    for (std::sregex_iterator m(page.begin(), page.end(), code), end; m != end; ++m)
        words.insert((*m)[1].str());
    return words;
}

void add_keys(const json& value, std::set<std::string>& keys) {
    if (value.is_object()) {
        for (const auto& [key, part] : value.items()) {
            keys.insert(key);
            add_keys(part, keys);
        }
    } else if (value.is_array()) {
        for (const json& part : value) add_keys(part, keys);
    }
}

class Stats : public testing::Test {
  protected:
    // Adds the keys of the statistics of the scene, rendered with these settings.
    void add_render(const std::vector<std::string>& settings,
                    const std::vector<std::string>& options = {}) {
        write_bytes_to(folder / "scene.json", scene.dump());
        std::vector<std::string> arguments{
            "render",  folder / "scene.json", "-o",          folder / "a_%d.png",
            "--stats", folder / "s.json",     "--turntable", "1",
            "--force"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        for (const std::string& setting : settings) {
            arguments.emplace_back("--set");
            arguments.push_back(setting);
        }
        const ProgramResult result = lamina_run(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        add_keys(json::parse(read_bytes_of(folder / "s.json")), keys);
    }

    TemporaryFolder folder;
    json scene = gaussians_scene(16, 16, 12, 20);
    std::set<std::string> keys;
};

TEST_F(Stats, EveryKeyThatIsWrittenIsDocumented) {
    add_render({"render.slice.samples=auto", "render.slice.classification=post"});
    add_render({"render.slice.classification=preintegrated"}, {"--context", "cpu"});
    add_render({"render.target=fixed8", "render.slice.tree=auto"}, {"--context", "cpu"});
    add_render({"render.target=emulated", "render.emulate.bits=10", "render.slice.dither.period=4"},
               {"--context", "cpu"});
    add_render({}, {"--context", "osmesa"});
    add_render({}, {"--method", "trace"});
    const json plain = scene;
    scene.erase("render");
    scene["transfer_function"]["points"] = json::parse(R"([
        {"value": 0, "color": [1, 1, 1], "extinction": 0},
        {"value": 100, "color": [1, 1, 1], "extinction": 0},
        {"value": 100.2, "color": [1, 1, 1], "extinction": 3e4},
        {"value": 255, "color": [1, 1, 1], "extinction": 3e4}])");
    add_render({"render.slice.classification=exact"}, {"--context", "cpu"});
    EXPECT_TRUE(keys.contains("along_ramps"));  // a ramp of 3300 roundings of 255 / 2^22
    scene = plain;
    scene["mesh"] = {{"kuhn", true}};
    for (const char* coloring : {"preintegrated", "attenuation", "vertex", "analytic"})
        add_render({std::string("render.project.coloring=") + coloring}, {"--method", "project"});
    add_render({"render.project.table={\"scalar\": 16, \"length\": 4}"}, {"--method", "project"});
    add_render({}, {"--method", "project", "--context", "osmesa"});
    add_render({"render.trace.of=mesh"}, {"--method", "trace"});
    // These keys must be among them, or the scenes above do not test what they should.
    for (const char* key :
         {"kind", "rays", "tree", "emulate", "dither", "table", "upload", "order", "error_estimate",
          "mesh_error", "boundary_tree", "cycles", "kept_views"})
        EXPECT_TRUE(keys.contains(key)) << key;
    const std::set<std::string> known = documented();
    for (const std::string& key : keys) EXPECT_TRUE(known.contains(key)) << key;
}

// Finds keys by their pattern in the source files, for those that no scene above has.
TEST(StatsPage, HasTheKeysOfTheSources) {
    const std::set<std::string> known = documented();
    const std::regex key(
        R"re((?:stages_ms_?|counts|json|json\["\w+"\])\["(\w+)"\] [+]?=|\{"(\w+)", )re");
    std::set<std::string> found;
    for (const char* const file :
         {"src/render/scene_data.cpp", "src/render/scene_renderer.cpp", "src/render/pipeline.cpp",
          "tools/lamina/render_stats.cpp", "tools/lamina/render_output.cpp",
          "tools/lamina/picture_series.cpp"}) {
        const std::string text = read_bytes_of(source / file);
        for (std::sregex_iterator m(text.begin(), text.end(), key), end; m != end; ++m)
            found.insert((*m)[1].matched ? (*m)[1].str() : (*m)[2].str());
    }
    found.erase("facts");  // the file has it as a part of "measure"
    EXPECT_GT(found.size(), 60u);
    for (const std::string& each : found) EXPECT_TRUE(known.contains(each)) << each;
}

}  // namespace
}  // namespace lamina
