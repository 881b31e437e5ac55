// SPDX-License-Identifier: Apache-2.0
// Checks the data sets of the project's example scenes against their README.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "volume/min_max_bricks.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

struct DataSet {
    const char* name;
    std::array<std::int64_t, 3> size;
    SampleType type;
    glm::dvec3 spacing;
    double hi;

    friend void PrintTo(const DataSet& set, std::ostream* stream) { *stream << set.name; }
};

std::filesystem::path data_folder() {
    if (const char* const folder = std::getenv("LAMINA_DATA")) return folder;
    return std::filesystem::path(LAMINA_SOURCE_DIR) / ".." / "shared" / "data";
}

class DataSets : public ::testing::TestWithParam<DataSet> {};

TEST_P(DataSets, HaveTheExpectedSizesTypesAndRanges) {
    const DataSet& expected = GetParam();
    const auto path = data_folder() / (std::string(expected.name) + ".nrrd");
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const Volume volume = open_nrrd(path);
    EXPECT_EQ(volume.grid().size, expected.size);
    EXPECT_EQ(volume.type(), expected.type);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step{0};
        step[axis] = expected.spacing[axis];
        EXPECT_EQ(volume.grid().step[static_cast<std::size_t>(axis)], step);
    }
    const MinMaxBricks bricks = measure_bricks(volume);
    EXPECT_EQ(bricks.whole.lo, 0);
    EXPECT_EQ(bricks.whole.hi, expected.hi);
    EXPECT_EQ(bricks.non_finite, 0);
}

constexpr glm::dvec3 unit{1, 1, 1};

INSTANTIATE_TEST_SUITE_P(
    All, DataSets,
    ::testing::Values(DataSet{"bonsai", {256, 256, 256}, SampleType::uint8, unit, 255},
                      DataSet{"engine", {256, 256, 128}, SampleType::uint8, unit, 255},
                      DataSet{"aneurism", {256, 256, 256}, SampleType::uint8, unit, 255},
                      DataSet{"headsq", {64, 64, 93}, SampleType::int16, {3.2, 3.2, 1.5}, 3926},
                      DataSet{"hydrogen", {64, 64, 64}, SampleType::float32, unit, 1},
                      DataSet{"heptane", {302, 302, 302}, SampleType::uint8, unit, 255}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace lamina
