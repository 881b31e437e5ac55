// SPDX-License-Identifier: Apache-2.0
// --memory and lamina index: volumes that are larger than the memory limit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/lamina_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using nlohmann::json;

class Memory : public testing::Test {
  protected:
    // Writes a volume of 200 x 150 x 100 bytes with some balls in it.
    void SetUp() override {
        std::string bytes = header;
        for (int z = 0; z < 100; ++z)
            for (int y = 0; y < 150; ++y)
                for (int x = 0; x < 200; ++x) {
                    const double r = std::hypot(x % 67 - 33, y % 75 - 37, z - 50);
                    bytes += static_cast<char>(r < 30 ? 250 - 6 * static_cast<int>(r) : 0);
                }
        write_bytes_to(volume, bytes);
    }
    ProgramResult run(std::vector<std::string> arguments) const {
        return lamina_run(std::move(arguments),
                          [&] { setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1); });
    }
    // Returns the bytes of the picture.
    std::string render(const std::string& memory, std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments{"render",   volume, "-o",     folder / "picture.exr",
                                           "--memory", memory, "--size", "80x60"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        said = result.err;
        const std::string picture = read_bytes_of(folder / "picture.exr");
        std::filesystem::remove(folder / "picture.exr");
        return picture;
    }

    const std::string header =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 200 150 100\nencoding: raw\n\n";
    TemporaryFolder folder;
    std::filesystem::path volume = folder / "balls.nrrd";
    mutable std::string said;
};

TEST_F(Memory, LimitsDoNotChangeThePicture) {
    for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                                 {"--method", "trace"},
                                                 {"--set", "render.slice.samples=90"},
                                                 {"--set", "lighting={}"}})
        EXPECT_EQ(render("1M", more), render("1G", more))
            << fmt::format("{}", fmt::join(more, " "));
}

TEST_F(Memory, IndexIsKeptUntilTheVolumeChanges) {
    const std::string picture = render("1M");
    const auto cached = [&] {
        return std::filesystem::directory_iterator(folder / "cache/lamina")->path();
    };
    const std::string index = read_bytes_of(cached());
    EXPECT_EQ(render("1M"), picture);
    EXPECT_EQ(said.find("index"), std::string::npos) << said;
    write_bytes_to(cached(), "damaged");
    EXPECT_EQ(render("1M"), picture);
    EXPECT_EQ(read_bytes_of(cached()), index);

    const ProgramResult made = run({"index", volume});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.err.find("balls.nrrd.lamina-index"), std::string::npos) << made.err;
    EXPECT_EQ(read_bytes_of(volume.string() + ".lamina-index"), index);
    std::filesystem::remove_all(folder / "cache");
    EXPECT_EQ(render("1M"), picture);
    EXPECT_FALSE(std::filesystem::exists(folder / "cache"));

    std::string bytes = read_bytes_of(volume);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 3);
    write_bytes_to(volume, bytes);
    render("1M");
    EXPECT_NE(said.find("made again"), std::string::npos) << said;
}

TEST_F(Memory, LimitsDoNotChangeWhatInfoSays) {
    const auto info = [&](const char* memory) {
        const ProgramResult result = run({"info", volume, "--json", "--memory", memory});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    };
    EXPECT_EQ(info("1M"), info("1G"));
}

TEST_F(Memory, MistakesAreReportedInOneLine) {
    const auto expect = [&](std::vector<std::string> arguments, int code,
                            std::initializer_list<const char*> parts) {
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
        for (const char* const part : parts)
            EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
    };
    const std::string output = folder / "x.exr";
    for (const char* const size : {"1", "0", "-5G", "G", "1Q", "1GG", "nan", "1e99"})
        expect({"render", volume, "-o", output, "--memory", size}, 2, {"--memory", size});
    expect({"render", volume, "-o", output, "--memory", "1M", "--context", "osmesa", "--quiet"}, 1,
           {"osmesa", "expected cpu"});
    write_bytes_to(folder / "text.nrrd",
                   "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n"
                   "1 2 3 4 5 6 7 8\n");
    expect({"index", folder / "text.nrrd"}, 1, {"text.nrrd", "not raw"});
    expect({"index", folder / "none.nrrd"}, 1, {"none.nrrd"});
}

}  // namespace
}  // namespace lamina
