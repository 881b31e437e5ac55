// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_overlaps.h"

#include <gtest/gtest.h>

#include "support/carved_mesh.h"
#include "support/needle_soup.h"
#include "support/overlapping_tets.h"

namespace lamina {
namespace {

constexpr std::size_t most = 10'000;

std::vector<TetPair> pairs_of(const MeshData& mesh) {
    return overlapping_pairs(TetMesh(mesh, "mesh"), most).value();
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
        EXPECT_EQ(overlapping_pairs(mesh, most).value(), expected);
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

TEST(TetOverlaps, AreNotListedIfThereAreTooMany) {
    const TetMesh mesh(test::tet_soup(60, 1), "soup");
    const std::size_t count = overlapping_pairs(mesh, most).value().size();
    EXPECT_TRUE(overlapping_pairs(mesh, count));
    EXPECT_FALSE(overlapping_pairs(mesh, count - 1));
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
