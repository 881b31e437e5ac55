// SPDX-License-Identifier: Apache-2.0
// lamina study in parts: stopped and resumed, interrupted, and in shards.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>
#include <tuple>
#include <utility>

#include "cli/study_test_case.h"

namespace lamina {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class StudyStopped : public StudyTestCase {
  protected:
    // Makes the study six runs in three rounds, 24 records of about 10 ms each, so that it can be
    // stopped before its end.
    void be_slow() {
        study["scenes"] = {"blobs.json"};
        study["drop"] = json::array();
        study["base"]["render.method"] = "project";
        study["sweep"] = {{"render.max_error", {1, 2, 3}},
                          {"render.target", {"float32", "float16"}}};
        study["rounds"] = 3;
        study["frames"] = 15;
    }
    // Counts the records of runs, without those of how a process began.
    std::size_t count_records(const std::string& output) const {
        const std::vector<json> all = records(output);
        return static_cast<std::size_t>(std::count_if(
            all.begin(), all.end(), [](const json& each) { return each.contains("run"); }));
    }
    void wait_for_records(const std::string& output, std::size_t count,
                          const StartedProgram& program) const {
        while (!program.has_ended() &&
               (!std::filesystem::exists(folder / output) || count_records(output) < count))
            std::this_thread::sleep_for(1ms);
    }
    // Expects every record once, except for the baseline, which every session times.
    void expect_every_record_once(const std::string& output) const {
        const json list = document(output, "runs.json");
        std::set<std::string> baselines;
        for (const json& number : list["baselines"])
            baselines.insert(list["runs"][number.get<std::size_t>()]["id"]);
        std::multiset<std::pair<std::string, int>> seen;  // run and round; round -1 is its picture
        // Run, session and round of the timings of baselines.
        std::set<std::tuple<std::string, int, int>> sessions;
        for (const json& record : records(output)) {
            if (!record.contains("run")) continue;
            EXPECT_FALSE(record.contains("failed")) << record;
            const std::string run = record["run"];
            const int round = record.value("round", -1);
            if (baselines.contains(run) && round >= 0) {
                const int session = record["session"];
                EXPECT_TRUE(sessions.emplace(run, session, round).second) << record;
                if (seen.count({run, round}) > 0) continue;
            }
            seen.emplace(run, round);
        }
        const int rounds = study["rounds"];
        for (const json& each : list["runs"]) {
            for (int round = -1; round < rounds; ++round)
                EXPECT_EQ(seen.count({each["id"], round}), 1u) << each["name"] << round;
        }
    }
    // Returns the rows of results.csv, in order, without times and what follows from them.
    std::vector<CsvRow> rows_without_times(const std::string& output) const {
        std::vector<CsvRow> rows = results(output);
        for (CsvRow& row : rows) {
            std::erase_if(row, [](const auto& cell) {
                return cell.first.find("_ms_") != std::string::npos || cell.first == "first_ms" ||
                       cell.first == "ratio" || cell.first == "pareto";
            });
        }
        return rows;
    }
};

TEST_F(StudyStopped, ResumingAfterKillsMakesEveryRunOnce) {
    be_slow();
    const std::pair<std::size_t, std::chrono::milliseconds> moments[] = {
        {0, 0ms}, {1, 3ms}, {5, 7ms}, {9, 1ms}, {14, 5ms}};
    std::size_t kept = 0;
    for (const auto& [count, delay] : moments) {
        StartedProgram program(command("out", {"--resume"}));
        wait_for_records("out", count, program);
        std::this_thread::sleep_for(delay);
        program.send(SIGKILL);
        ASSERT_EQ(program.wait().exit_code, -SIGKILL) << "ended before it was killed";
        EXPECT_GE(count_records("out"), std::max(kept, count));
        kept = count_records("out");
        EXPECT_LT(kept, 24u);
    }
    const ProgramResult rest = run_well("out", {"--resume"});
    EXPECT_NE(rest.err.find("6 of 6 runs"), std::string::npos) << rest.err;
    expect_every_run_once("out");
    expect_every_record_once("out");
    // The runs are those of a study that was not stopped, except for times.
    run_well("whole");
    EXPECT_EQ(rows_without_times("out"), rows_without_times("whole"));
}

// After a power failure the last record may be incomplete: it is measured again.
TEST_F(StudyStopped, ATornRecordIsMeasuredAgain) {
    run_well("out");
    const auto journal = folder / "out" / "journal-1-of-1.jsonl";
    std::string text = read_bytes_of(journal);
    text.erase(text.size() - 20);
    write_bytes_to(journal, text);
    run_well("out", {"--resume"});
    expect_every_run_once("out");
    expect_every_record_once("out");
}

TEST_F(StudyStopped, AFinishedStudyIsNotMeasuredAgain) {
    run_well("out");
    const std::vector<CsvRow> before = results("out");
    const ProgramResult again = run_well("out", {"--resume"});
    EXPECT_NE(again.err.find("6 runs, 6 of them finished before"), std::string::npos) << again.err;
    EXPECT_EQ(results("out"), before);  // including times
}

// Earlier versions did not time first pictures.
TEST_F(StudyStopped, JournalsWithoutTimesOfFirstPicturesAreRead) {
    run_well("out");
    const std::vector<CsvRow> before = results("out");
    std::string text;
    for (json record : records("out")) {
        if (record.contains("drawn")) {
            EXPECT_EQ(record["drawn"].erase("first_ms"), 1u);
        }
        text += record.dump() + "\n";
    }
    write_bytes_to(folder / "out" / "journal-1-of-1.jsonl", text);
    run_well("out", {"--resume"});
    std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), before.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i].at("first_ms"), "");
        rows[i]["first_ms"] = before[i].at("first_ms");
    }
    EXPECT_EQ(rows, before);
    const json report = document("out", "results.json");
    for (const json& comparison : report["comparisons"]) {
        for (const json& each : comparison["runs"]) EXPECT_TRUE(each["first_ms"].is_null());
    }
}

TEST_F(StudyStopped, ABegunFolderIsLeftAloneWithoutResume) {
    run_well("out");
    const auto before = contents(folder / "out");
    const ProgramResult again = run("out");
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_NE(again.err.find("--resume"), std::string::npos) << again.err;
    study["rounds"] = 5;
    for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--resume"}}) {
        const ProgramResult other = run("out", options);
        EXPECT_EQ(other.exit_code, 1);
        EXPECT_NE(other.err.find("another study"), std::string::npos) << other.err;
    }
    EXPECT_EQ(contents(folder / "out"), before);
}

TEST_F(StudyStopped, AStudyThatIsRunningIsLeftToItsProcess) {
    be_slow();
    StartedProgram program(command("out"));
    wait_for_records("out", 1, program);
    const ProgramResult second = run("out", {"--resume"});
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_NE(second.err.find("another lamina study is writing it"), std::string::npos)
        << second.err;
    EXPECT_EQ(program.wait().exit_code, 0);
    expect_every_run_once("out");
    expect_every_record_once("out");
}

TEST_F(StudyStopped, ARunThatFailedIsTriedAgain) {
    const std::string file = folder / "made.nrrd";
    ASSERT_EQ(lamina_run({"generate", "gaussians", "-o", file, "--size", "16,16,16"}).exit_code, 0);
    blobs["volume"] = "made.nrrd";
    const std::string volume = read_bytes_of(file);
    write_bytes_to(file, "NRRD0004\nnothing\n");
    run_well("out");
    std::vector<CsvRow> rows = results("out");
    ASSERT_EQ(rows.size(), 6u);
    EXPECT_EQ(rows[0].at("failed"), "");
    EXPECT_NE(rows[5].at("failed").find("made.nrrd"), std::string::npos);
    write_bytes_to(file, volume);
    run_well("out", {"--resume"});
    expect_every_run_once("out");
}

TEST_F(StudyStopped, SaysWhatIsKeptIfInterrupted) {
    be_slow();
    study["rounds"] = 1;
    study["frames"] = 40;
    StartedProgram program(command("out"));
    wait_for_records("out", 4, program);  // records of two runs
    program.send(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 130);
    const std::size_t kept = count_records("out") / 2;
    const std::string said =
        std::to_string(kept) + " of 6 runs are finished and kept; --resume goes on";
    EXPECT_NE(result.err.find(said), std::string::npos) << said << ": " << result.err;
    EXPECT_GE(kept, 2u);
    EXPECT_LT(kept, 6u);
    const ProgramResult rest = run_well("out", {"--resume"});
    EXPECT_NE(rest.err.find(std::to_string(kept) + " of them finished before"), std::string::npos)
        << rest.err;
    expect_every_run_once("out");
    expect_every_record_once("out");
}

TEST_F(StudyStopped, MergedShardsAreTheWholeStudy) {
    run_well("whole");
    run_well("a", {"--shard", "1/2"});
    run_well("b", {"--shard", "2/2"});
    // Each shard has three of the six runs, and also times the baselines that it lacks.
    EXPECT_EQ(results("a").size() + results("b").size(), 6u + 2);
    const ProgramResult merged =
        lamina_run({"study", "--merge", folder / "a", folder / "b", "-o", folder / "merged"});
    ASSERT_EQ(merged.exit_code, 0) << merged.err;
    expect_every_run_once("merged");
    EXPECT_EQ(rows_without_times("merged"), rows_without_times("whole"));
    for (const CsvRow& row : results("merged")) EXPECT_GT(std::stod(row.at("ratio")), 0);
    const auto pictures = [&](const char* name) {
        std::map<std::string, std::string> bytes;
        for (const CsvRow& row : results("whole")) {
            const std::string file = row.at("run") + ".exr";
            bytes[file] = read_bytes_of(folder / name / "pictures" / file);
        }
        return bytes;
    };
    EXPECT_EQ(pictures("merged"), pictures("whole"));
    // Folders that share shards can be merged, also into a folder that exists.
    const auto before = results("merged");
    ASSERT_EQ(lamina_run({"study", "--merge", folder / "b", folder / "a", "-o", folder / "merged"})
                  .exit_code,
              0);
    EXPECT_EQ(results("merged"), before);
}

TEST_F(StudyStopped, OneShardAloneSaysThatRunsAreMissing) {
    run_well("a", {"--shard", "1/2"});
    const ProgramResult merged =
        lamina_run({"study", "--merge", folder / "a", "-o", folder / "merged"});
    EXPECT_EQ(merged.exit_code, 0);
    const std::size_t there = results("merged").size();
    EXPECT_LT(there, 6u);
    EXPECT_NE(merged.out.find(std::to_string(there) + " of 6 runs are finished"), std::string::npos)
        << merged.out;
}

TEST_F(StudyStopped, ShardsMayShareAFolder) {
    // command() writes the files of the scenes and the study.
    const auto one_of_two = command("out", {"--shard", "1/2"});
    const auto two_of_two = command("out", {"--shard", "2/2"});
    StartedProgram first(one_of_two), second(two_of_two);
    const ProgramResult one = first.wait(), two = second.wait();
    EXPECT_EQ(one.exit_code, 0) << one.err;
    EXPECT_EQ(two.exit_code, 0) << two.err;
    expect_every_run_once("out");  // the last one to end wrote the results of both
    run_well("whole");
    EXPECT_EQ(rows_without_times("out"), rows_without_times("whole"));
    const ProgramResult again = run("out", {"--shard", "2/2"});
    EXPECT_EQ(again.exit_code, 1);
    EXPECT_NE(again.err.find("--resume"), std::string::npos);
}

TEST_F(StudyStopped, OnlyShardsOfOneStudyMerge) {
    run_well("a", {"--shard", "1/2"});
    run_well("same", {"--shard", "1/2"});
    study["rounds"] = 1;
    run_well("other", {"--shard", "2/2"});
    const auto expect_refused = [&](const std::string& a, const std::string& b,
                                    const std::string& part) {
        const ProgramResult result =
            lamina_run({"study", "--merge", folder / a, folder / b, "-o", folder / "merged"});
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
    };
    expect_refused("a", "other", "another study");
    expect_refused("a", "same", "the same shard");
    expect_refused("a", "absent", "absent");
    const auto before = contents(folder / "other");
    EXPECT_EQ(lamina_run({"study", "--merge", folder / "a", "-o", folder / "other"}).exit_code, 1);
    EXPECT_EQ(contents(folder / "other"), before);
}

}  // namespace
}  // namespace lamina
