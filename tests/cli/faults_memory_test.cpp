// SPDX-License-Identifier: Apache-2.0
// Processes with limited memory: ulimit -v, ulimit -s.
#include <sys/resource.h>

#include "cli/faults_test_case.h"

namespace lamina {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limits_work = false;  // sanitizers reserve terabytes of addresses
#else
constexpr bool limits_work = true;
#endif

constexpr rlim_t mebibyte = 1 << 20;

class FaultsOfMemory : public FaultsTestCase {
  protected:
    void SetUp() override {
        if (!limits_work) GTEST_SKIP() << "sanitizers need more memory than any limit";
        FaultsTestCase::SetUp();
    }
    static ProgramResult run_within(rlim_t bytes, const std::vector<std::string>& arguments) {
        return lamina_run(arguments, [=] {
            const rlimit limit{bytes, bytes};
            setrlimit(RLIMIT_AS, &limit);
        });
    }
};

TEST_F(FaultsOfMemory, TooLittleIsReportedInOneLineByTheCpuEngine) {
    const std::string volume = folder / "volume.nrrd";
    make({"generate", "gaussians", "-o", volume, "--size", "32,32,32"});
    rlim_t to_start = mebibyte;  // with less, the system's loader cannot load the libraries
    while (run_within(to_start, {"--version"}).exit_code != 0) to_start += mebibyte;
    to_start += mebibyte;  // constructors of libraries do not always take the same memory
    const std::vector<std::string> works[] = {
        {"info", volume},
        {"mesh", volume, "-o", out / "a.vtu", "--kuhn", "--quiet"},
        {"generate", "gaussians", "-o", out / "a.nrrd", "--size", "32,32,32", "--quiet"},
        rendering(out / "a.exr"),
        rendering(out / "a.exr",
                  {"--set", "volume={\"generate\":\"gaussians\",\"size\":[16,16,16]}", "--method",
                   "project"}),
        rendering(out / "a.npy", {"--method", "trace"})};
    for (const std::vector<std::string>& arguments : works) {
        SCOPED_TRACE(arguments[0] + " " + arguments.back());
        int failed = 0;
        // Threads share memory differently each time, so enough memory means that two sizes
        // succeed.
        for (int done = 0, step = 0; done < 2; ++step) {
            ASSERT_LT(step, 100);
            const rlim_t bytes = to_start + static_cast<rlim_t>(step) * 2 * mebibyte;
            const ProgramResult result = run_within(bytes, arguments);
            if (result.exit_code == 0) {
                ++done;
                for (const auto& [name, made] : contents(out)) std::filesystem::remove(name);
                continue;
            }
            ++failed;
            expect_one_line(result, 1, {});
            EXPECT_TRUE(contents(out).empty()) << bytes / mebibyte << " MiB";
        }
        EXPECT_GT(failed, 0);
    }
}

// A stack of 64 KiB is a tenth of what a picture needs; threads of Mesa would get as little.
TEST_F(FaultsOfMemory, SmallStacksChangeNothing) {
    const auto drawing_by = [&](const char* context) {
        return std::vector<std::string>{"render",      folder / "scene.json", "-o",
                                        out / "a.exr", "--context",           context};
    };
    const std::vector<std::string> works[] = {
        {"info", folder / "volume.nrrd"},
        {"mesh", folder / "volume.nrrd", "-o", out / "a.vtu", "--kuhn", "--quiet"},
        drawing_by("cpu"),
        drawing_by("osmesa"),
        drawing_by("egl"),
        rendering(out / "a.exr", {"--method", "project"}),
        rendering(out / "a.npy", {"--method", "trace"})};
    for (const std::vector<std::string>& arguments : works) {
        SCOPED_TRACE(arguments[0] + " " + arguments.back());
        make(arguments);
        const auto expected = contents(out);
        for (const rlim_t kibibytes : {64, 256}) {
            const ProgramResult result = lamina_run(arguments, [=] {
                const rlimit limit{kibibytes << 10, kibibytes << 10};
                setrlimit(RLIMIT_STACK, &limit);
            });
            EXPECT_EQ(result.exit_code, 0) << kibibytes << " KiB: " << result.err;
            EXPECT_TRUE(contents(out) == expected);
        }
    }
}

// Mesa crashes without memory, so the program checks the limit before it starts Mesa.
TEST_F(FaultsOfMemory, TooLittleForOpenGLIsReportedBeforeItStarts) {
    for (const char* context : {"osmesa", "egl"}) {
        for (const rlim_t mebibytes : {200, 500, 900}) {
            const ProgramResult result = run_within(
                mebibytes * mebibyte,
                {"render", folder / "scene.json", "-o", out / "a.exr", "--context", context});
            expect_one_line(result, 1, {"ulimit -v", "--context cpu"});
            EXPECT_TRUE(contents(out).empty());
        }
    }
}

// The damaged file makes its decoder ask for a gigabyte. The reading process may take 256 MiB more
// than it has (volume_files/isolated_process.cpp); the program itself takes less than 64 MiB.
TEST_F(FaultsOfMemory, ADamagedImageOfAKilobyteTakesLittle) {
    const std::string image = folder / "image.dcm";
    std::filesystem::copy_file(
        LAMINA_SOURCE_DIR "/tests/fuzz/corpus/dicom/fragment_asks_for_memory", image);
    const std::string measure =
        "import resource, subprocess, sys; done = subprocess.run(sys.argv[1:]); "
        "print(done.returncode, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)";
    const ProgramResult result =
        run_program({"python3", "-c", measure, LAMINA_BINARY, "info", image});
    int exit_code = 0, kibibytes = 0;
    std::istringstream(result.out) >> exit_code >> kibibytes;
    EXPECT_EQ(exit_code, 1) << result.err;
    EXPECT_GT(kibibytes, 0);
    EXPECT_LT(kibibytes, (256 + 64) * 1024);
}

}  // namespace
}  // namespace lamina
