// SPDX-License-Identifier: Apache-2.0
#include "selftest/shader_probe.h"

#include <gtest/gtest.h>

#include <array>

#include "gl/gl_fixture.h"

namespace lamina::selftest {
namespace {

using Probe = gl::EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, Probe, gl::both_contexts, gl::context_name);

// A cell's corners: the lower ones in x, then the upper ones, each y fastest.
using CellCorners = std::array<int, 8>;

double trilinear(const CellCorners& corners, const std::array<double, 3>& place) {
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const double x = i & 4 ? place[0] : 1 - place[0];
        const double y = i & 1 ? place[1] : 1 - place[1];
        const double z = i & 2 ? place[2] : 1 - place[2];
        sum += x * y * z * corners[static_cast<std::size_t>(i)];
    }
    return sum;
}

// The kernel of shaders/study/probe.glsl in double, with the scalar itself in place of its cubic.
double expected_arithmetic(int x, int y) {
    std::array<double, 3> end{};
    const std::array<int, 3> quarters{x & 3, y & 3, (x ^ y) & 3};
    for (std::size_t a = 0; a < 3; ++a) end[a] = 0.5 + 0.125 * quarters[a];
    CellCorners corners{x & 15,        y & 15,        (x >> 2) & 15, (y >> 2) & 15,
                        (y >> 1) & 15, (x >> 1) & 15, (y >> 3) & 15, (x >> 3) & 15};
    double sum = 0;
    for (int i = 0; i < ShaderProbe::rounds; ++i) {
        sum += trilinear(corners, end);
        const CellCorners& c = corners;
        corners = {15 - c[4], 15 - c[5], 15 - c[6], 15 - c[7], c[1], c[2], c[3], c[0]};
    }
    return sum;
}

double expected_fetches(int x, int y, int width, int height) {
    double sum = 0;
    for (int i = 0; i < ShaderProbe::rounds; ++i) {
        const int cell[3] = {(x * ShaderProbe::pixel_step(width) + 704 * i) / 4096,
                             (y * ShaderProbe::pixel_step(height) + 448 * i) / 4096,
                             4080 * i / 4096};
        for (int corner = 0; corner < 8; ++corner) {
            const int place[3] = {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
                                  cell[2] + (corner >> 2)};
            EXPECT_LT(std::max({place[0], place[1], place[2]}), ShaderProbe::edge);
            sum += ShaderProbe::sample(
                (place[2] * ShaderProbe::edge + place[1]) * ShaderProbe::edge + place[0]);
        }
    }
    return sum;
}

// Values are exact by the choice of the kernel's numbers, so every way must give all their bits.
TEST_P(Probe, EveryWayGivesTheSameValues) {
    constexpr int width = 37, height = 21;  // no multiples of tiles and workgroups
    ShaderProbe probe(width, height);
    for (const ProbeWay& way : probe_ways()) {
        const ProbeResult result = probe.run(way, 1);
        EXPECT_GT(result.wall_ms, 0);
        int wrong = 0;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double expected = way.kernel == ProbeKernel::arithmetic
                                            ? expected_arithmetic(x, y)
                                            : expected_fetches(x, y, width, height);
                if (result.values[static_cast<std::size_t>(y * width + x)] != expected) ++wrong;
            }
        }
        EXPECT_EQ(wrong, 0) << name_of(way.kernel) << ", workgroups of " << way.group
                            << (way.morton ? ", morton" : "");
    }
}

TEST_P(Probe, ReportsEveryWayWithTheTimesOfBothClocks) {
    const nlohmann::ordered_json probe = probe_json(16, 16);
    ASSERT_EQ(probe["ways"].size(), probe_ways().size());
    for (const auto& way : probe["ways"]) {
        EXPECT_TRUE(way["same_values"]) << way;
        if (way["shader"] == "fragment") {
            EXPECT_EQ(way["times_as_fast"], 1.0) << way;
        }
        // The GPU works while the host waits; their clocks tick alike.
        if (!way["opengl_ms"].is_null()) {
            EXPECT_LE(way["opengl_ms"], 1.01 * way["wall_ms"].get<double>()) << way;
        }
    }
    const std::string table = probe_table(probe);
    EXPECT_EQ(std::ranges::count(table, '\n'), 1 + static_cast<int>(probe["ways"].size()));
}

}  // namespace
}  // namespace lamina::selftest
