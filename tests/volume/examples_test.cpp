// SPDX-License-Identifier: Apache-2.0
// The data of `lamina example` that are volumes.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

#include "support/samples_of.h"
#include "volume/examples.h"

namespace lamina {
namespace {

using testing::samples_of;

std::uint32_t crc_of(const void* bytes, std::size_t count) {
    return static_cast<std::uint32_t>(
        crc32(0, static_cast<const Bytef*>(bytes), static_cast<uInt>(count)));
}

// The head, made once for all tests.
struct MadeHead {
    Volume ct = head_ct();
    Volume map = head_labels();
    std::vector<std::int16_t> hu = samples_of<std::int16_t>(ct);
    std::vector<std::uint8_t> tissue = samples_of<std::uint8_t>(map);

    glm::dvec3 place(std::size_t i) const {
        const auto at = static_cast<std::int64_t>(i);
        const auto& size = ct.grid().size;
        return ct.grid().to_world({at % size[0], at / size[0] % size[1], at / size[0] / size[1]});
    }
    double share(int least, int most) const {
        std::size_t count = 0;
        for (const std::int16_t value : hu) count += value >= least && value <= most;
        return static_cast<double>(count) / static_cast<double>(hu.size());
    }
};

const MadeHead& made_head() {
    static const MadeHead head;
    return head;
}

TEST(HeadExample, IsASmallCtInAPatientsAxes) {
    const Grid& grid = made_head().ct.grid();
    EXPECT_EQ(grid.axes, WorldAxes::left_posterior_superior);
    EXPECT_EQ(grid.unit, "mm");
    EXPECT_EQ(grid.step[2], glm::dvec3(0, 0, 1.5));
    EXPECT_LE(made_head().ct.byte_count(), 8'000'000u);
    EXPECT_EQ(made_head().map.grid().size, grid.size);
}

// Shares are those of a head that fills a third of its box: air around it, a thin layer of fat,
// tissues of water, and bone, as tables of Hounsfield units have them.
TEST(HeadExample, HasTheHumpsOfACt) {
    const MadeHead& head = made_head();
    EXPECT_GT(head.share(-1024, -940), 0.5);
    EXPECT_GT(head.share(-150, -50), 0.01);
    EXPECT_GT(head.share(0, 80), 0.15);
    EXPECT_GT(head.share(300, 1500), 0.02);
    EXPECT_GT(head.share(2000, 2500), 1e-4);
    EXPECT_LT(head.share(-800, -200), 0.05);  // nothing but what the scanner blends at borders
    EXPECT_EQ(head.share(-32768, -1025), 0);
}

TEST(HeadExample, LooksAlongTheFrontOfThePatientAndStandsUpright) {
    const MadeHead& head = made_head();
    glm::dvec3 front(0), left(0), top(0);
    for (std::size_t i = 0; i < head.hu.size(); ++i) {
        if (head.hu[i] < -300) continue;
        const glm::dvec3 p = head.place(i);
        if (p.y < front.y) front = p;
        if (p.x > left.x) left = p;
        if (p.z > top.z) top = p;
    }
    EXPECT_LT(std::abs(front.x), 10) << "the tip of the nose";
    EXPECT_LT(front.z, 0);
    EXPECT_GT(front.z, -50);
    EXPECT_LT(std::abs(left.z), 35) << "an ear";
    EXPECT_GT(left.x, 80);
    EXPECT_GT(top.z, 105) << "the top of the head";
    EXPECT_LT(top.z, 118);
}

TEST(HeadExample, HasTheSameBonesLeftAndRight) {
    const MadeHead& head = made_head();
    const std::int64_t width = head.map.grid().size[0];
    std::set<int> bones;
    for (const Label& label : head.map.labels()->list)
        if (label.name == "skull" || label.name == "jaw" || label.name == "teeth")
            bones.insert(static_cast<int>(label.code));
    ASSERT_EQ(bones.size(), 3u);
    for (std::size_t i = 0; i < head.tissue.size(); ++i) {
        const auto x = static_cast<std::int64_t>(i) % width;
        const std::size_t mirrored = i + static_cast<std::size_t>(width - 1 - 2 * x);
        if (!bones.contains(head.tissue[i])) continue;
        ASSERT_EQ(head.tissue[i], head.tissue[mirrored]) << i;
    }
}

TEST(HeadExample, HasLabelsThatAgreeWithTheCt) {
    const MadeHead& head = made_head();
    std::map<int, std::pair<double, double>> sums;  // of values, and their number
    for (std::size_t i = 0; i < head.tissue.size(); ++i) {
        sums[head.tissue[i]].first += head.hu[i];
        sums[head.tissue[i]].second += 1;
    }
    std::map<std::string, double> mean;
    for (const Label& label : head.map.labels()->list) {
        const auto [sum, count] = sums[static_cast<int>(label.code)];
        ASSERT_GT(count, 500) << label.name;
        mean[label.name] = sum / count;
    }
    EXPECT_EQ(mean.size(), head.map.labels()->list.size());  // no name twice
    EXPECT_EQ(sums.size(), head.map.labels()->list.size() + 1);
    EXPECT_GT(mean["teeth"], 1300);
    for (const char* const bone : {"skull", "jaw", "spine"}) {
        EXPECT_GT(mean[bone], 350) << bone;
        EXPECT_LT(mean[bone], 1150) << bone;
    }
    EXPECT_GT(mean["cerebrum"], mean["ventricles"]);
    EXPECT_NEAR(mean["cerebrum"], 33, 12);
}

double jet_at(const std::vector<std::uint8_t>& samples, std::int64_t x, std::int64_t y,
              std::int64_t z, std::int64_t time) {
    const auto size = jet_grid().size;
    return samples[static_cast<std::size_t>(((time * size[2] + z) * size[1] + y) * size[0] + x)];
}

TEST(JetExample, WidensAndThinsOnItsWayUp) {
    const std::vector<std::uint8_t> samples = jet_samples();
    const auto size = jet_grid().size;
    ASSERT_EQ(samples.size(), static_cast<std::size_t>(jet_grid().sample_count() * jet_times));
    const auto slice = [&](std::int64_t z) {
        double reached = 0, largest = 0;
        for (std::int64_t time = 0; time < jet_times; ++time)
            for (std::int64_t y = 0; y < size[1]; ++y)
                for (std::int64_t x = 0; x < size[0]; ++x) {
                    const double value = jet_at(samples, x, y, z, time);
                    reached += value > 25;
                    largest = std::max(largest, value);
                }
        return std::pair(reached / static_cast<double>(jet_times), largest);
    };
    EXPECT_EQ(slice(0).second, 255);
    EXPECT_LT(slice(0).first, 0.02 * static_cast<double>(size[0] * size[1]));
    EXPECT_GT(slice(64).first, 4 * slice(0).first);
    EXPECT_GT(slice(120).first, 2 * slice(64).first);
    EXPECT_LT(slice(120).second, 200);
}

TEST(JetExample, CarriesItsEddiesUpwards) {
    const std::vector<std::uint8_t> samples = jet_samples();
    const auto size = jet_grid().size;
    constexpr std::int64_t shift = 4;  // slices
    double with_the_flow = 0, against_it = 0;
    for (std::int64_t time = 1; time < jet_times; ++time)
        for (std::int64_t z = 50; z < 110; ++z)
            for (std::int64_t y = 0; y < size[1]; ++y)
                for (std::int64_t x = 0; x < size[0]; ++x) {
                    const double now = jet_at(samples, x, y, z, time);
                    with_the_flow += std::abs(now - jet_at(samples, x, y, z - shift, time - 1));
                    against_it += std::abs(now - jet_at(samples, x, y, z + shift, time - 1));
                }
    EXPECT_LT(with_the_flow, 0.9 * against_it);
}

// Counts connected sets of samples above a value, by their six neighbours.
std::size_t blobs_above(const Volume& volume, int value, std::size_t smallest) {
    auto samples = samples_of<std::uint8_t>(volume);
    const auto& size = volume.grid().size;
    const std::int64_t steps[] = {1, -1, size[0], -size[0], size[0] * size[1], -size[0] * size[1]};
    std::size_t blobs = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i] <= value) continue;
        std::size_t count = 0;
        std::vector<std::size_t> open{i};
        samples[i] = 0;
        while (!open.empty()) {
            const std::size_t at = open.back();
            open.pop_back();
            ++count;
            for (const std::int64_t step : steps) {
                const auto next = static_cast<std::size_t>(static_cast<std::int64_t>(at) + step);
                if (next >= samples.size() || samples[next] <= value) continue;
                samples[next] = 0;
                open.push_back(next);
            }
        }
        blobs += count >= smallest;
    }
    return blobs;
}

TEST(CellsExample, HasNucleiThatStandApart) {
    const Volume cells = cells_volume();
    EXPECT_EQ(cells.grid().unit, "um");
    // A nucleus has some 4/3 pi 2.5^2 3.2 um^3, which are 1500 samples.
    const std::size_t nuclei = blobs_above(cells, 90, 300);
    EXPECT_GT(nuclei, 12u);
    EXPECT_LT(nuclei, 60u);
}

// A change of these sums means that users' example data change: say so in the changelog.
TEST(Examples, HaveTheSameSamplesOnEveryMachine) {
    const MadeHead& head = made_head();
    EXPECT_EQ(crc_of(head.ct.data(), head.ct.byte_count()), 1478685301u);
    EXPECT_EQ(crc_of(head.map.data(), head.map.byte_count()), 2554187023u);
    const std::vector<std::uint8_t> jet = jet_samples();
    EXPECT_EQ(crc_of(jet.data(), jet.size()), 2621076253u);
    const Volume cells = cells_volume();
    EXPECT_EQ(crc_of(cells.data(), cells.byte_count()), 737594374u);
}

}  // namespace
}  // namespace lamina
