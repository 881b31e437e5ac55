// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_overlaps.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>

#include "mesh/mesh_shape.h"
#include "support/carved_mesh.h"
#include "support/needle_soup.h"
#include "support/overlapping_tets.h"
#include "support/split_box.h"

namespace lamina {
namespace {

constexpr std::size_t most = 10'000;

std::vector<TetPair> pairs_of(const MeshData& mesh) {
    const TetOverlaps found = find_overlaps(TetMesh(mesh, "mesh"), most);
    EXPECT_TRUE(found.complete);
    return found.pairs;
}

// In a mesh without common points, pairs overlap if no axis separates them (test::apart()).
TEST(TetOverlaps, AreThePairsThatNoAxisSeparates) {
    for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
        const TetMesh mesh(test::tet_soup(60, seed), "soup");
        const auto corners = [&](std::int32_t tet) {
            test::NeedleCorners found;
            for (std::size_t i = 0; i < 4; ++i) found[i] = mesh.points()[mesh.tets()[tet][i]];
            return found;
        };
        std::vector<TetPair> expected;
        for (std::int32_t a = 0; a < 60; ++a) {
            for (std::int32_t b = a + 1; b < 60; ++b)
                if (!test::apart(corners(a), corners(b))) expected.emplace_back(a, b);
        }
        EXPECT_GT(expected.size(), 20);
        EXPECT_EQ(find_overlaps(mesh, most).pairs, expected);
    }
}

TEST(TetOverlaps, AreNoneIfTetsTouch) {
    const auto nothing = [](const glm::dvec3&) { return 0.0; };
    EXPECT_TRUE(pairs_of(test::kuhn_box({4, 3, 5}, nothing)).empty());
    EXPECT_TRUE(pairs_of(test::needle_soup(60, 3, 1, .03)).empty());
    EXPECT_TRUE(pairs_of(test::twisted_prism(20)).empty());
}

TEST(TetOverlaps, AreFoundAmongTetsThatShareCorners) {
    const auto number = [](const std::string& name) {
        for (const test::OverlapCase& each : test::overlap_cases())
            if (each.name.starts_with(name)) return std::ssize(pairs_of(each.mesh));
        return std::ptrdiff_t{-1};
    };
    EXPECT_EQ(number("two that cut"), 1);
    EXPECT_EQ(number("three nested"), 3);
    EXPECT_EQ(number("bases in one plane"), 1);
    EXPECT_EQ(number("faces of two and three"), 3);
    EXPECT_EQ(number("tets that share an edge"), 3);
}

// Tells whether no plane of a face, and none parallel to an edge of each, separates the insides of
// two tets by more than rounding, which is below 1e-14 for coordinates up to 10.
bool share_space(const TetMesh& mesh, std::int32_t a, std::int32_t b) {
    std::array<std::array<glm::dvec3, 4>, 2> corners;
    std::vector<glm::dvec3> edges_of_a, axes;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[0][i] = mesh.points()[static_cast<std::size_t>(mesh.tets()[a][i])];
        corners[1][i] = mesh.points()[static_cast<std::size_t>(mesh.tets()[b][i])];
    }
    for (const auto& [p, q, r] : face_corners) {
        for (const auto& tet : corners)
            axes.push_back(glm::cross(tet[q] - tet[p], tet[r] - tet[p]));
    }
    for (const auto& [p, q] : tet_edges) {
        for (const auto& [r, s] : tet_edges)
            axes.push_back(
                glm::cross(corners[0][q] - corners[0][p], corners[1][s] - corners[1][r]));
    }
    return std::ranges::none_of(axes, [&](const glm::dvec3& axis) {
        if (glm::length(axis) < 1e-9) return false;
        const auto range = [&](const auto& tet) {
            std::array<double, 4> at;
            for (std::size_t i = 0; i < 4; ++i) at[i] = glm::dot(glm::normalize(axis), tet[i]);
            return std::ranges::minmax(at);
        };
        const auto of_a = range(corners[0]), of_b = range(corners[1]);
        return of_a.max < of_b.min + 1e-12 || of_b.max < of_a.min + 1e-12;
    });
}

std::vector<TetPair> by_all_pairs(const TetMesh& mesh) {
    std::vector<TetPair> expected;
    const auto flat = [&](std::int32_t tet) {
        return std::ranges::count(mesh.flat_tets(), tet) > 0;
    };
    for (std::int32_t a = 0; a < std::ssize(mesh.tets()); ++a) {
        for (std::int32_t b = a + 1; b < std::ssize(mesh.tets()); ++b)
            if (!flat(a) && !flat(b) && share_space(mesh, a, b)) expected.emplace_back(a, b);
    }
    return expected;
}

// Returns the pairs that are found, but those that only touch, which may be among them.
std::vector<TetPair> found_in(const TetMesh& mesh) {
    TetOverlaps found = find_overlaps(mesh, 1'000'000);
    EXPECT_TRUE(found.complete);
    std::erase_if(found.pairs,
                  [&](const TetPair& pair) { return !share_space(mesh, pair.first, pair.second); });
    return found.pairs;
}

double zero(const glm::dvec3&) {
    return 0;
}

MeshData together(MeshData mesh, const MeshData& other) {
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (const Tet& t : other.tets)
        mesh.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
    mesh.point_scalars.clear();
    return mesh;
}

MeshData moved(MeshData mesh, double scale, const glm::dvec3& by) {
    for (glm::dvec3& point : mesh.points) point = scale * point + by;
    return mesh;
}

// Many pairs of these have no open face: the search must step to them.
TEST(TetOverlaps, AreFoundInsideOfMeshes) {
    const MeshData box = test::kuhn_box({4, 4, 4}, zero);
    MeshData coil = test::kuhn_box({16, 3, 3}, zero);  // goes 1.3 times around a circle
    for (glm::dvec3& p : coil.points) {
        const double angle = .5 * p.x, radius = 4 + p.y + .05 * p.x;
        p = {radius * std::cos(angle), radius * std::sin(angle), p.z + .02 * p.x};
    }
    MeshData flat = box;  // a flat tet between cells, and one on the boundary
    flat.tets.push_back({0, 1, 2, 3});
    flat.tets.push_back({31, 32, 33, 34});
    const std::vector<std::pair<std::string, MeshData>> meshes{
        {"a coil", coil},
        {"boxes within boxes", together(box, moved(box, .4, {1.13, 1.21, 1.07}))},
        {"boxes that cut", together(box, moved(box, 1, {1.3, .7, .45}))},
        // All layers of tets end in the planes of the other mesh's layers.
        {"layers in common planes", together(box, moved(box, 1, {.5, .25, 0}))},
        {"a mesh whose every second plane is in the other",
         together(box, moved(box, .5, {1, 1, 1}))},
        {"two parts in a third",
         together(together(box, moved(box, .2, {.3, .3, .3})), moved(box, .2, {2.1, 2.3, 2.2}))},
        {"a part in a cavity, and one in the wall",
         together(together(test::carved(box,
                                        [](const glm::dvec3& c) {
                                            return glm::distance(c, glm::dvec3(2)) > 1;
                                        }),
                           moved(box, .1, {1.8, 1.8, 1.8})),
                  moved(box, .1, {.3, .3, .3}))},
        {"flat tets", together(flat, moved(box, .3, {1.17, 1.21, 1.4}))}};
    for (const auto& [name, data] : meshes) {
        const TetMesh mesh(data, name);
        const std::vector<TetPair> expected = by_all_pairs(mesh);
        EXPECT_GT(expected.size(), 40) << name;
        EXPECT_EQ(found_in(mesh), expected) << name;
    }
}

// Returns tets between the origin and the faces of a bumpy sphere: those of an octahedron whose
// sides are cut into `cells` each, 8 cells^2 in all.
MeshData coned_sphere(int cells) {
    MeshData mesh;
    mesh.points.emplace_back(0, 0, 0);
    const auto add = [&](const glm::dvec3& p) {
        const glm::dvec3 way = glm::normalize(p);
        const glm::dvec3 wave = glm::sin(7. * way);
        mesh.points.push_back((1 + .1 * wave.x * wave.y * wave.z) * way);
        return static_cast<std::int32_t>(mesh.points.size() - 1);
    };
    // A square of 2 cells a side, whose halves are folded up and down.
    std::map<std::array<int, 3>, std::int32_t> places;
    const auto place = [&](int x, int y, int side) {
        const std::array<int, 3> key{x, y, side * (cells - std::abs(x) - std::abs(y))};
        const auto [found, is_new] = places.try_emplace(key, 0);
        if (is_new) found->second = add({key[0], key[1], key[2]});
        return found->second;
    };
    for (const int side : {-1, 1}) {
        for (const int u : {-1, 1}) {
            for (const int v : {-1, 1}) {
                for (int x = 0; x < cells; ++x) {
                    for (int y = 0; x + y < cells; ++y) {
                        const auto at = [&](int i, int j) { return place(u * i, v * j, side); };
                        mesh.tets.push_back({0, at(x, y), at(x + 1, y), at(x, y + 1)});
                        if (x + y + 1 < cells)
                            mesh.tets.push_back({0, at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
                    }
                }
            }
        }
    }
    return mesh;
}

// The boxes of tets around one point overlap, but few are near the open faces of others.
TEST(TetOverlaps, AreFoundInStars) {
    const TetMesh star(coned_sphere(8), "star");
    EXPECT_EQ(convexity(star), Convexity::none);
    EXPECT_EQ(found_in(star), by_all_pairs(star));
    const TetMesh pair(together(coned_sphere(6), moved(coned_sphere(4), .3, {.8, .1, .2})), "pair");
    const std::vector<TetPair> expected = by_all_pairs(pair);
    EXPECT_GT(expected.size(), 40);
    EXPECT_EQ(found_in(pair), expected);
    // So many tets that the search would give up if it looked at all with boxes that meet: in each
    // eighth of space, 8 million pairs.
    const TetOverlaps many = find_overlaps(TetMesh(coned_sphere(64), "star"), 10);
    EXPECT_TRUE(many.complete);
    EXPECT_TRUE(many.pairs.empty());
}

// One mesh twice, the second time with its cells cut along other diagonals: the sides of all cells
// are in the planes of the other's, so both tets of a pair always end at once.
TEST(TetOverlaps, AreFoundWhereBothTetsEndInOnePlane) {
    MeshData mirrored = test::kuhn_box({3, 3, 3}, zero);
    for (glm::dvec3& p : mirrored.points) p.x = 3 - p.x;
    for (Tet& tet : mirrored.tets) std::swap(tet[0], tet[1]);
    const TetMesh mesh(together(test::kuhn_box({3, 3, 3}, zero), mirrored), "twice");
    EXPECT_EQ(found_in(mesh), by_all_pairs(mesh));
}

TEST(TetOverlaps, AreNotListedIfThereAreTooMany) {
    const TetMesh mesh(test::tet_soup(60, 1), "soup");
    const std::size_t count = find_overlaps(mesh, most).pairs.size();
    EXPECT_TRUE(find_overlaps(mesh, count).complete);
    const TetOverlaps none = find_overlaps(mesh, count - 1);
    EXPECT_FALSE(none.complete);
    EXPECT_TRUE(none.pairs.empty());
}

TEST(EntryRule, SortsByEntryAndTiesByNumber) {
    struct Item {
        double entry;
        std::int32_t tet;
    };
    const auto sorted = [](std::vector<Item> items, const EntryRule& rule) {
        sort_by_entry(std::span(items), rule, &Item::entry, &Item::tet);
        std::vector<std::int32_t> tets;
        for (const Item& item : items) tets.push_back(item.tet);
        return tets;
    };
    const std::vector<Item> items{{3, 0}, {1 + 1e-9, 1}, {1, 2}, {-2, 3}, {-5, 4}};
    EXPECT_EQ(sorted(items, {}), (std::vector<std::int32_t>{4, 3, 2, 1, 0}));
    EXPECT_EQ(sorted(items, {0, 0}), (std::vector<std::int32_t>{3, 4, 2, 1, 0}));
    EXPECT_EQ(sorted(items, {0, 1e-8}), (std::vector<std::int32_t>{3, 4, 1, 2, 0}));
}

}  // namespace
}  // namespace lamina
