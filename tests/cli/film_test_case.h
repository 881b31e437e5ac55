// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/png.h"
#include "support/temporary_folder.h"

namespace lamina {

// Films of a scene of coloured blobs, 48 x 36 pixels. Tests that need ffmpeg are skipped without
// it.
class FilmTest : public ::testing::Test {
  protected:
    void SetUp() override { write_scene(gaussians_scene(16, 48, 36, 40)); }

    static bool has_ffmpeg() { return run_program({"ffmpeg", "-version"}).exit_code == 0; }

    void write_scene(const nlohmann::json& scene) {
        write_bytes_to(folder / "scene.json", scene.dump());
    }

    ProgramResult render(const std::string& output, const std::vector<std::string>& more,
                         const std::function<void()>& prepare = {}) {
        std::vector<std::string> arguments{"render", folder / "scene.json", "-o", folder / output};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lamina_run(arguments, prepare);
    }
    std::string render_well(const std::string& output, const std::vector<std::string>& more) {
        const ProgramResult result = render(output, more);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / (output + ".frames")));
        return result.err;
    }
    // Expects a refusal of one line that has all parts in it; no film is written.
    void expect_refusal(int exit_code, const std::string& output,
                        const std::vector<std::string>& more, const std::vector<std::string>& parts,
                        const std::function<void()>& prepare = {}) {
        const ProgramResult result = render(output, more, prepare);
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << part << " in " << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / output));
    }

    // Returns the codes of the frames that ffmpeg decodes to these pixels ("rgb24"), one after the
    // other. `decoder`: empty for ffmpeg's own.
    std::string decoded(const std::string& film, const std::string& pixels,
                        const std::string& decoder = "") const {
        std::vector<std::string> arguments{"ffmpeg", "-v", "error"};
        if (!decoder.empty()) arguments.insert(arguments.end(), {"-c:v", decoder});
        const std::vector<std::string> rest{"-i",          folder / film, "-fps_mode",
                                            "passthrough", "-f",          "rawvideo",
                                            "-pix_fmt",    pixels,        "pipe:1"};
        arguments.insert(arguments.end(), rest.begin(), rest.end());
        const ProgramResult result = run_program(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    }
    // Returns the codes of PNG files, one after the other.
    std::string codes_of(const std::vector<std::string>& names) const {
        std::string codes;
        for (const std::string& name : names) {
            for (const std::uint16_t code : read_png(folder / name).codes)
                codes += static_cast<char>(code);
        }
        return codes;
    }

    TemporaryFolder folder;
};

}  // namespace lamina
