// SPDX-License-Identifier: Apache-2.0
#include "reference/mesh_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "support/each_instruction_set.h"
#include "support/split_box.h"

namespace lamina {
namespace {

double value_at(const glm::dvec3& p) {
    return 3 * p.x - 2 * p.y + p.z;
}

struct TestLine {
    glm::dvec3 origin, direction;
};

struct PassedTet {
    std::int32_t tet;
    double from, to, front, back, least, most;
    std::array<std::int32_t, 3> corners;  // of the face by which the line leaves
    std::array<double, 3> weights;
    bool operator==(const PassedTet&) const = default;
};
using Passage = std::vector<PassedTet>;

PassedTet passed(const TetSegment& segment, const TetMesh& mesh, std::span<const double> values) {
    PassedTet result{segment.tet,
                     segment.in.at,
                     segment.out.at,
                     segment.in.interpolate(values),
                     segment.out.interpolate(values),
                     INFINITY,
                     -INFINITY,
                     segment.out.corners,
                     segment.out.weights};
    for (const std::int32_t corner : mesh.tets()[static_cast<std::size_t>(segment.tet)]) {
        const double value = values[static_cast<std::size_t>(corner)];
        result.least = std::min(result.least, value);
        result.most = std::max(result.most, value);
    }
    return result;
}

std::vector<Passage> walk_alone(const TetMesh& mesh, const FaceTree& tree,
                                const std::vector<TestLine>& lines,
                                std::span<const double> values) {
    RayWalk walk(mesh, tree);
    std::vector<Passage> passages;
    for (const TestLine& line : lines) {
        Passage passage;
        walk.aim(line.origin, line.direction);
        for (const RayWalk::Entry& entry : walk.entries()) {
            walk.follow(entry, [&](const TetSegment& segment) {
                passage.push_back(passed(segment, mesh, values));
                return true;
            });
        }
        passages.push_back(passage);
    }
    return passages;
}

struct Together {
    std::vector<Passage> passages;
    std::size_t steps = 0, in_vectors = 0;
};

// Walks lines in packets. Each line begins in the lane of one that has ended, so lanes are never in
// step.
Together walk_together(const TetMesh& mesh, const FaceTree& tree,
                       const std::vector<TestLine>& lines, std::span<const double> values) {
    PacketWalk walk(mesh, tree, values);
    Together result{std::vector<Passage>(lines.size())};
    std::array<std::size_t, PacketWalk::width> line{}, entry{};
    std::size_t begun = 0;
    const auto go_on = [&](std::size_t lane) {
        while (true) {
            const auto entries = walk.ray(lane).entries();
            if (entry[lane] < entries.size()) return walk.enter(lane, entries[entry[lane]++]);
            if (begun == lines.size()) return;
            line[lane] = begun++;
            entry[lane] = 0;
            walk.ray(lane).aim(lines[line[lane]].origin, lines[line[lane]].direction);
        }
    };
    for (std::size_t lane = 0; lane < PacketWalk::width; ++lane) go_on(lane);
    while (walk.walking() != 0) {
        const std::uint32_t walked = walk.walking();
        walk.step();
        for_each_lane(walked, [&](std::size_t lane) {
            const WalkLanes& lanes = walk.lanes();
            const TetSegment segment = walk.segment(lane);
            EXPECT_EQ(segment.tet, walk.tet(lane));
            EXPECT_EQ(segment.in.at, lanes.in().at[lane]);
            ++result.steps;
            result.in_vectors += lanes.settled[lane] != 0;
            result.passages[line[lane]].push_back(
                {segment.tet, lanes.in().at[lane], lanes.out().at[lane], lanes.in().value[lane],
                 lanes.out().value[lane], lanes.least[lane], lanes.most[lane], segment.out.corners,
                 segment.out.weights});
        });
        for_each_lane(walked & ~walk.walking(), go_on);
    }
    return result;
}

// Expects the tets and crossings of single lines. least_in_vectors, most_in_vectors: the share of
// steps that vectors decide, if they are as accurate as a single line: SSE4 has no fused
// multiplication and addition.
void expect_same(const MeshData& data, const std::vector<TestLine>& lines, double least_in_vectors,
                 double most_in_vectors) {
    const TetMesh mesh(data, "mesh");
    const FaceTree tree(mesh, mesh.open_faces());
    const auto& values = mesh.point_scalars()[0].values;
    const std::vector<Passage> alone = walk_alone(mesh, tree, lines, values);
    test::for_each_instruction_set([&](const std::string& name) {
        const Together together = walk_together(mesh, tree, lines, values);
        for (std::size_t i = 0; i < lines.size(); ++i)
            ASSERT_EQ(together.passages[i], alone[i]) << name << ", line " << i;
        ASSERT_GT(together.steps, 1000u);
        const double share =
            static_cast<double>(together.in_vectors) / static_cast<double>(together.steps);
        EXPECT_LE(share, most_in_vectors) << name;
        EXPECT_GE(share, name == "SSE4" ? 0 : least_in_vectors) << name;
    });
}

TEST(PacketWalk, PassesTheTetsOfSingleLines) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto point = [&](double least, double most) {
        return glm::dvec3(uniform(random), uniform(random), uniform(random)) * (most - least) +
               least;
    };
    std::vector<TestLine> lines;
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 origin = point(-3, 4);
        lines.push_back({origin, point(-.2, 1.2) - origin});
    }
    for (const double least : {.1, 1e-6})
        expect_same(test::split_box(3, 3000, least, value_at), lines, .9, 1);
}

// These lines meet edges and points exactly, so floats decide none of the steps.
TEST(PacketWalk, LeavesTiesToSingleLines) {
    std::vector<TestLine> lines;
    for (const glm::dvec3& direction :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 1), glm::dvec3(1, 1, 1), glm::dvec3(-1, 0, 2)}) {
        for (int x = 0; x <= 4; ++x)
            for (int y = 0; y <= 4; ++y)
                for (int z = 0; z <= 4; ++z)
                    lines.push_back({glm::dvec3(x, y, z) - 8.0 * direction, direction});
    }
    expect_same(test::kuhn_box({4, 4, 4}, value_at), lines, 0, 0);
}

}  // namespace
}  // namespace lamina
