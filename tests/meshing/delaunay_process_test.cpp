// SPDX-License-Identifier: Apache-2.0
#include "meshing/delaunay.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "base/client.h"
#include "base/error.h"
#include "base/process.h"
#include "meshing/tetrahedralize_protocol.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

const std::vector<glm::dvec3> tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// Writes a shell script that takes the place of lamina-tetrahedralize.
std::filesystem::path script(const TemporaryFolder& folder, const std::string& commands) {
    const std::filesystem::path path = folder / "lamina-tetrahedralize";
    write_bytes_to(path, "#!/bin/sh\n" + commands);
    chmod(path.c_str(), 0755);
    return path;
}

TEST(DelaunayProcess, ErrorsSayHowTheProgramFailed) {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& commands) {
        return error_of([&] { delaunay_by_process(script(folder, commands), tetrahedron); });
    };
    const auto has = [](const std::string& message, const std::string& part) {
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    has(run("echo chatter >&2; echo 'tetgen: out of luck' >&2; exit 1"),
        "out of luck (exit code 1)");
    has(run("exit 3"), "exit code 3");
    has(run("kill -SEGV $$"), "ended by signal 11");
    has(run("exit 0"), "gave no answer");
    has(run("printf 12345678"), "promised");  // a count of tets beyond all memory
    has(run("head -c 40 /dev/zero"), "promised 0 tets");
    // The answer: one tet, with corner 4 although there are four points.
    has(run("printf '\\001\\0\\0\\0\\0\\0\\0\\0'; printf '\\004\\0\\0\\0'; head -c 28 /dev/zero"),
        "index 4 is out of range");
    expect_error([&] { delaunay_by_process(folder / "absent", tetrahedron); },
                 {"absent", "cannot be started"});
}

TEST(DelaunayProcess, IsFoundInThePath) {
    const TemporaryFolder folder;
    const std::string path = getenv("PATH");
    setenv("PATH", folder.path().c_str(), 1);
    EXPECT_EQ(find_program(tetrahedralize_program), std::nullopt);
    expect_error([] { require_tetrahedralizer(); },
                 {"lamina-tetrahedralize", "LAMINA_WITH_TETGEN", "--kuhn"});
    write_bytes_to(folder / "lamina-tetrahedralize", "no program");
    EXPECT_EQ(find_program(tetrahedralize_program), std::nullopt);
    script(folder, "exit 0");
    EXPECT_EQ(find_program(tetrahedralize_program), folder / "lamina-tetrahedralize");
    setenv("PATH", path.c_str(), 1);
}

// An empty entry of PATH must not make programs in the current folder run.
TEST(DelaunayProcess, EmptyEntriesOfThePathAreNoFolder) {
    const TemporaryFolder folder;
    script(folder, "exit 0");
    const std::string path = getenv("PATH");
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    for (const char* entries : {":", ":/absent", "/absent::/absent", "/absent:", ""}) {
        setenv("PATH", entries, 1);
        EXPECT_EQ(find_program(tetrahedralize_program), std::nullopt) << entries;
    }
    std::filesystem::current_path(before);
    setenv("PATH", path.c_str(), 1);
}

// Sets TMPDIR while the object exists.
class TemporaryFilesIn {
  public:
    explicit TemporaryFilesIn(const std::filesystem::path& folder) {
        if (const char* before = getenv("TMPDIR")) before_ = before;
        setenv("TMPDIR", folder.c_str(), 1);
    }
    ~TemporaryFilesIn() {
        if (before_.empty())
            unsetenv("TMPDIR");
        else
            setenv("TMPDIR", before_.c_str(), 1);
    }
    TemporaryFilesIn(const TemporaryFilesIn&) = delete;
    TemporaryFilesIn& operator=(const TemporaryFilesIn&) = delete;

  private:
    std::string before_;
};

TEST(DelaunayProcess, TemporaryFilesLieInTmpdir) {
    const TemporaryFolder folder, temporary;
    const auto tool =
        script(folder, "readlink /proc/$$/fd/0 /proc/$$/fd/1 | tr '\\n' ' ' >&2; exit 1");
    const TemporaryFilesIn there(temporary.path());
    const std::string message = error_of([&] { delaunay_by_process(tool, tetrahedron); });
    const auto first = message.find(temporary.path());
    ASSERT_NE(first, std::string::npos) << message;
    EXPECT_NE(message.find(temporary.path(), first + 1), std::string::npos) << message;
    EXPECT_TRUE(temporary.empty());
}

TEST(DelaunayProcess, NamesAMissingFolderForTemporaryFiles) {
    const TemporaryFolder folder;
    const auto tool = script(folder, "exit 0");
    const TemporaryFilesIn there(folder / "absent");
    expect_error([&] { delaunay_by_process(tool, tetrahedron); },
                 {"absent: cannot write temporary files: No such file", "TMPDIR"});
}

// The points do not fit into the folder.
TEST(DelaunayProcess, AFullFolderForTemporaryFilesIsNamed) {
    const TemporaryFolder folder;
    const auto tool = script(folder, "exit 0");
    const TemporaryFilesIn there(folder.path());
    const FileSizeLimit full(16);
    expect_error([&] { delaunay_by_process(tool, tetrahedron); },
                 {folder.path(), "cannot write temporary files: File too large", "TMPDIR"});
}

TEST(DelaunayProcess, ManyMessagesDoNotStopTheProgram) {
    const TemporaryFolder folder;
    const auto tool = script(folder, "yes chatter | head -c 1000000 >&2; echo the end >&2; exit 1");
    expect_error([&] { delaunay_by_process(tool, tetrahedron); }, {"the end (exit code 1)"});
}

// A terminal sends Ctrl-C to both processes, which is no failure of the program.
TEST(DelaunayProcess, ASignalToBothProcessesIsAnInterrupt) {
    const TemporaryFolder folder;
    const auto tool = script(folder, "kill -TERM $PPID $$; sleep 20");
    const SignalStop signals;
    const ClientScope scope({.stop = signals.token()});
    EXPECT_THROW(delaunay_by_process(tool, tetrahedron), Interrupted);
}

class Tetrahedralize : public testing::Test {
  protected:
    void SetUp() override {
        if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty()) {
            GTEST_SKIP() << "built without TetGen";
        }
    }
    static DelaunayTets run(const std::vector<glm::dvec3>& points) {
        return delaunay_by_process(LAMINA_TETRAHEDRALIZE_BINARY, points);
    }
};

TEST_F(Tetrahedralize, OneTetIsPositive) {
    const DelaunayTets mesh = run(tetrahedron);
    ASSERT_EQ(mesh.tets.size(), 1u);
    Tet sorted = mesh.tets[0];
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, (Tet{0, 1, 2, 3}));
    EXPECT_EQ(mesh.neighbors[0], (std::array<std::int32_t, 4>{-1, -1, -1, -1}));
}

// The points fit, but the tets do not: they take more bytes, since each point has six or more.
TEST_F(Tetrahedralize, NamesTheFolderWithoutRoomForTheAnswer) {
    const TemporaryFolder folder;
    std::vector<glm::dvec3> points;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(0, 1);
    for (int i = 0; i < 200; ++i) points.emplace_back(place(random), place(random), place(random));
    const TemporaryFilesIn there(folder.path());
    const FileSizeLimit full(sizeof(std::int64_t) + points.size() * sizeof(glm::dvec3));
    expect_error([&] { run(points); }, {folder.path(), "no room for the tetrahedra of 200 points",
                                        "File too large", "TMPDIR"});
}

// The program ends when its parent is killed. It is reading an endless question, and has started up
// once it has read more than a pipe holds.
TEST_F(Tetrahedralize, EndsWhenItsParentIsKilled) {
    std::signal(SIGPIPE, SIG_IGN);
    int question[2], answer[2];
    ASSERT_EQ(pipe2(question, O_CLOEXEC), 0);
    ASSERT_EQ(pipe2(answer, O_CLOEXEC), 0);
    const pid_t asking = fork();
    if (asking == 0) {
        dup2(question[0], STDIN_FILENO);
        dup2(answer[1], STDOUT_FILENO);
        // A shell gives background processes an empty stdin unless it is redirected, as here.
        const std::string command = "exec 3<&0; \"" LAMINA_TETRAHEDRALIZE_BINARY
                                    "\" --parent $$ <&3 & exec 3<&- </dev/null >/dev/null; wait";
        execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        _exit(127);
    }
    close(question[0]);
    close(answer[1]);
    const std::vector<char> bytes(std::size_t{1} << 20, 1);
    std::size_t written = 0;
    while (written < bytes.size()) {
        const ssize_t count = write(question[1], bytes.data() + written, bytes.size() - written);
        ASSERT_GT(count, 0);
        written += static_cast<std::size_t>(count);
    }
    kill(asking, SIGKILL);
    waitpid(asking, nullptr, 0);
    // The end of its stdout: no process has the pipe's other end open any more.
    pollfd ended{answer[0], POLLIN, 0};
    constexpr int patience = 20'000;
    EXPECT_EQ(poll(&ended, 1, patience), 1);
    close(question[1]);
    close(answer[0]);
}

TEST(DelaunayProcess, GivesTheProgramTheIdOfItsParent) {
    const TemporaryFolder folder;
    const auto tool = script(folder, "echo \"$@\" >&2; exit 1");
    expect_error([&] { delaunay_by_process(tool, tetrahedron); },
                 {"--parent " + std::to_string(getpid())});
}

TEST_F(Tetrahedralize, EndsAtOnceIfItsParentIsGone) {
    const TemporaryFolder folder;
    const auto tool = script(folder, LAMINA_TETRAHEDRALIZE_BINARY " --parent 1");
    expect_error([&] { delaunay_by_process(tool, tetrahedron); }, {"has ended (exit code 1)"});
}

// Many points of a lattice lie on common spheres, planes and lines.
TEST_F(Tetrahedralize, LatticesGiveNoFlatTets) {
    std::vector<glm::dvec3> points;
    std::mt19937 random(1);
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j)
            for (int k = 0; k < 9; ++k)
                if ((i % 8 == 0 && j % 8 == 0 && k % 8 == 0) || random() % 2 == 0)
                    points.emplace_back(i, j, k);
    const DelaunayTets mesh = run(points);
    double volume = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto at = [&](std::size_t i) { return points[mesh.tets[t][i]]; };
        const double part = glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0));
        EXPECT_GE(part, 1);  // a determinant of whole numbers
        volume += part / 6;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int32_t neighbor = mesh.neighbors[t][i];
            if (neighbor < 0) continue;
            // The neighbour must have all corners of the tet but the opposite one.
            int shared = 0;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                const auto& other = mesh.tets[neighbor];
                const bool in = std::count(other.begin(), other.end(), mesh.tets[t][corner]) > 0;
                EXPECT_EQ(in, corner != i);
                shared += in ? 1 : 0;
            }
            EXPECT_EQ(shared, 3);
        }
    }
    EXPECT_NEAR(volume, 512, 1e-9);
}

TEST_F(Tetrahedralize, RefusesPointsThatSpanNoVolume) {
    std::vector<glm::dvec3> plane, oblique;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            plane.emplace_back(i, 2, j);
            oblique.emplace_back(i, j, i + j);
        }
    }
    expect_error([&] { run(plane); }, {"25 points", "one plane"});
    expect_error([&] { run(oblique); }, {"25 points"});  // TetGen crashes
    expect_error([&] { run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}); }, {"3 points", "expected 4"});
    expect_error([&] { run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}); }, {"finite"});
}

}  // namespace
}  // namespace lamina
