// SPDX-License-Identifier: Apache-2.0
// Checks the data sets of the project's example scenes against their README.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "volume/min_max_bricks.h"
#include "volume_files/volume_file.h"
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

// None of the project's data are labels, also those that are mostly empty.
TEST(ProjectData, IsNoLabels) {
    if (!std::filesystem::exists(data_folder())) GTEST_SKIP() << data_folder() << " is not there";
    int read = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data_folder())) {
        const std::filesystem::path path = entry.path();
        try {
            if (!is_volume_file(path)) continue;
            EXPECT_EQ(read_volume(path).grid().lookup, VolumeLookup::linear) << path;
            ++read;
        } catch (const Error&) {
            continue;  // other tests say which are refused
        }
    }
    EXPECT_GT(read, 10);
}

}  // namespace
}  // namespace lamina
