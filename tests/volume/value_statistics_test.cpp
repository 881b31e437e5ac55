// SPDX-License-Identifier: Apache-2.0
#include "volume/value_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "support/volume_of.h"

namespace lamina {
namespace {

using test::grid_of;
using test::volume_of;

// Returns a percentile by its definition: the smallest value that at least this share of the values
// does not exceed.
double percentile_of(const std::vector<double>& sorted, int thousandths) {
    std::size_t rank = 1;
    while (1000 * rank < static_cast<std::size_t>(thousandths) * sorted.size()) ++rank;
    return sorted[rank - 1];
}

std::vector<double> sorted_finite(const Volume& volume) {
    std::vector<double> values;
    volume.visit([&](const auto* samples) {
        for (std::int64_t i = 0; i < volume.grid().sample_count(); ++i) {
            const auto value = static_cast<double>(samples[i]);
            if (std::isfinite(value)) values.push_back(value);
        }
    });
    std::sort(values.begin(), values.end());
    return values;
}

// Checks that the intervals cover all values, and that each count is that of its values.
void expect_counts(const Histogram& histogram, const std::vector<double>& values) {
    ASSERT_EQ(histogram.edges.size(), histogram.counts.size() + 1);
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        const bool last = i + 1 == histogram.counts.size();
        const double lo = histogram.edges[i], hi = histogram.edges[i + 1];
        const auto inside = std::count_if(values.begin(), values.end(), [&](double value) {
            return lo <= value && (value < hi || (last && value == hi));
        });
        ASSERT_EQ(histogram.counts[i], inside) << i;
    }
    EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::int64_t{0}),
              static_cast<std::int64_t>(values.size()));
}

ValueStatistics measured(const Volume& volume) {
    return measure_values(VolumeData(volume));
}

TEST(ValueStatistics, WholeNumbersAreExact) {
    std::mt19937 random(27);
    std::normal_distribution<double> spread(-200, 3000);
    const auto draw = [&](double, double, double) {
        return std::clamp(spread(random), -32768.0, 32767.0);
    };
    const Volume shorts = volume_of<std::int16_t>(grid_of({37, 29, 31}, Centering::node), draw);
    const Volume bytes = test::noise(grid_of({7, 11, 13}, Centering::node), 3);
    const Volume few = volume_of<std::uint16_t>(grid_of({3, 1, 1}, Centering::node),
                                                [](double i, double, double) { return 65533 + i; });
    for (const Volume& volume : {shorts, bytes, few}) {
        const std::vector<double> values = sorted_finite(volume);
        const ValueStatistics found = measured(volume);
        EXPECT_EQ(found.count, static_cast<std::int64_t>(values.size()));
        for (std::size_t i = 0; i < ValueStatistics::places.size(); ++i)
            EXPECT_EQ(found.percentiles[i], percentile_of(values, ValueStatistics::places[i])) << i;
        expect_counts(found.histogram, values);
        EXPECT_EQ(found.histogram.edges.front(), values.front());
        // All intervals hold equally many whole numbers.
        const double width = found.histogram.edges[1] - found.histogram.edges[0];
        EXPECT_EQ(width, std::ceil((values.back() - values.front() + 1) / 256));
        EXPECT_EQ(width, std::floor(width));
    }
    EXPECT_EQ(measured(few).histogram.edges, (std::vector<double>{65533, 65534, 65535, 65536}));
}

void expect_exact(const Volume& volume) {
    const std::vector<double> values = sorted_finite(volume);
    const ValueStatistics found = measured(volume);
    for (std::size_t i = 0; i < ValueStatistics::places.size(); ++i)
        EXPECT_EQ(found.percentiles[i], percentile_of(values, ValueStatistics::places[i])) << i;
    expect_counts(found.histogram, values);
}

TEST(ValueStatistics, FloatsAreExact) {
    std::mt19937 random(28);
    std::uniform_real_distribution<double> exponent(-40, 40), sign(-1, 2), share(0, 1);
    const Grid grid = grid_of({41, 23, 19}, Centering::node);
    expect_exact(volume_of<float>(grid, [&](double i, double, double) -> double {
        if (i == 5) return std::numeric_limits<double>::quiet_NaN();
        if (i == 6) return std::numeric_limits<double>::infinity();
        return std::copysign(std::exp2(exponent(random)), sign(random));
    }));
    // Values vary little but lie far from zero, so that all share their leading bits.
    expect_exact(
        volume_of<float>(grid, [&](double, double, double) { return 1e6 + 4 * share(random); }));
    expect_exact(volume_of<float>(
        grid, [&](double, double, double) { return -1e-3 * (1 + 1e-3 * share(random)); }));
    expect_exact(volume_of<float>(
        grid, [&](double, double, double) { return static_cast<double>(random() % 8193) - 4096; }));
}

TEST(ValueStatistics, AreDefinedForOneValueAndForNone) {
    const Grid grid = grid_of({4, 4, 4}, Centering::node);
    const ValueStatistics same =
        measured(volume_of<float>(grid, [](double, double, double) { return 0.1; }));
    const double value = static_cast<double>(0.1F);  // the value of every percentile
    for (const double percentile : same.percentiles) EXPECT_EQ(percentile, value);
    EXPECT_EQ(same.histogram.edges, (std::vector<double>{value, value}));
    EXPECT_EQ(same.histogram.counts, std::vector<std::int64_t>{64});
    const ValueStatistics none =
        measured(volume_of<float>(grid, [](double, double, double) { return NAN; }));
    EXPECT_EQ(none.count, 0);
    EXPECT_TRUE(none.percentiles.empty());
    EXPECT_TRUE(none.histogram.empty());
}

TEST(ValueStatistics, PointsOfMeshesAreExact) {
    std::mt19937_64 random(30);
    std::normal_distribution<double> spread(1, 1e-9);
    std::vector<double> points(5000);
    for (double& point : points) point = spread(random);
    points[17] = NAN;
    points[18] = -INFINITY;
    std::vector<double> values;
    for (const double point : points) {
        if (std::isfinite(point)) values.push_back(point);
    }
    std::sort(values.begin(), values.end());
    const ValueStatistics found = measure_values(points);
    EXPECT_EQ(found.count, 4998);
    for (std::size_t i = 0; i < ValueStatistics::places.size(); ++i)
        EXPECT_EQ(found.percentiles[i], percentile_of(values, ValueStatistics::places[i])) << i;
    expect_counts(found.histogram, values);
    // One range overflows; one has only denormal numbers.
    for (const double reach : {std::numeric_limits<double>::max(), 5e-324}) {
        const std::vector<double> wide{-reach, -reach / 2, 0, reach / 2, reach};
        expect_counts(measure_values(wide).histogram, wide);
    }
}

// The percentile of 1 in 1000 among 1000 values is the first of them. Large counts do not overflow.
TEST(ValueStatistics, RanksAreExact) {
    EXPECT_EQ(ValueStatistics::rank(1, 1000), 1);
    EXPECT_EQ(ValueStatistics::rank(1, 1001), 2);
    EXPECT_EQ(ValueStatistics::rank(999, 1000), 999);
    EXPECT_EQ(ValueStatistics::rank(500, 1), 1);
    constexpr std::int64_t many = std::int64_t{1} << 60;
    EXPECT_EQ(ValueStatistics::rank(500, many), many / 2);
}

// Bars have heights proportional to the logarithm of 1 + count.
TEST(HistogramPicture, BarsAreLogarithmsOfCounts) {
    std::vector<double> values(15, 0.0);  // log 16
    values.insert(values.end(), 3, 1.0);  // log 4
    const CodedImage image = histogram_picture(measure_values(values), 528);
    const auto bar_height = [&](int column) {
        int high = 0;
        for (int row = 0; row < image.height; ++row) {
            const auto at = static_cast<std::size_t>(3 * (row * image.width + column));
            high += image.codes[at] == 70 && image.codes[at + 2] == 160;
        }
        return high;
    };
    // The bars take 512 pixels from column 8 on, two each. The first column of a bar may carry a
    // mark.
    EXPECT_EQ(bar_height(9), 160);
    EXPECT_EQ(bar_height(8 + 510), 80);
    EXPECT_EQ(bar_height(8 + 255), 0);
    EXPECT_GT(histogram_picture({}, 300).height, 0);
}

}  // namespace
}  // namespace lamina
