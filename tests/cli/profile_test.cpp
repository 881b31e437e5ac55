// SPDX-License-Identifier: Apache-2.0
// lamina render --profile.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

struct Event {
    std::string name;
    int row;
    double begin, end;  // microseconds
    json counts;
};

// Rounding, in microseconds: times are whole nanoseconds, written as microseconds in double
// precision.
constexpr double rounding = 1e-2;
// Error of OpenGL's clock against the host's, in microseconds. It is read between two reads of the
// host's clock, the closest of five pairs, which are some microseconds apart. A frame takes more
// than twice this.
constexpr double clock_slack = 200;

bool is_opengl(const std::string& row_name) {
    return row_name == "OpenGL";
}

class ProfileOption : public testing::Test {
  protected:
    void SetUp() override {
        scene = gaussians_scene(24, 40, 30, 60);
        scene["mesh"] = {{"kuhn", true}};
        write_bytes_to(folder / "scene.json", scene.dump());
    }

    ProgramResult render(const std::vector<std::string>& options) {
        std::vector<std::string> arguments{"render", folder / "scene.json", "-o", folder / "a.exr"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return lamina_run(arguments);
    }

    // Renders with two more frames, checks what holds for every profile, and keeps the events.
    void profile(const std::string& method, const std::string& context,
                 const std::string& option = "--quiet") {
        const ProgramResult result =
            render({"--method", method, "--context", context, "--frames", "2", "--profile",
                    folder / "p.json", "--stats", folder / "s.json", option});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        const json document = json::parse(read_bytes_of(folder / "p.json"));
        stats = json::parse(read_bytes_of(folder / "s.json"));
        EXPECT_EQ(document["otherData"]["context"], stats["context"]);
        read(document["traceEvents"]);
        check_rows();
        check_frames();
    }

    void read(const json& all) {
        std::string process;
        for (const json& event : all) {
            EXPECT_EQ(event["pid"], 1);
            if (event["ph"] == "M") {
                if (event["name"] == "process_name") process = event["args"]["name"];
                if (event["name"] == "thread_name") rows[event["tid"]] = event["args"]["name"];
                continue;
            }
            EXPECT_EQ(event["ph"], "X");
            EXPECT_GE(event["dur"], 0);
            EXPECT_GE(event["ts"], 0);
            events.push_back({event["name"], event["tid"], event["ts"],
                              event["ts"].get<double>() + event["dur"].get<double>(),
                              event["args"]});
        }
        EXPECT_EQ(process, "lamina render " + (folder / "scene.json").string());
        for (const Event& event : events) EXPECT_TRUE(rows.contains(event.row)) << event.name;
    }

    // Expects that two events of a row are nested or disjoint.
    void check_rows() const {
        for (const Event& a : events) {
            for (const Event& b : events) {
                if (&a == &b || a.row != b.row) continue;
                const bool apart = a.end <= b.begin + rounding || b.end <= a.begin + rounding;
                EXPECT_TRUE(apart || is_in(a, b, rounding) || is_in(b, a, rounding))
                    << a.name << " and " << b.name;
            }
        }
    }

    static bool is_in(const Event& a, const Event& b, double slack) {
        return a.begin >= b.begin - slack && a.end <= b.end + slack;
    }

    std::vector<Event> named(const std::string& name) const {
        std::vector<Event> found;
        std::ranges::copy_if(events, std::back_inserter(found),
                             [&](const Event& event) { return event.name == name; });
        return found;
    }

    // Returns the events directly inside `outer`, on its row.
    std::vector<Event> inside(const Event& outer) const {
        std::vector<Event> found;
        for (const Event& event : events) {
            if (event.row != outer.row || event.name == outer.name || !is_in(event, outer, 0))
                continue;
            const bool deeper = std::ranges::any_of(events, [&](const Event& other) {
                return &other != &event && other.row == outer.row && other.name != outer.name &&
                       is_in(other, outer, 0) && is_in(event, other, 0) &&
                       other.end - other.begin > event.end - event.begin;
            });
            if (!deeper) found.push_back(event);
        }
        return found;
    }

    // Expects three frames, the scene's own and two more, with the durations of the statistics and
    // with their stages inside.
    void check_frames() const {
        const std::vector<Event> frames = named("frame");
        ASSERT_EQ(frames.size(), 3u);
        for (int i = 0; i < 3; ++i) {
            const Event& frame = frames[static_cast<std::size_t>(i)];
            EXPECT_EQ(frame.counts["frame"], i);
            double sum = 0;
            for (const Event& stage : inside(frame)) sum += stage.end - stage.begin;
            EXPECT_GT(sum, 0);
            EXPECT_LE(sum, frame.end - frame.begin + rounding);
        }
        const auto length = [&](int i) {
            return (frames[static_cast<std::size_t>(i)].end -
                    frames[static_cast<std::size_t>(i)].begin) /
                   1e3;
        };
        EXPECT_NEAR(stats["frame_ms"]["min"], std::min(length(1), length(2)), 1e-3 * rounding);
        EXPECT_NEAR(stats["frame_ms"]["max"], std::max(length(1), length(2)), 1e-3 * rounding);
    }

    void expect_stages(const std::vector<std::string>& names) const {
        for (const std::string& name : names) EXPECT_FALSE(named(name).empty()) << name;
    }

    // Expects draws by OpenGL's own clock during each frame.
    void check_opengl() const {
        for (const Event& frame : named("frame")) {
            EXPECT_GT(frame.end - frame.begin, 2 * clock_slack);
            const auto drawn = std::ranges::count_if(events, [&](const Event& event) {
                return is_opengl(rows.at(event.row)) && is_in(event, frame, clock_slack);
            });
            EXPECT_GT(drawn, 0);
        }
    }

    bool has_opengl() const {
        return std::ranges::any_of(rows, [](const auto& row) { return is_opengl(row.second); });
    }

    TemporaryFolder folder;
    json scene, stats;
    std::map<int, std::string> rows;
    std::vector<Event> events;
};

TEST_F(ProfileOption, HasTheStagesOfSlicingByTheCpuEngine) {
    profile("slice", "cpu");
    expect_stages({"scene", "load", "measure", "bricks", "facts", "plan", "context", "set_up",
                   "tables", "upload", "geometry", "draw", "read", "write"});
    EXPECT_FALSE(has_opengl());
    EXPECT_EQ(named("draw").size(), 3u);
    EXPECT_EQ(named("draw")[0].counts["samples"], stats["fragments"]);
}

TEST_F(ProfileOption, ShowsThatThePlanBuildsTables) {
    scene["render"]["slice"]["classification"] = "preintegrated";
    scene["render"]["slice"]["samples"] = 30;
    write_bytes_to(folder / "scene.json", scene.dump());
    profile("slice", "cpu");
    ASSERT_FALSE(named("table").empty());
    for (const Event& table : named("table"))
        EXPECT_TRUE(is_in(table, named("plan").at(0), rounding));
}

TEST_F(ProfileOption, HasTheStagesOfSlicingByOpenGL) {
    profile("slice", "osmesa");
    expect_stages({"compile", "upload", "geometry", "draw"});
    EXPECT_TRUE(has_opengl());
    check_opengl();
}

TEST_F(ProfileOption, HasTheStagesOfProjectionByTheCpuEngine) {
    profile("project", "cpu");
    expect_stages({"load volume", "make mesh", "neighbours", "order graph", "visible parts",
                   "order", "sort", "parts", "draw", "set-up", "tiles"});
    EXPECT_FALSE(has_opengl());
    const std::vector<Event> draws = named("draw");
    ASSERT_EQ(draws.size(), 3u);
    EXPECT_EQ(draws[0].counts["tets"], stats["tets_drawn"]);
    EXPECT_EQ(draws[0].counts["fragments"], stats["fragments"]);
}

TEST_F(ProfileOption, HasTheStagesOfProjectionByOpenGL) {
    profile("project", "osmesa", "--no-omit=blending");
    expect_stages({"compile", "order", "sort", "parts", "geometry", "submit", "finish"});
    EXPECT_TRUE(has_opengl());
    check_opengl();
}

TEST_F(ProfileOption, HasTheStagesOfRaysThatWalk) {
    profile("project", "osmesa");
    expect_stages({"compile", "upload mesh", "geometry", "draw"});
    EXPECT_TRUE(named("order").empty());
    EXPECT_TRUE(has_opengl());
    check_opengl();
}

TEST_F(ProfileOption, HasTheStagesOfTheTracers) {
    profile("trace", "auto");
    expect_stages({"load", "measure", "trace"});
}

TEST_F(ProfileOption, DoesNotChangeThePicture) {
    for (const char* method : {"slice", "project"}) {
        ASSERT_EQ(render({"--method", method, "--context", "osmesa"}).exit_code, 0);
        const std::string expected = read_bytes_of(folder / "a.exr");
        ASSERT_EQ(
            render({"--method", method, "--context", "osmesa", "--profile", folder / "p.json"})
                .exit_code,
            0);
        EXPECT_EQ(read_bytes_of(folder / "a.exr"), expected) << method;
    }
}

TEST_F(ProfileOption, SaysWhereItCannotWrite) {
    const std::string path = folder / "none" / "p.json";
    const ProgramResult result = render({"--profile", path});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find("none"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_F(ProfileOption, NeedsAFileOfItsOwn) {
    EXPECT_EQ(render({"--profile", folder / "a.exr"}).exit_code, 2);
    EXPECT_EQ(render({"--profile", folder / "scene.json"}).exit_code, 2);
    const ProgramResult without =
        lamina_run({"render", folder / "scene.json", "--explain", "--profile", folder / "p.json"});
    EXPECT_EQ(without.exit_code, 2);
    EXPECT_NE(without.err.find("-o"), std::string::npos) << without.err;
}

TEST_F(ProfileOption, WritesNothingForARunThatFails) {
    EXPECT_EQ(
        render({"--set", "render.slice.samples=-1", "--profile", folder / "p.json"}).exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "p.json"));
}

}  // namespace
}  // namespace lamina
