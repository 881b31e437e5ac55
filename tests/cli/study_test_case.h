// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/blobs_scene.h"
#include "cli/csv_rows.h"
#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {

// Two small scenes in a folder, ramp.json (a grey volume one voxel deep) and blobs.json (a coloured
// volume of 16^3 samples and its mesh), and a study of them with the cpu engine.
class StudyTestCase : public testing::Test {
  protected:
    using json = nlohmann::json;

    void SetUp() override {
        ramp = json::parse(R"({
            "version": 1,
            "volume": {"generate": "ramp"},
            "transfer_function": {"interpolation": "extinction", "points": [
                {"value": 0, "color": [1, 1, 1], "opacity": 0},
                {"value": 255, "color": [1, 1, 1], "opacity": 0.996}]},
            "camera": {"projection": "orthographic", "eye": [127.5, 1.5, 10],
                       "center": [127.5, 1.5, 0], "up": [0, 1, 0], "height": 4},
            "image": {"width": 16, "height": 8},
            "render": {"slice": {"samples": 64}}})");
        blobs = blobs_scene(12, 10, 24);
        if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty()) blobs["mesh"] = {{"kuhn", true}};
        study = json::parse(R"({
            "version": 1,
            "title": "tiny",
            "scenes": ["ramp.json", "blobs.json"],
            "base": {"context": "cpu", "render.trace.tolerance": 1e-6},
            "sweep": {"render.method": ["slice", "project"],
                      "render.target": ["float32", "fixed8"]},
            "drop": [{"where": {"scene": "ramp", "render.method": "project"},
                      "because": "the ramp has no tets"}],
            "rounds": 2,
            "frames": 3})");
    }

    void write_files() {
        write_bytes_to(folder / "ramp.json", ramp.dump());
        write_bytes_to(folder / "blobs.json", blobs.dump());
        write_bytes_to(folder / "study.json", study.dump());
    }
    // Writes the files, and returns the arguments that run the study.
    std::vector<std::string> command(const std::string& output,
                                     const std::vector<std::string>& options = {}) {
        write_files();
        std::vector<std::string> arguments{LAMINA_BINARY, "study", folder / "study.json", "-o",
                                           folder / output};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return arguments;
    }
    ProgramResult run(const std::string& output, const std::vector<std::string>& options = {}) {
        return run_program(command(output, options));
    }
    ProgramResult run_well(const std::string& output,
                           const std::vector<std::string>& options = {}) {
        ProgramResult result = run(output, options);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }

    std::vector<CsvRow> results(const std::string& output) const {
        return csv_rows(read_bytes_of(folder / output / "results.csv"));
    }
    json document(const std::string& output, const std::string& file) const {
        return json::parse(read_bytes_of(folder / output / file));
    }
    // Returns the complete records of all journals.
    std::vector<json> records(const std::string& output) const {
        std::vector<json> found;
        for (const auto& entry : std::filesystem::directory_iterator(folder / output)) {
            if (entry.path().extension() != ".jsonl") continue;
            const std::string text = read_bytes_of(entry.path());
            for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos;
                 at = end + 1)
                found.push_back(json::parse(text.substr(at, end - at)));
        }
        return found;
    }
    // Returns all files in the folder and its subfolders, with their bytes.
    static std::map<std::string, std::string> contents(const std::filesystem::path& path) {
        std::map<std::string, std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
            if (entry.is_regular_file()) files[entry.path().string()] = read_bytes_of(entry.path());
        }
        return files;
    }

    // Expects that every run of runs.json is in the results exactly once, with rounds * frames
    // times of each kind.
    void expect_every_run_once(const std::string& output) {
        std::map<std::string, int> wanted, rows, reported;
        const json list = document(output, "runs.json"), report = document(output, "results.json");
        for (const json& each : list["runs"]) wanted[each["id"]] = 1;
        for (const CsvRow& row : results(output)) {
            ++rows[row.at("run")];
            EXPECT_EQ(row.at("failed"), "");
        }
        EXPECT_EQ(rows, wanted);
        const int times = study["rounds"].get<int>() * study["frames"].get<int>();
        for (const json& comparison : report["comparisons"]) {
            for (const json& each : comparison["runs"]) {
                EXPECT_EQ(each["frame_ms"]["n"], times);
                EXPECT_EQ(each["still_ms"]["n"], times);
                ++reported[each["id"]];
            }
        }
        EXPECT_EQ(reported, wanted);
    }

    TemporaryFolder folder;
    json ramp, blobs, study;
};

}  // namespace lamina
