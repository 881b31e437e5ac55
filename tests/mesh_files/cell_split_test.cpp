// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/cell_cuts.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace lamina {
namespace {

constexpr std::int64_t voxel = 11, hexahedron = 12, wedge = 13, pyramid = 14;

const std::vector<glm::dvec3> unit_cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
// vtkWedge: the first triangle counter-clockwise seen from outside.
const std::vector<glm::dvec3> unit_wedge{{0, 0, 0}, {0, 1, 0}, {1, 0, 0},
                                         {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
const std::vector<glm::dvec3> unit_pyramid{
    {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.4, 1}};

// The quadrilateral faces of each shape, from the figures of "VTK File Formats", in either sense.
using Quads = std::vector<std::array<std::size_t, 4>>;
const Quads cube_quads{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
const Quads wedge_quads{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
const Quads pyramid_quads{{0, 1, 2, 3}};

double volume(const Tet& tet, const std::vector<glm::dvec3>& points) {
    const auto p = [&](std::size_t i) { return points[static_cast<std::size_t>(tet[i])]; };
    return glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), p(3) - p(0)) / 6;
}

using Triangle = std::array<std::int32_t, 3>;
Triangle sorted(Triangle triangle) {
    std::sort(triangle.begin(), triangle.end());
    return triangle;
}

void count_faces(const Tet& tet, std::map<Triangle, int>& faces) {
    for (std::size_t face = 0; face < 4; ++face) ++faces[sorted(corners_of_face(tet, face))];
}

// Checks that the tets fill the cell: all are positive, have the volume of the cell together, share
// every inner face between two, and cut every quadrilateral through its least index.
void expect_good_split(std::int64_t type, const std::vector<glm::dvec3>& corners,
                       const Quads& quads, const std::vector<std::int32_t>& numbers,
                       double expected_volume, std::size_t expected_count) {
    std::vector<glm::dvec3> points(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        points[static_cast<std::size_t>(numbers[i])] = corners[i];
    }
    const SplitCell cell = split_cell(type, numbers, points);
    ASSERT_EQ(cell.count, expected_count);
    double sum = 0;
    std::map<Triangle, int> faces;
    for (std::size_t i = 0; i < cell.count; ++i) {
        const double v = volume(cell.tets[i], points);
        ASSERT_GT(v, 0);
        sum += v;
        count_faces(cell.tets[i], faces);
    }
    // The volumes are products of a few numbers below 1, each rounded by 1e-16 or so.
    ASSERT_NEAR(sum, expected_volume, 1e-15);
    int boundary = 0;
    for (const auto& [face, count] : faces) {
        ASSERT_LE(count, 2);
        boundary += count == 1;
    }
    // Boundary triangles: two for each quadrilateral, and the triangles of a wedge (2) or pyramid
    // (4).
    const int triangles = type == wedge ? 2 : type == pyramid ? 4 : 0;
    ASSERT_EQ(boundary, 2 * static_cast<int>(quads.size()) + triangles);
    for (const auto& quad : quads) {
        std::array<std::int32_t, 4> n{};
        for (std::size_t i = 0; i < 4; ++i) n[i] = numbers[quad[i]];
        std::rotate(n.begin(), std::min_element(n.begin(), n.end()), n.end());
        ASSERT_EQ(faces[sorted({n[0], n[1], n[2]})], 1);
        ASSERT_EQ(faces[sorted({n[0], n[2], n[3]})], 1);
    }
}

void try_all_numberings(std::int64_t type, const std::vector<glm::dvec3>& corners,
                        const Quads& quads, double expected_volume, std::size_t expected_count) {
    std::vector<std::int32_t> numbers(corners.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    do {
        expect_good_split(type, corners, quads, numbers, expected_volume, expected_count);
        if (::testing::Test::HasFatalFailure()) return;
    } while (std::next_permutation(numbers.begin(), numbers.end()));
}

TEST(CellSplit, TetsFillHexahedraInAll40320Numberings) {
    try_all_numberings(hexahedron, unit_cube, cube_quads, 1, 6);
}
TEST(CellSplit, TetsFillWedgesInAll720Numberings) {
    try_all_numberings(wedge, unit_wedge, wedge_quads, 0.5, 3);
}
TEST(CellSplit, TetsFillPyramidsInAll120Numberings) {
    try_all_numberings(pyramid, unit_pyramid, pyramid_quads, 1.0 / 3, 2);
}

TEST(CellSplit, VoxelsAreHexahedraInTheOrderOfTheAxes) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 8; ++i) corners.push_back(glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    const Quads quads{{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                      {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    expect_good_split(voxel, corners, quads, {0, 1, 2, 3, 4, 5, 6, 7}, 1, 6);
    expect_good_split(voxel, corners, quads, {5, 1, 7, 3, 0, 2, 4, 6}, 1, 6);
}

// gmsh and others number wedges in the sense opposite to VTK's. Both must give positive tets.
TEST(CellSplit, TetsFillWedgesOfEitherSense) {
    const std::vector<glm::dvec3> other{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    try_all_numberings(wedge, other, wedge_quads, 0.5, 3);
}

// Cells other than wedges are not turned: an inverted one gives inverted tets.
TEST(CellSplit, AnInvertedHexahedronGivesInvertedTets) {
    std::vector<glm::dvec3> mirrored = unit_cube;
    for (auto& point : mirrored) point.z = -point.z;
    const SplitCell cell =
        split_cell(hexahedron, std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7}, mirrored);
    for (std::size_t i = 0; i < cell.count; ++i) EXPECT_LT(volume(cell.tets[i], mirrored), 0);
}

// Returns the volume of a hexahedron with bent faces by the divergence theorem over the triangles
// into which split_cell()'s rule cuts its faces. It does not depend on how the inside is cut.
double volume_by_faces(const std::vector<glm::dvec3>& points, const Quads& outward) {
    double sum = 0;
    for (const auto& quad : outward) {
        std::array<std::size_t, 4> n = quad;
        std::rotate(n.begin(), std::min_element(n.begin(), n.end()), n.end());
        sum += glm::dot(points[n[0]], glm::cross(points[n[1]], points[n[2]]));
        sum += glm::dot(points[n[0]], glm::cross(points[n[2]], points[n[3]]));
    }
    return sum / 6;
}

TEST(CellSplit, VolumesOfBentHexahedraAddUp) {
    const Quads outward{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> shift(-0.3, 0.3);
    for (int round = 0; round < 1000; ++round) {
        std::vector<glm::dvec3> points = unit_cube;
        for (auto& point : points) point += glm::dvec3(shift(random), shift(random), shift(random));
        const SplitCell cell =
            split_cell(hexahedron, std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7}, points);
        double sum = 0;
        for (std::size_t i = 0; i < cell.count; ++i) sum += volume(cell.tets[i], points);
        // The sums have 12 products of three numbers below 2, each rounded by some 1e-15.
        ASSERT_NEAR(sum, volume_by_faces(points, outward), 2e-14);
    }
}

// Grids of 4 x 4 x 4 cubes with randomly numbered points. Cubes are cells of different kinds:
// hexahedra, pairs of wedges, or six pyramids around a point in the middle.
TEST(CellSplit, MixedGridsWithRandomNumbersConform) {
    constexpr int n = 4, side = n + 1;
    std::mt19937_64 random(3);
    for (int round = 0; round < 20; ++round) {
        const int total = side * side * side + n * n * n;
        std::vector<std::int32_t> number(static_cast<std::size_t>(total));
        std::iota(number.begin(), number.end(), 0);
        std::shuffle(number.begin(), number.end(), random);
        std::vector<glm::dvec3> points(number.size());
        const auto at = [&](int x, int y, int z) {
            return number[static_cast<std::size_t>(x + side * (y + side * z))];
        };
        for (int z = 0; z <= n; ++z) {
            for (int y = 0; y <= n; ++y) {
                for (int x = 0; x <= n; ++x) {
                    points[static_cast<std::size_t>(at(x, y, z))] = glm::dvec3(x, y, z);
                }
            }
        }
        std::map<Triangle, int> faces;
        double sum = 0;
        std::size_t tets = 0, expected_tets = 0;
        const auto add = [&](std::int64_t type, const std::vector<std::int32_t>& corners) {
            const SplitCell cell = split_cell(type, corners, points);
            tets += cell.count;
            for (std::size_t i = 0; i < cell.count; ++i) {
                ASSERT_GT(volume(cell.tets[i], points), 0);
                sum += volume(cell.tets[i], points);
                count_faces(cell.tets[i], faces);
            }
        };
        int centre = side * side * side;
        for (int z = 0; z < n; ++z) {
            for (int y = 0; y < n; ++y) {
                for (int x = 0; x < n; ++x, ++centre) {
                    std::vector<std::int32_t> c;
                    for (const auto& p : unit_cube) {
                        c.push_back(at(x + static_cast<int>(p.x), y + static_cast<int>(p.y),
                                       z + static_cast<int>(p.z)));
                    }
                    // Wedges cut the bottom and top of a cube along the diagonal 0-2, while a
                    // hexahedron would cut them by their indices. So wedges fill whole columns
                    // along z.
                    if (x == 1 && y == 1 && round % 2 == 0) {
                        add(wedge, {c[0], c[2], c[1], c[4], c[6], c[5]});
                        add(wedge, {c[0], c[3], c[2], c[4], c[7], c[6]});
                        expected_tets += 6;
                    } else if ((x + y + z) % 3 == 0) {
                        const auto middle = number[static_cast<std::size_t>(centre)];
                        points[static_cast<std::size_t>(middle)] =
                            glm::dvec3(x + 0.5, y + 0.5, z + 0.5);
                        add(pyramid, {c[0], c[1], c[2], c[3], middle});
                        add(pyramid, {c[7], c[6], c[5], c[4], middle});
                        add(pyramid, {c[4], c[5], c[1], c[0], middle});
                        add(pyramid, {c[3], c[2], c[6], c[7], middle});
                        add(pyramid, {c[0], c[3], c[7], c[4], middle});
                        add(pyramid, {c[1], c[5], c[6], c[2], middle});
                        expected_tets += 12;
                    } else {
                        add(hexahedron, c);
                        expected_tets += 6;
                    }
                }
            }
        }
        EXPECT_EQ(tets, expected_tets);
        EXPECT_NEAR(sum, n * n * n, 1e-11);
        int open = 0;
        for (const auto& [face, count] : faces) {
            ASSERT_LE(count, 2);
            open += count == 1;
        }
        EXPECT_EQ(open, 6 * n * n * 2);
    }
}

// A hexahedron whose corners coincide in pairs is a wedge, as some solvers write it. Its tets with
// four different corners fill it, so that it meets its neighbours.
TEST(CellSplit, CollapsedHexahedraFillTheirWedge) {
    std::vector<std::int32_t> numbers{0, 1, 2, 3, 4, 5};
    const std::vector<glm::dvec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                          {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    do {
        std::vector<glm::dvec3> points(6);
        for (std::size_t i = 0; i < 6; ++i)
            points[static_cast<std::size_t>(numbers[i])] = corners[i];
        const auto& k = numbers;
        const std::vector<std::int32_t> collapsed{k[0], k[1], k[2], k[2], k[3], k[4], k[5], k[5]};
        const SplitCell cell = split_cell(hexahedron, collapsed, points);
        double sum = 0;
        std::size_t whole = 0;
        for (std::size_t i = 0; i < cell.count; ++i) {
            const Tet& tet = cell.tets[i];
            if (std::set<std::int32_t>(tet.begin(), tet.end()).size() < 4) continue;
            ++whole;
            ASSERT_GT(volume(tet, points), 0);
            sum += volume(tet, points);
        }
        ASSERT_EQ(whole, 3u);
        ASSERT_NEAR(sum, 0.5, 1e-15);
    } while (std::next_permutation(numbers.begin(), numbers.end()));
}

TEST(CellSplit, EveryCellTypeIsCutSkippedOrRefused) {
    const auto expect_use = [](CellUse use, std::initializer_list<int> types) {
        for (const int type : types) {
            ASSERT_NE(find_cell_type(type), nullptr) << type;
            EXPECT_EQ(find_cell_type(type)->use, use) << type;
            EXPECT_FALSE(has_no_volume(type)) << type;
        }
    };
    expect_use(CellUse::straight, {10, 11, 12, 13, 14});
    expect_use(CellUse::lattice, {24, 25, 26, 27, 29, 31, 32, 33, 37, 71, 72, 73, 74});
    expect_use(CellUse::faces, {15, 16, 42});
    expect_use(CellUse::refused, {41, 55, 56, 64, 65, 66, 67, 78, 79, 80, 81});
    for (const int type : {1, 2, 3, 4, 5, 6, 7, 8, 9, 21, 22, 23, 36, 68, 69, 70, 77})
        EXPECT_TRUE(has_no_volume(type) && find_cell_type(type) == nullptr) << type;
    for (const int type : {-8, -1, 17, 99})
        EXPECT_TRUE(!has_no_volume(type) && find_cell_type(type) == nullptr) << type;
}

}  // namespace
}  // namespace lamina
