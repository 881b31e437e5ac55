// SPDX-License-Identifier: Apache-2.0
// Pictures that several ranks draw together.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "image/difference.h"
#include "image/exr.h"
#include "mpi_run.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

using Arguments = std::vector<std::string>;

double error_of_composing(int ranks, const std::string& wire, int most_in_group, int seed) {
    const ProgramResult result = mpi_run(
        ranks, {COMPOSE_PICTURES, wire, std::to_string(most_in_group), std::to_string(seed)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::atof(result.out.c_str());
}

// float32 rounds once in each of N - 1 steps of OVER, in a group and again among groups.
TEST(ComposedPictures, AreThoseOfOneRank) {
    for (const int ranks : {2, 3, 7}) {
        EXPECT_LE(error_of_composing(ranks, "float32", 64, ranks), 255 * 2.4e-7 * ranks);
        EXPECT_LE(error_of_composing(ranks, "float32", 2, ranks), 255 * 2.4e-7 * ranks);
    }
}

// docs/cluster.md: half a code of 8 bits, and one code of 16 bits for each later transfer.
TEST(ComposedPictures, AreOffByHalfACodeIfSentAsCodes) {
    for (const int group : {64, 3}) {
        const double error = error_of_composing(8, "coded", group, 1);
        EXPECT_LE(error, .5 + .002 * 8);
        EXPECT_GT(error, .1);
    }
}

// Four halves: each fragment is off by at most half a step of the largest values, 2^-12, and so is
// the sum.
TEST(ComposedPictures, AreOffByLittleIfSentAsHalves) {
    EXPECT_LE(error_of_composing(4, "half", 64, 1), 255 * 3 * 0x1p-12);
}

class RankPictures : public testing::Test {
  protected:
    // Writes a volume of 60 x 50 x 40 bytes with some balls in it.
    void SetUp() override {
        std::string bytes =
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 60 50 40\nencoding: raw\n\n";
        for (int z = 0; z < 40; ++z)
            for (int y = 0; y < 50; ++y)
                for (int x = 0; x < 60; ++x) {
                    const double r = std::hypot(x % 30 - 15, y % 25 - 12, z - 20);
                    bytes += static_cast<char>(r < 12 ? 250 - 15 * static_cast<int>(r) : 0);
                }
        write_bytes_to(volume, bytes);
    }
    Arguments rendering(const std::string& picture, const Arguments& more) const {
        Arguments arguments{"render", volume, "-o", folder / picture, "--size", "90x70", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    Image render(int ranks, const Arguments& more) const {
        Arguments command = rendering("ranks.exr", more);
        command.insert(command.begin(), LAMINA_MPI_BINARY);
        const ProgramResult result = mpi_run(ranks, command);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(folder / "ranks.exr");
    }
    Image render_alone(const Arguments& more) const {
        Arguments command = rendering("one.exr", more);
        command.insert(command.begin(), LAMINA_BINARY);
        const ProgramResult result = run_program(command);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return read_exr(folder / "one.exr");
    }
    static double difference(const Image& a, const Image& b) { return image_error(a, b).all.linf; }

    TemporaryFolder folder;
    std::filesystem::path volume = folder / "balls.nrrd";
};

// Largest difference that docs/cluster.md allows, in 1/255. tests/slicing/volume_shares_test.cpp
// tests tighter bounds with many more scenes in one process.
constexpr double wanted = .01;

TEST_F(RankPictures, AreThoseOfOneProcess) {
    for (const Arguments& more :
         {Arguments{},
          {"--set", "lighting={}", "--azimuth", "100"},
          {"--set", "render.slice.samples=90", "--azimuth", "200"},
          {"--set", "render.slice.classification=preintegrated", "--elevation", "-70"}}) {
        const Image alone = render_alone(more);
        for (const int ranks : {1, 2, 5})
            EXPECT_LE(difference(alone, render(ranks, more)), ranks == 1 ? 0 : wanted)
                << fmt::format("{} ranks {}", ranks, fmt::join(more, " "));
    }
}

TEST_F(RankPictures, AreThoseOfOneProcessIfDataStayInFiles) {
    EXPECT_LE(difference(render_alone({}), render(3, {"--memory", "1M"})), wanted);
}

TEST_F(RankPictures, AreThoseOfOneProcessIfFramesAreTimed) {
    const Arguments timed{"--frames", "3"};
    EXPECT_LE(difference(render_alone(timed), render(2, timed)), wanted);
}

// A file name in Latin-1, which is no UTF-8.
TEST_F(RankPictures, AreDrawnFromFilesOfAnyName) {
    const std::filesystem::path renamed = folder / "caf\xe9.nrrd";
    std::filesystem::rename(volume, renamed);
    volume = renamed;
    EXPECT_LE(difference(render_alone({}), render(2, {})), wanted);
}

TEST_F(RankPictures, AreReproducible) {
    for (const std::string wire : {"float32", "coded"}) {
        const Image one = render(4, {"--wire", wire}), other = render(4, {"--wire", wire});
        EXPECT_EQ(one.rgba, other.rgba);
    }
}

TEST_F(RankPictures, AreThoseOfOneProcessOnATurntable) {
    const auto turned = [&](const std::string& name, const Arguments& program, int ranks) {
        Arguments command = program;
        const Arguments rest{"render",      volume, "-o",     folder / (name + "-%d.exr"),
                             "--turntable", "3",    "--size", "40x30",
                             "--quiet"};
        command.insert(command.end(), rest.begin(), rest.end());
        const ProgramResult result = ranks > 0 ? mpi_run(ranks, command) : run_program(command);
        EXPECT_EQ(result.exit_code, 0) << result.err;
    };
    turned("one", {LAMINA_BINARY}, 0);
    turned("three", {LAMINA_MPI_BINARY}, 3);
    for (int view = 0; view < 3; ++view) {
        const auto read = [&](const std::string& name) {
            return read_exr(folder / fmt::format("{}-{}.exr", name, view));
        };
        EXPECT_LE(difference(read("one"), read("three")), wanted);
    }
}

TEST_F(RankPictures, ComeWithStatisticsOfEachRank) {
    render(3, {"--stats", folder / "stats.json"});
    const auto stats = nlohmann::json::parse(read_bytes_of(folder / "stats.json"));
    ASSERT_EQ(stats["ranks"].size(), 3u);
    std::int64_t segments = 0;
    for (const auto& rank : stats["ranks"]) {
        EXPECT_GT(rank["bytes_sent"], 0);
        EXPECT_GT(rank["peak_rss_mb"], 1);
        segments += rank["segments"].get<std::int64_t>();
    }
    EXPECT_EQ(stats["fragments"], segments);
}

}  // namespace
}  // namespace lamina
