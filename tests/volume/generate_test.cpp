// SPDX-License-Identifier: Apache-2.0
#include "volume/generate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <map>
#include <numbers>

#include "base/error.h"
#include "support/samples_of.h"
#include "volume/min_max_bricks.h"

namespace lamina {
namespace {

using testing::samples_of;

GeneratorRequest request(const std::string& name, std::array<std::int64_t, 3> size,
                         SampleType type = SampleType::uint8) {
    return {name, size, type};
}

std::string error_of_request(const GeneratorRequest& bad) {
    try {
        generated_grid(bad);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::uint32_t checksum(const Volume& volume) {
    return static_cast<std::uint32_t>(
        crc32(0, static_cast<const Bytef*>(volume.data()), static_cast<uInt>(volume.byte_count())));
}

TEST(Generate, RampCountsVoxelsOfEdgeOne) {
    const Volume ramp = generate({"ramp", {}, SampleType::uint8});
    EXPECT_EQ(ramp.grid().size, (std::array<std::int64_t, 3>{256, 4, 1}));
    EXPECT_EQ(ramp.grid().bounds().min, glm::dvec3(-0.5));
    EXPECT_EQ(ramp.grid().bounds().max, glm::dvec3(255.5, 3.5, 0.5));
    const auto codes = samples_of<std::uint8_t>(ramp);
    for (std::size_t i = 0; i < codes.size(); ++i) EXPECT_EQ(codes[i], i % 256);
    const auto wide =
        samples_of<std::uint16_t>(generate(request("ramp", {256, 1, 1}, SampleType::uint16)));
    EXPECT_EQ(wide[255], 65535);
    EXPECT_EQ(wide[3], 3 * 257);
    const auto real = samples_of<float>(generate(request("ramp", {5, 1, 1}, SampleType::float32)));
    EXPECT_EQ(real, (std::vector<float>{0, 0.25f, 0.5f, 0.75f, 1}));
}

TEST(Generate, ConstantIsTheMiddleCode) {
    EXPECT_EQ(samples_of<std::uint8_t>(generate(request("constant", {2, 2, 2}))),
              std::vector<std::uint8_t>(8, 128));
    EXPECT_EQ(
        samples_of<std::uint16_t>(generate(request("constant", {2, 2, 2}, SampleType::uint16))),
        std::vector<std::uint16_t>(8, 32768));
    EXPECT_EQ(samples_of<float>(generate(request("constant", {2, 2, 2}, SampleType::float32))),
              std::vector<float>(8, 0.5f));
}

TEST(Generate, MarschnerLobbFollowsItsFormula) {
    const Volume volume = generate(request("marschner-lobb", {21, 23, 25}, SampleType::float32));
    const auto values = samples_of<float>(volume);
    const double pi = std::numbers::pi;
    for (int z = 0; z < 25; ++z)
        for (int y = 0; y < 23; ++y)
            for (int x = 0; x < 21; ++x) {
                const double r = std::hypot(x / 10.0 - 1, y / 11.0 - 1);
                const double rho = std::cos(2 * pi * 6 * std::cos(pi * r / 2));
                const double expected =
                    (1 - std::sin(pi * (z / 12.0 - 1) / 2) + 0.25 * (1 + rho)) / 2.5;
                // float rounding of values up to 1: 2^-25 = 3e-8; the double arithmetic is far
                // below
                EXPECT_NEAR(values[static_cast<std::size_t>((z * 23 + y) * 21 + x)], expected,
                            4e-8);
            }
}

TEST(Generate, DefaultsFillTheUnitBoxAndTheRangeOfTheType) {
    for (const std::string& name : generator_names()) {
        if (name == "ramp") continue;
        const Volume volume = generate({name, {}, SampleType::uint8});
        EXPECT_EQ(volume.grid().size, (std::array<std::int64_t, 3>{128, 128, 128})) << name;
        EXPECT_EQ(volume.grid().centering[0], Centering::node) << name;
        EXPECT_EQ(volume.grid().bounds().min, glm::dvec3(0)) << name;
        EXPECT_EQ(volume.grid().bounds().max, glm::dvec3(1)) << name;
        if (name == "constant") continue;
        const ValueRange range = measure_bricks(volume).whole;
        EXPECT_EQ(range.lo, 0) << name;
        EXPECT_EQ(range.hi, 255) << name;
    }
}

TEST(Generate, AxisOfOneSampleIsAVoxelThatFillsTheBox) {
    for (const std::string& name : generator_names()) {
        if (name == "ramp") continue;
        const Grid grid = generate(request(name, {1, 5, 1})).grid();
        EXPECT_EQ(grid.bounds().min, glm::dvec3(0)) << name;
        EXPECT_EQ(grid.bounds().max, glm::dvec3(1)) << name;
        EXPECT_EQ(grid.centering[0], Centering::cell) << name;
        EXPECT_EQ(grid.centering[1], Centering::node) << name;
    }
}

TEST(Generate, FloatsStayWithinZeroAndOne) {
    for (const std::string& name : generator_names()) {
        const MinMaxBricks bricks =
            measure_bricks(generate(request(name, {60, 61, 62}, SampleType::float32)));
        EXPECT_GE(bricks.whole.lo, 0) << name;
        EXPECT_LE(bricks.whole.hi, 1) << name;
        EXPECT_EQ(bricks.non_finite, 0) << name;
    }
}

TEST(Generate, MixingIsLightFluidBelowAndHeavyFluidAbove) {
    const auto codes = samples_of<std::uint8_t>(generate(request("mixing", {64, 64, 64})));
    std::vector<double> mean(64);
    for (std::size_t i = 0; i < codes.size(); ++i) mean[i % 64] += codes[i] / 4096.0;
    EXPECT_EQ(mean[0], 0);
    EXPECT_EQ(mean[63], 255);
    EXPECT_GT(mean[32], 255 * 0.2);  // both fluids are in the middle
    EXPECT_LT(mean[32], 255 * 0.8);
}

TEST(Generate, SheetsAreThinAndDense) {
    const auto codes = samples_of<std::uint8_t>(generate(request("sheets", {32, 32, 64})));
    std::size_t full = 0;
    for (const std::uint8_t code : codes) {
        EXPECT_TRUE(code == 0 || code == 255);
        full += code == 255;
    }
    // 5 sheets take one or two samples each in columns of 64: fewer where a sheet leaves the box,
    // more in the steep one.
    EXPECT_GT(full, codes.size() * 3 / 64);
    EXPECT_LT(full, codes.size() * 12 / 64);
}

// A change of these sums means that users' generated volumes change: say so in the changelog.
TEST(Generate, GivesTheSameSamplesOnEveryMachine) {
    const std::map<std::string, std::uint32_t> expected = {
        {"ramp", 3144637749u},      {"constant", 751574407u}, {"marschner-lobb", 4113573802u},
        {"gaussians", 2698888863u}, {"sheets", 3893326501u},  {"mixing", 2942738151u}};
    for (const auto& [name, sum] : expected) {
        EXPECT_EQ(checksum(generate(request(name, {40, 41, 42}, SampleType::float32))), sum)
            << name;
    }
}

TEST(Generate, RefusesWhatItCannotMake) {
    EXPECT_EQ(error_of_request(request("bonsai", {8, 8, 8})),
              "unknown generator 'bonsai': expected one of ramp, constant, marschner-lobb, "
              "gaussians, sheets, mixing");
    EXPECT_EQ(
        error_of_request(request("mixing", {8, 0, 8})),
        "size of a generated volume: found 8,0,8, expected 1 to 2048 samples along each axis");
    EXPECT_EQ(
        error_of_request(request("mixing", {8, 8, 2049})),
        "size of a generated volume: found 8,8,2049, expected 1 to 2048 samples along each axis");
    EXPECT_EQ(error_of_request(request("mixing", {8, 8, 8}, SampleType::int16)),
              "type of a generated volume: found 'int16', expected uint8, uint16 or float");
}

}  // namespace
}  // namespace lamina
