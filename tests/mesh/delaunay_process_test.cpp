// SPDX-License-Identifier: Apache-2.0
#include "mesh/delaunay_process.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

const std::vector<glm::dvec3> tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// A program that says and does what a test wants.
std::filesystem::path script(const TemporaryFolder& folder, const std::string& commands) {
    const std::filesystem::path path = folder / "lamina-tetrahedralize";
    write_bytes_to(path, "#!/bin/sh\n" + commands);
    chmod(path.c_str(), 0755);
    return path;
}

TEST(DelaunayProcess, FailuresOfTheProgramAreClear) {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& commands) {
        return error_of([&] { delaunay_by_process(script(folder, commands), tetrahedron); });
    };
    const auto has = [](const std::string& message, const std::string& part) {
        EXPECT_EQ(message.find('\n'), std::string::npos);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    has(run("echo chatter >&2; echo 'tetgen: out of luck' >&2; exit 1"),
        "out of luck (exit code 1)");
    has(run("exit 3"), "exit code 3");
    has(run("kill -SEGV $$"), "ended by signal 11");
    has(run("exit 0"), "gave no answer");
    has(run("printf 12345678"), "promised");  // a count beyond all memory
    has(run("head -c 40 /dev/zero"), "promised 0 tets");
    // One tet, corner 4 of four points.
    has(run("printf '\\001\\0\\0\\0\\0\\0\\0\\0'; printf '\\004\\0\\0\\0'; head -c 28 /dev/zero"),
        "index 4 is out of range");
    expect_error([&] { delaunay_by_process(folder / "absent", tetrahedron); },
                 {"absent", "cannot be started"});
}

TEST(DelaunayProcess, IsFoundInThePath) {
    const TemporaryFolder folder;
    const std::string path = getenv("PATH");
    setenv("PATH", folder.path().c_str(), 1);
    EXPECT_EQ(find_tetrahedralizer(), std::nullopt);
    expect_error([] { require_tetrahedralizer(); },
                 {"lamina-tetrahedralize", "LAMINA_WITH_TETGEN", "--kuhn"});
    write_bytes_to(folder / "lamina-tetrahedralize", "no program");
    EXPECT_EQ(find_tetrahedralizer(), std::nullopt);
    script(folder, "exit 0");
    EXPECT_EQ(find_tetrahedralizer(), folder / "lamina-tetrahedralize");
    setenv("PATH", path.c_str(), 1);
}

class Tetrahedralize : public testing::Test {
  protected:
    void SetUp() override {
        if (std::string(LAMINA_TETRAHEDRALIZE_BINARY).empty()) {
            GTEST_SKIP() << "built without TetGen";
        }
    }
    static DelaunayTets run(const std::vector<glm::dvec3>& points) {
        return delaunay_by_process(LAMINA_TETRAHEDRALIZE_BINARY, points);
    }
};

TEST_F(Tetrahedralize, OneTetIsPositive) {
    const DelaunayTets mesh = run(tetrahedron);
    ASSERT_EQ(mesh.tets.size(), 1u);
    Tet sorted = mesh.tets[0];
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, (Tet{0, 1, 2, 3}));
    EXPECT_EQ(mesh.neighbors[0], (std::array<std::int32_t, 4>{-1, -1, -1, -1}));
}

// Cospherical, on planes and lines, in numbers: what lattices are.
TEST_F(Tetrahedralize, LatticesGiveNoFlatTets) {
    std::vector<glm::dvec3> points;
    std::mt19937 random(1);
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j)
            for (int k = 0; k < 9; ++k)
                if ((i % 8 == 0 && j % 8 == 0 && k % 8 == 0) || random() % 2 == 0)
                    points.emplace_back(i, j, k);
    const DelaunayTets mesh = run(points);
    double volume = 0;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const auto at = [&](std::size_t i) { return points[mesh.tets[t][i]]; };
        const double part = glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0));
        EXPECT_GE(part, 1);  // a determinant of whole numbers
        volume += part / 6;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::int32_t neighbor = mesh.neighbors[t][i];
            if (neighbor < 0) continue;
            // The neighbour has all corners but the one that it lies opposite of.
            int shared = 0;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                const auto& other = mesh.tets[neighbor];
                const bool in = std::count(other.begin(), other.end(), mesh.tets[t][corner]) > 0;
                EXPECT_EQ(in, corner != i);
                shared += in ? 1 : 0;
            }
            EXPECT_EQ(shared, 3);
        }
    }
    EXPECT_NEAR(volume, 512, 1e-9);
}

TEST_F(Tetrahedralize, WhatHasNoVolumeIsAnError) {
    std::vector<glm::dvec3> plane, oblique;
    for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 5; ++j) {
            plane.emplace_back(i, 2, j);
            oblique.emplace_back(i, j, i + j);
        }
    }
    expect_error([&] { run(plane); }, {"25 points", "one plane"});
    expect_error([&] { run(oblique); }, {"25 points"});  // TetGen crashes: seen from outside
    expect_error([&] { run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}); }, {"3 points", "expected 4"});
    expect_error([&] { run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}); }, {"finite"});
}

}  // namespace
}  // namespace lamina
