// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {

// Base of tests of programs that fail through no fault of their own. It makes a folder with a
// scene, its volume, a list of segments and a study; outputs go into its subfolder "out".
class FaultsTestCase : public testing::Test {
  protected:
    void SetUp() override {
        const std::string scene = R"({
            "version": 1,
            "volume": "volume.nrrd",
            "mesh": {"kuhn": true},
            "transfer_function": {"points": [
                {"value": 0, "color": [0, 0, 1], "extinction": 0},
                {"value": 255, "color": [1, 0.5, 0], "extinction": 8}]},
            "camera": {"eye": [1.7, -0.9, 1.3], "center": [0.5, 0.5, 0.5], "up": [0, 0, 1]},
            "image": {"width": 100, "height": 80},
            "render": {"slice": {"samples": 60}}})";
        write_bytes_to(folder / "scene.json", scene);
        write_bytes_to(folder / "study.json", R"({
            "version": 1, "title": "small", "scenes": ["scene.json"], "rounds": 1, "frames": 1,
            "base": {"context": "cpu"},
            "sweep": {"render.target": ["float32", "fixed8"]}})");
        const std::string segment = R"({"transfer_function": {"points": [
            {"value": 0, "color": [0, 0, 1], "extinction": 0},
            {"value": 1, "color": [1, 0.5, 0], "extinction": 8}]}, "sf": 0.1, "sb": 0.7, "length": 1})";
        std::string segments = "[" + segment;
        for (int i = 1; i < 20; ++i) segments += "," + segment;
        write_bytes_to(folder / "segments.json", segments + "]");
        make({"generate", "gaussians", "-o", folder / "volume.nrrd", "--size", "16,16,16"});
        std::filesystem::create_directory(out);
    }

    static ProgramResult make(const std::vector<std::string>& arguments) {
        ProgramResult result = lamina_run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    // Returns the arguments that render the scene with the cpu engine, without messages.
    std::vector<std::string> rendering(const std::filesystem::path& picture,
                                       const std::vector<std::string>& options = {}) const {
        std::vector<std::string> arguments{
            "render", folder / "scene.json", "-o", picture, "--context", "cpu", "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    }

    // Expects a failure with one line on stderr that contains all of `parts`.
    static void expect_one_line(const ProgramResult& result, int exit_code,
                                const std::vector<std::string>& parts) {
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("lamina: ")) << result.err;
        for (const std::string& part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    }

    // Returns all files in the folder and its subfolders, with their bytes.
    static std::map<std::string, std::string> contents(const std::filesystem::path& path) {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
            if (entry.is_regular_file()) files[entry.path().string()] = read_bytes_of(entry.path());
        }
        return files;
    }

    TemporaryFolder folder;
    const std::filesystem::path out = folder / "out";
};

}  // namespace lamina
