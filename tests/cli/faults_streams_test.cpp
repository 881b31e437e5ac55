// SPDX-License-Identifier: Apache-2.0
// Standard streams that are full, closed, or whose reader is gone.
#include <fcntl.h>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

// Returns a function for the new process that opens `path` as `descriptor`.
std::function<void()> leads_to(int descriptor, const char* path) {
    return [=] { dup2(open(path, O_WRONLY), descriptor); };
}

std::function<void()> is_closed(int descriptor) {
    return [=] { close(descriptor); };
}

void nobody_reads_stdout() {
    int ends[2];
    if (pipe(ends) != 0) _exit(126);
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]);
    close(ends[1]);
}

class FaultsOfStreams : public FaultsTestCase {
  protected:
    void SetUp() override {
        FaultsTestCase::SetUp();
        make({"mesh", volume, "-o", mesh, "--kuhn"});
        make(rendering(picture));
    }

    const std::string volume = folder / "volume.nrrd", mesh = folder / "mesh.vtu",
                      picture = folder / "a.png";
    const std::vector<std::vector<std::string>> that_print = {
        {"--help"},
        {"--version"},
        {"render", "--help"},
        {"render", folder / "scene.json", "--explain", "--context", "cpu"},
        {"info", volume},
        {"info", mesh, "--json"},
        {"compare", picture, picture},
        {"integrate", folder / "segments.json"},
        {"mesh", volume, "-o", out / "a.vtu", "--kuhn"},
        {"order", mesh}};
};

TEST_F(FaultsOfStreams, ResultsThatDoNotArriveAreAFailure) {
    for (const std::vector<std::string>& arguments : that_print) {
        SCOPED_TRACE(arguments[0]);
        expect_one_line(lamina_run(arguments, leads_to(STDOUT_FILENO, "/dev/full")), 1,
                        {"stdout", "No space left"});
        expect_one_line(lamina_run(arguments, is_closed(STDOUT_FILENO)), 1,
                        {"stdout", "Bad file descriptor"});
        expect_one_line(lamina_run(arguments, nobody_reads_stdout), 1, {"stdout", "Broken pipe"});
    }
}

TEST_F(FaultsOfStreams, LostMessagesAreNoFailure) {
    for (const auto& stderr_fault :
         {leads_to(STDERR_FILENO, "/dev/full"), is_closed(STDERR_FILENO)}) {
        for (const std::vector<std::string>& arguments : that_print)
            EXPECT_EQ(lamina_run(arguments, stderr_fault).exit_code, 0) << arguments[0];
        const std::string made = out / "a.png", scene = folder / "scene.json";
        EXPECT_EQ(lamina_run({"render", scene, "-o", made}, stderr_fault).exit_code, 0);
        EXPECT_EQ(lamina_run({"info", folder / "absent.nrrd"}, stderr_fault).exit_code, 1);
        EXPECT_EQ(lamina_run({"dance"}, stderr_fault).exit_code, 2);
    }
}

// If stdout is closed, its number is free, and the next file that is opened would get it.
TEST_F(FaultsOfStreams, ClosedStreamsDoNotLandInFiles) {
    make(rendering(folder / "a.exr"));
    const std::string expected = read_bytes_of(folder / "a.exr");
    for (int closed = 1; closed < 8; ++closed) {
        const auto close_them = [&] {
            for (int descriptor = 0; descriptor < 3; ++descriptor)
                if ((closed >> descriptor & 1) != 0) close(descriptor);
        };
        const std::vector<std::string> arguments{"render",      folder / "scene.json", "-o",
                                                 out / "a.exr", "--context",           "cpu"};
        EXPECT_EQ(lamina_run(arguments, close_them).exit_code, 0) << closed;
        EXPECT_EQ(read_bytes_of(out / "a.exr"), expected) << closed;
        std::vector<std::string> explaining = arguments;
        explaining.emplace_back("--explain");
        EXPECT_EQ(lamina_run(explaining, close_them).exit_code, (closed & 2) != 0 ? 1 : 0);
        EXPECT_EQ(read_bytes_of(out / "a.exr"), expected) << closed;
        EXPECT_EQ(contents(out).size(), 1u);
    }
}

}  // namespace
}  // namespace lamina
