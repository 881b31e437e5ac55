// SPDX-License-Identifier: Apache-2.0
// Which samples are taken for labels.
#include "volume/labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/stored_volume.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

constexpr int edge = 40;

// A cube of `inner` samples along each edge in a cube of zeros; inside(x, y, z) gives its samples.
template <typename Sample>
Volume cube(int inner, const std::function<double(double, double, double)>& inside) {
    const auto in = [&](double at) { return at >= 10 && at < 10 + inner; };
    return test::volume_of<Sample>(test::grid_of({edge, edge, edge}, Centering::cell),
                                   [&](double x, double y, double z) {
                                       return in(x) && in(y) && in(z) ? inside(x, y, z) : 0;
                                   });
}

double seven(double /*x*/, double /*y*/, double /*z*/) {
    return 7;
}

std::optional<double> share_of_floats(const std::function<double(double, double, double)>& f) {
    const Volume volume = cube<float>(10, f);
    return share_if_labels(volume.grid().size, ValueType::float32, volume.data());
}

// The cube's outer layer, and the six layers around it, are all that do not equal their neighbours.
TEST(Labels, AreKnownByTheShareOfSamplesThatEqualTheirNeighbours) {
    const Volume volume = cube<std::uint8_t>(10, seven);
    const double unequal = 10 * 10 * 10 - 8 * 8 * 8 + 6 * 10 * 10;
    const auto share = share_if_labels(volume);
    ASSERT_TRUE(share);
    EXPECT_DOUBLE_EQ(*share, 1 - unequal / (edge * edge * edge));
    EXPECT_EQ(share_if_labels(test::stored(volume)), share);
    // 20^3 - 18^3 + 6 20^2 samples, 7.1 % of all, differ from a neighbour.
    EXPECT_FALSE(share_if_labels(cube<std::uint8_t>(20, seven)));
}

TEST(Labels, AreNotWhatIsNoisyInAnEmptySurrounding) {
    const auto noisy = [](double x, double y, double z) {
        return 100 + std::fmod(7 * x + 5 * y + 3 * z, 20);
    };
    EXPECT_FALSE(share_if_labels(cube<std::uint8_t>(10, noisy)));
    // Two layers of each value: of the pairs of neighbours along x half are equal, all others are.
    EXPECT_TRUE(share_if_labels(
        cube<std::uint8_t>(10, [](double x, double, double) { return std::floor(x / 2); })));
}

TEST(Labels, AreAtLeastTwoValuesWithNeighboursOfTheirOwn) {
    EXPECT_FALSE(share_if_labels(cube<std::uint8_t>(0, seven)));
    EXPECT_FALSE(share_if_labels(cube<std::uint8_t>(1, seven)));
    EXPECT_TRUE(share_if_labels(cube<std::uint8_t>(2, seven)));
    EXPECT_TRUE(share_if_labels(cube<std::int16_t>(9, seven)));
}

TEST(Labels, AreWholeNumbersOfAnyType) {
    EXPECT_TRUE(share_of_floats(seven));
    EXPECT_FALSE(share_of_floats([](double, double, double) { return 7.5; }));
    EXPECT_FALSE(share_of_floats([](double, double, double) { return NAN; }));
    EXPECT_FALSE(share_of_floats([](double, double, double) { return 0x1p60; }));
    const std::vector<std::uint64_t> row{1, 1, 1, ~std::uint64_t{}, ~std::uint64_t{}};
    std::vector<std::uint64_t> wide;
    for (const std::uint64_t value : row) wide.insert(wide.end(), 100, value);
    EXPECT_TRUE(share_if_labels({500, 1, 1}, ValueType::uint64, wide.data()));
    // Volumes of float are not measured: those in memory become whole numbers when they are read.
    EXPECT_FALSE(share_if_labels(cube<float>(10, seven)));
}

// 2^24 + 2^18 samples: 64 of 260 slices are measured, of a volume in files the same.
TEST(Labels, OfLargeVolumesAreKnownBySomeSlices) {
    const Grid grid = test::grid_of({256, 256, 260}, Centering::cell);
    const auto samples =
        std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(grid.sample_count()));
    for (std::size_t i = samples->size() / 2; i < samples->size(); ++i) (*samples)[i] = 3;
    const Volume volume(grid, SampleType::uint8,
                        std::shared_ptr<const void>(samples, samples->data()));
    const auto share = share_if_labels(volume);
    ASSERT_TRUE(share);
    // The two slices where labels meet differ; at most one of two neighbours is measured.
    EXPECT_NEAR(*share, 1 - .5 / 64, .5 / 64);
    auto source = std::make_unique<test::SourceInMemory>(volume);
    const test::SourceInMemory& read = *source;
    const Volume stored(
        grid, SampleType::uint8,
        std::make_shared<const VolumeStore>(grid, SampleType::uint8, std::move(source)));
    EXPECT_EQ(share_if_labels(stored), share);
    // Twice, with a slice on each side: 64 of 260 slices.
    EXPECT_LE(read.samples_read, 2 * 3 * 64 * 256 * 256);
}

TEST(Labels, HaveNamesAndColoursByTheirNumbers) {
    const Volume volume = cube<std::uint8_t>(3, seven);
    const Volume named = with_descriptions(
        volume, {{0, "7", "seven", glm::dvec3(.5)}, {0, "3", "three", glm::dvec3(0)}});
    ASSERT_EQ(named.labels()->list.size(), 2u);
    EXPECT_FALSE(named.labels()->renumbered);
    EXPECT_EQ(named.labels()->list[0].name, "three");
    EXPECT_EQ(named.labels()->list[1].code, 7);
    // A renumbered volume lists all labels.
    const Volume codes = volume.labelled(
        std::make_shared<const VolumeLabels>(VolumeLabels{true, {{0, "-5"}, {7, "1000000007"}}}));
    const auto labels =
        with_descriptions(codes, {{0, "1000000007", "far"}, {0, "8", "no"}}).labels();
    ASSERT_EQ(labels->list.size(), 2u);
    EXPECT_EQ(labels->list[1].name, "far");
    EXPECT_EQ(labels->list[1].code, 7);
}

}  // namespace
}  // namespace lamina
