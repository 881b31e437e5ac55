// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "support/carved_mesh.h"
#include "visibility/order_graph.h"
#include "visibility/visibility_order.h"

namespace lamina {
namespace {

// Returns the smallest seen area of broken constraints over all orders of a mesh of few tets.
double least_broken(const TetMesh& mesh, const Eye& eye) {
    OrderGraph graph(mesh, true);
    graph.look_from(eye);
    std::vector<std::int32_t> places(mesh.tets().size());
    std::iota(places.begin(), places.end(), 0);
    double least = INFINITY;
    do {
        double broken = 0;
        for (std::int32_t tet = 0; tet < static_cast<std::int32_t>(places.size()); ++tet) {
            for (std::int32_t edge = graph.first_edge(tet); edge != OrderGraph::no_edge;
                 edge = graph.next_edge(tet, edge)) {
                const auto nearer = static_cast<std::size_t>(graph.nearer(tet, edge));
                if (places[nearer] < places[static_cast<std::size_t>(tet)])
                    broken += graph.area(tet, edge);
            }
        }
        least = std::min(least, broken);
    } while (std::next_permutation(places.begin(), places.end()));
    return least;
}

TEST(OrderCycles, BreakTheSmallestOverlapOfThreeSticks) {
    const TetMesh mesh(test::three_sticks({.3, .1, .2}), "sticks");
    VisibilityOrder exact(mesh, OrderMethod::exact);
    for (const Eye& eye : {Eye{{0, 0, -1}, true}, Eye{{0, 0, 1}, true}, Eye{{.2, .1, 9}}}) {
        exact.sort(eye);
        EXPECT_EQ(exact.report().cycles, 1);
        EXPECT_EQ(exact.report().cyclic_tets, 3);
        EXPECT_EQ(exact.report().broken, 1);
        for (std::int32_t tet = 0; tet < 3; ++tet) EXPECT_EQ(exact.cycle_of(tet), 0);
        // The best order breaks the smallest of the three overlaps.
        EXPECT_NEAR(exact.report().broken_area, least_broken(mesh, eye), 1e-15);
    }
    exact.sort({{1, 0, 0}, true});  // from the side
    EXPECT_EQ(exact.report().cycles, 0);
    EXPECT_EQ(exact.report().broken, 0);
    for (std::int32_t tet = 0; tet < 3; ++tet) EXPECT_EQ(exact.cycle_of(tet), -1);
    // MPVO (Williams) looks only across shared faces, and sticks share none.
    VisibilityOrder mpvo(mesh, OrderMethod::mpvo);
    mpvo.sort({{0, 0, -1}, true});
    EXPECT_EQ(mpvo.report().cycles, 0);
}

TEST(OrderCycles, AreFoundInAConnectedMesh) {
    const TetMesh mesh(test::twisted_prism(20), "prism");
    const Eye eye{{0, 0, -1}, true};
    for (const OrderMethod method : {OrderMethod::mpvo, OrderMethod::exact}) {
        VisibilityOrder order(mesh, method);
        const auto sorted = order.sort(eye);
        EXPECT_EQ(order.report().cycles, 1) << name_of(method);
        EXPECT_EQ(order.report().cyclic_tets, 6) << name_of(method);
        EXPECT_GE(order.report().broken, 1) << name_of(method);
        const std::int64_t violations = face_violations(mesh, eye, sorted);
        EXPECT_GE(violations, 1) << name_of(method);
        EXPECT_LE(violations, order.report().broken) << name_of(method);
        if (method == OrderMethod::exact) {  // bottom farthest, top nearest
            EXPECT_EQ(sorted.front(), 0);
            EXPECT_EQ(sorted.back(), 1);
        }
        EXPECT_EQ(order.cycle_of(0), -1);
        EXPECT_EQ(order.cycle_of(1), -1);
    }
    VisibilityOrder exact(mesh, OrderMethod::exact);
    exact.sort(eye);
    // Gaps at the dents add small cycles to the ring, so the heuristic is not optimal here.
    const double least = least_broken(mesh, eye);
    EXPECT_GE(exact.report().broken_area, least * (1 - 1e-12));
    EXPECT_LE(exact.report().broken_area, 2 * least);
    exact.sort({{1, .2, .1}, true});
    EXPECT_EQ(exact.report().cycles, 0);
}

// Two groups of sticks, one above the other, have two cycles, which are kept apart and in order.
TEST(OrderCycles, AreKeptApart) {
    MeshData data = test::three_sticks({.1, .2, .3});
    const MeshData above = test::three_sticks({.3, .1, .2});
    for (const glm::dvec3& p : above.points) data.points.push_back(p + glm::dvec3(0, 0, 3));
    for (Tet tet : above.tets) {
        for (std::int32_t& corner : tet) corner += 12;
        data.tets.push_back(tet);
    }
    const TetMesh mesh(data, "sticks");
    VisibilityOrder exact(mesh, OrderMethod::exact);
    const auto order = exact.sort({{0, 0, -1}, true});
    EXPECT_EQ(exact.report().cycles, 2);
    EXPECT_EQ(exact.report().cyclic_tets, 6);
    EXPECT_EQ(exact.report().broken, 2);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(order[i] < 3, i < 3);  // the lower ones first
    EXPECT_EQ(exact.cycle_of(0), exact.cycle_of(2));
    EXPECT_EQ(exact.cycle_of(3), exact.cycle_of(5));
    EXPECT_NE(exact.cycle_of(0), exact.cycle_of(3));
}

// Random sticks cut one another and make many cycles. Compares components, and the order between
// them, with reachability by brute force.
TEST(OrderCycles, MatchReachabilityByBruteForce) {
    MeshData data;
    std::uint32_t state = 1;
    const auto uniform = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<double>(state >> 8) / (1 << 24);
    };
    constexpr std::int32_t count = 60;
    for (std::int32_t i = 0; i < count; ++i) {  // long thin tets at random places: they may overlap
        const glm::dvec3 a(uniform(), uniform(), uniform()), b(uniform(), uniform(), uniform());
        const glm::dvec3 u(.02 * uniform(), .02 * uniform(), 0),
            v(0, .02 * uniform(), .02 * uniform());
        data.points.insert(data.points.end(), {a, a + u, b, b + v});
        data.tets.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
    }
    const TetMesh mesh(data, "sticks");
    for (const Eye& eye : {Eye{{0, 0, -1}, true}, Eye{{.5, .5, .5}}, Eye{{3, 1, 2}}}) {
        OrderGraph graph(mesh, true);
        graph.look_from(eye);
        std::array<std::array<bool, count>, count> reaches{};
        for (std::int32_t tet = 0; tet < count; ++tet) {
            for (std::int32_t edge = graph.first_edge(tet); edge != OrderGraph::no_edge;
                 edge = graph.next_edge(tet, edge))
                reaches[static_cast<std::size_t>(tet)]
                       [static_cast<std::size_t>(graph.nearer(tet, edge))] = true;
        }
        for (std::size_t k = 0; k < count; ++k)
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t j = 0; j < count; ++j)
                    reaches[i][j] = reaches[i][j] || (reaches[i][k] && reaches[k][j]);
        VisibilityOrder exact(mesh, OrderMethod::exact);
        const auto order = exact.sort(eye);
        std::int64_t cyclic = 0;
        std::set<std::int32_t> cycles;
        for (std::size_t i = 0; i < count; ++i) {
            const auto a = static_cast<std::size_t>(order[i]);
            cyclic += reaches[a][a];
            EXPECT_EQ(exact.cycle_of(order[i]) >= 0, reaches[a][a]);
            if (reaches[a][a]) cycles.insert(exact.cycle_of(order[i]));
            for (std::size_t j = i + 1; j < count; ++j) {
                const auto b = static_cast<std::size_t>(order[j]);
                const bool together = reaches[a][b] && reaches[b][a];
                EXPECT_EQ(exact.cycle_of(order[i]) >= 0 &&
                              exact.cycle_of(order[i]) == exact.cycle_of(order[j]),
                          together);
                EXPECT_TRUE(together || !reaches[b][a]);  // b is drawn after a
            }
        }
        EXPECT_EQ(exact.report().cyclic_tets, cyclic);
        EXPECT_EQ(exact.report().cycles, static_cast<std::int64_t>(cycles.size()));
    }
}

}  // namespace
}  // namespace lamina
