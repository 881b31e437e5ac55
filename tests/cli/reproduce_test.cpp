// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

ProgramResult reproduce(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {LAMINA_BINARY, "reproduce"});
    return run_program(arguments);
}

TEST(Reproduce, WritesOneItem) {
    const TemporaryFolder folder;
    const std::string output = folder / "new/place";
    const ProgramResult result = reproduce({"lamar", "table3", "-o", output});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.out.find("table3"), 0u);
    const json report = json::parse(read_bytes_of(folder / "new/place/lamar.json"));
    EXPECT_EQ(report.size(), 1u);
    EXPECT_EQ(report["table3"]["agrees"], false);
    EXPECT_TRUE(std::filesystem::exists(folder / "new/place/table3.csv"));
    const std::string page = read_bytes_of(folder / "new/place/lamar.html");
    EXPECT_NE(page.find("<p id=\"summary\">Of 1 item of the paper, 1 disagrees. Of 2 statements, "
                        "1 agrees, 1 disagrees.</p>"),
              std::string::npos);
    EXPECT_NE(page.find("<li><a href=\"#table3\">table3</a>: Disagrees:"), std::string::npos);
}

// Sections 4.2 and 5 of LaMar 2004.
TEST(Reproduce, JudgesOrderAndDithering) {
    const TemporaryFolder folder;
    ASSERT_EQ(reproduce({"lamar", "order", "-o", folder / "order"}).exit_code, 0);
    const json order = json::parse(read_bytes_of(folder / "order/lamar.json"))["order"];
    EXPECT_EQ(order["agrees"], false);
    for (const json& row : order["values"]["equal_fragments"]) {
        // White fragments of equal codes: both orders of compositing give the same whole number.
        if (row["color"] == 1.0) {
            EXPECT_EQ(row["different_columns"], 0);
        }
    }
    ASSERT_EQ(reproduce({"lamar", "dithering", "-o", folder / "dithering"}).exit_code, 0);
    const json dithering = json::parse(read_bytes_of(folder / "dithering/lamar.json"))["dithering"];
    EXPECT_EQ(dithering["agrees"], true) << dithering["note"];
    for (const json& row : dithering["values"]["periods"]) {
        // If a period fits into the ray, dithering shows opacities from 1 / (255 P) in a sample.
        if (row["color"] == 1.0 && row["period"] <= row["samples"]) {
            EXPECT_EQ(row["first_column_shown"], row["first_column_predicted"]);
        }
    }
}

TEST(Reproduce, ExitsWith2ForUnknownNames) {
    const TemporaryFolder folder;
    const ProgramResult item = reproduce({"lamar", "figure99", "-o", folder / "x"});
    EXPECT_EQ(item.exit_code, 2);
    // The message lists the items.
    EXPECT_NE(item.err.find("figure9,"), std::string::npos) << item.err;
    const ProgramResult kraus = reproduce({"kraus", "figure9999", "-o", folder / "x"});
    EXPECT_EQ(kraus.exit_code, 2);
    EXPECT_NE(kraus.err.find("reproduce kraus figure9999: unknown item"), std::string::npos);
    EXPECT_NE(kraus.err.find("preintegration,"), std::string::npos) << kraus.err;
    const ProgramResult paper = reproduce({"newton", "-o", folder / "x"});
    EXPECT_EQ(paper.exit_code, 2);
    EXPECT_NE(paper.err.find("lamar or kraus"), std::string::npos) << paper.err;
    EXPECT_EQ(reproduce({"lamar"}).exit_code, 2);
    EXPECT_TRUE(folder.empty());
}

TEST(Reproduce, ExitsWith1IfAFileIsInTheWay) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "x", "");
    for (const auto& [paper, item] : {std::pair{"lamar", "table2"}, {"kraus", "figure7"}}) {
        const ProgramResult result = reproduce({paper, item, "-o", folder / "x"});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.err.find("x: "), std::string::npos);
    }
}

void without_data() {
    unsetenv("LAMINA_DATA");
}

// An item without its data set says so on stdout, in the report and on the page.
TEST(Reproduce, ItemsWithoutTheirDataSetAreSkipped) {
    const TemporaryFolder folder;
    const ProgramResult result = run_program(
        {LAMINA_BINARY, "reproduce", "lamar", "figure1", "-o", folder / "x"}, without_data);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string wanted = "skipped: set LAMINA_DATA to a folder that holds bonsai.nrrd";
    EXPECT_NE(result.out.find(wanted), std::string::npos) << result.out;
    const json report = json::parse(read_bytes_of(folder / "x/lamar.json"));
    EXPECT_TRUE(report["figure1"]["agrees"].is_null());
    EXPECT_NE(read_bytes_of(folder / "x/lamar.html").find(wanted), std::string::npos);
}

// Writes stdout to a file, which is buffered like a pipe. The program is stopped early: all items
// take minutes.
TEST(Reproduce, WritesALineAsSoonAsItsItemEnds) {
    const TemporaryFolder folder;
    StartedProgram program({"sh", "-c", "exec \"$0\" reproduce lamar -o \"$1\" > \"$2\"",
                            LAMINA_BINARY, folder / "x", folder / "lines"});
    const auto said = [&] {
        std::error_code absent;
        return std::filesystem::exists(folder / "lines", absent) &&
               read_bytes_of(folder / "lines").find("table1 ") != std::string::npos;
    };
    while (!said() && !program.has_ended())
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(said());
    EXPECT_FALSE(program.has_ended());
    program.send(SIGINT);
    EXPECT_EQ(program.wait().exit_code, 130);
}

}  // namespace
}  // namespace lamina
