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

using Verdict = LabelSigns::Verdict;

LabelSigns signs_of_floats(const std::function<double(double, double, double)>& f) {
    const Volume volume = cube<float>(10, f);
    return label_signs(volume.grid().size, ValueType::float32, volume.data());
}

// Samples of a function of the distance from the middle of a cube of 64 samples along each edge.
Volume around_middle(const std::function<double(double)>& of_distance) {
    return test::volume_of<std::int16_t>(
        test::grid_of({64, 64, 64}, Centering::cell), [&](double x, double y, double z) {
            return std::round(of_distance(std::hypot(x - 31.3, y - 31.3, z - 31.3)));
        });
}

// The cube's outer layer, and the six layers around it, are all that do not equal their neighbours.
TEST(Labels, AreKnownByTheShareOfSamplesThatEqualTheirNeighbours) {
    const Volume volume = cube<std::uint8_t>(10, seven);
    const double unequal = 10 * 10 * 10 - 8 * 8 * 8 + 6 * 10 * 10;
    const LabelSigns signs = label_signs(volume);
    EXPECT_TRUE(signs.are_labels());
    EXPECT_DOUBLE_EQ(signs.equal, 1 - unequal / (edge * edge * edge));
    EXPECT_EQ(label_signs(test::stored(volume)).equal, signs.equal);
    // 20^3 - 18^3 + 6 20^2 samples, 7.1 % of all, differ from a neighbour.
    EXPECT_EQ(label_signs(cube<std::uint8_t>(20, seven)).verdict, Verdict::scattered);
}

TEST(Labels, AreNotWhatIsNoisyInAnEmptySurrounding) {
    const auto noisy = [](double x, double y, double z) {
        return 100 + std::fmod(7 * x + 5 * y + 3 * z, 20);
    };
    EXPECT_EQ(label_signs(cube<std::uint8_t>(10, noisy)).verdict, Verdict::none);
    // Two layers of each value: of the pairs of neighbours along x half are equal, all others are.
    // They differ by 1, but meet the zeros around them on more faces.
    EXPECT_TRUE(label_signs(cube<std::uint8_t>(10, [](double x, double, double) {
                    return std::floor(x / 2);
                })).are_labels());
}

// A field of amplitude a and width w has slopes up to .6 a / w: 1 between samples at most.
TEST(Labels, AreNoSmoothFieldsThatWereRounded) {
    for (const auto& [amplitude, width] : {std::pair(5, 5), {8, 6}, {10, 6}}) {
        const Volume bump = around_middle(
            [&, a = amplitude, w = width](double r) { return a * std::exp(-r * r / (2 * w * w)); });
        const LabelSigns signs = label_signs(bump);
        EXPECT_EQ(signs.verdict, Verdict::smooth) << amplitude << " " << width;
        EXPECT_GE(signs.equal, .95);
        EXPECT_GT(signs.by_one, .99);
    }
    // The equal layers of a ramp are 40 samples thick.
    EXPECT_EQ(label_signs(test::volume_of<std::int16_t>(
                              test::grid_of({400, 4, 4}, Centering::cell),
                              [](double x, double, double) { return std::floor(x / 40); }))
                  .verdict,
              Verdict::smooth);
}

// A ball whose edge is blurred over few samples has values that lie nowhere side by side.
TEST(Labels, AreNoPhantomsWithBlurredEdges) {
    for (const double width : {.5, .7, 1.}) {
        const Volume ball =
            around_middle([&](double r) { return 50 - 50 * std::tanh((r - 9) / width); });
        const LabelSigns signs = label_signs(ball);
        EXPECT_EQ(signs.verdict, Verdict::none) << width;
        EXPECT_GE(signs.equal, .95) << width;
    }
}

// Neighbouring regions have neighbouring numbers: twelve sectors of a ball, numbered around it, in
// an atlas with nothing around; and shells in one another, which are few.
TEST(Labels, WithNeighboursInNumberAreLabels) {
    const Volume sectors = test::volume_of<std::uint8_t>(
        test::grid_of({64, 64, 64}, Centering::cell), [](double x, double y, double z) {
            x -= 31.3;
            y -= 31.3;
            const double turn = std::atan2(y, x) / 6.2831853 + .5;
            return std::hypot(x, y, z - 31.3) < 14 ? 1 + std::min(std::floor(12 * turn), 11.) : 0;
        });
    EXPECT_TRUE(label_signs(sectors).are_labels());
    EXPECT_LT(label_signs(sectors).by_one, .6);
    EXPECT_TRUE(label_signs(around_middle([](double r) {
                    return r < 4 ? 3 : r < 8 ? 2 : r < 13 ? 1 : 0;
                })).are_labels());
}

// A crop full of regions of 8 samples along each edge, which touch: 20^3 of 24^3 samples have six
// equal neighbours.
TEST(Labels, InSmallCropsAreScattered) {
    const auto crop = [](int width) {
        return label_signs(test::volume_of<std::uint16_t>(
            test::grid_of({24, 24, 24}, Centering::cell), [&](double x, double y, double z) {
                const auto at = [&](double place) { return std::floor(place / width); };
                return std::fmod(1 + at(x) * 37 + at(y) * 59 + at(z) * 83, 251);
            }));
    };
    EXPECT_EQ(crop(8).verdict, Verdict::scattered);
    EXPECT_DOUBLE_EQ(crop(8).equal, std::pow(20. / 24, 3));
    EXPECT_EQ(crop(2).verdict, Verdict::none);  // only at the corners
}

// Cubes of `width` samples in zeros, of which (width^3 - (width - 2)^3 + 6 width^2) / 40^3 differ
// from a neighbour: 7.1 and 15.4 %.
TEST(Labels, InLargeVolumesAreScatteredIfNearlyAllAreEqual) {
    const auto verdict = [](std::int64_t width) {
        const auto in = [&](double at) { return std::fmod(at, 40) < static_cast<double>(width); };
        return label_signs(
                   test::volume_of<std::uint8_t>(
                       test::grid_of({160, 160, 120}, Centering::cell),
                       [&](double x, double y, double z) { return in(x) && in(y) && in(z); }))
            .verdict;
    };
    EXPECT_EQ(verdict(20), Verdict::scattered);
    EXPECT_EQ(verdict(29), Verdict::none);
}

TEST(Labels, AreAtLeastTwoValuesWithNeighboursOfTheirOwn) {
    EXPECT_FALSE(label_signs(cube<std::uint8_t>(0, seven)).are_labels());
    EXPECT_FALSE(label_signs(cube<std::uint8_t>(1, seven)).are_labels());
    EXPECT_TRUE(label_signs(cube<std::uint8_t>(2, seven)).are_labels());
    EXPECT_TRUE(label_signs(cube<std::int16_t>(9, seven)).are_labels());
}

TEST(Labels, AreWholeNumbersOfAnyType) {
    EXPECT_TRUE(signs_of_floats(seven).are_labels());
    EXPECT_FALSE(signs_of_floats([](double, double, double) { return 7.5; }).are_labels());
    EXPECT_FALSE(signs_of_floats([](double, double, double) { return NAN; }).are_labels());
    EXPECT_FALSE(signs_of_floats([](double, double, double) { return 0x1p60; }).are_labels());
    const std::vector<std::uint64_t> row{1, 1, 1, ~std::uint64_t{}, ~std::uint64_t{}};
    std::vector<std::uint64_t> wide;
    for (const std::uint64_t value : row) wide.insert(wide.end(), 100, value);
    EXPECT_TRUE(label_signs({500, 1, 1}, ValueType::uint64, wide.data()).are_labels());
    // Volumes of float are not measured: those in memory become whole numbers when they are read.
    EXPECT_FALSE(label_signs(cube<float>(10, seven)).are_labels());
}

// 2^24 + 2^18 samples: 64 of 260 slices are measured, of a volume in files the same.
TEST(Labels, OfLargeVolumesAreKnownBySomeSlices) {
    const Grid grid = test::grid_of({256, 256, 260}, Centering::cell);
    const auto samples =
        std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(grid.sample_count()));
    for (std::size_t i = samples->size() / 2; i < samples->size(); ++i) (*samples)[i] = 3;
    const Volume volume(grid, SampleType::uint8,
                        std::shared_ptr<const void>(samples, samples->data()));
    const LabelSigns signs = label_signs(volume);
    ASSERT_TRUE(signs.are_labels());
    // The two slices where labels meet differ; at most one of two neighbours is measured.
    EXPECT_NEAR(signs.equal, 1 - .5 / 64, .5 / 64);
    auto source = std::make_unique<test::SourceInMemory>(volume);
    const test::SourceInMemory& read = *source;
    const Volume stored(
        grid, SampleType::uint8,
        std::make_shared<const VolumeStore>(grid, SampleType::uint8, std::move(source)));
    EXPECT_EQ(label_signs(stored).equal, signs.equal);
    // Three times, with a slice on each side: 64 of 260 slices.
    EXPECT_LE(read.samples_read, 3 * 3 * 64 * 256 * 256);
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
