// SPDX-License-Identifier: Apache-2.0
// Orders of tets that overlap, against a list of all tets on each ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "support/carved_mesh.h"
#include "support/overlapping_tets.h"
#include "visibility/visibility_order.h"

namespace lamina {
namespace {

struct MetTet {
    double in, out;
    std::int32_t tet;
};

// Cuts the ray to a tet by its four planes.
MetTet meet(const TetMesh& mesh, std::int32_t tet, const View::Ray& ray) {
    MetTet met{-INFINITY, INFINITY, tet};
    for (std::int32_t face = 0; face < 4; ++face) {
        const auto [a, b, c] = mesh.corners({tet, face});
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double speed = glm::dot(normal, ray.direction);
        const double at = glm::dot(normal, a - ray.origin) / speed;
        if (speed > 0) met.out = std::min(met.out, at);
        if (speed < 0) met.in = std::max(met.in, at);
        if (speed == 0 && glm::dot(normal, a - ray.origin) < 0) met.out = -INFINITY;
    }
    return met;
}

// Lists the tets of a ray in the order that mesh/tet_overlaps.h defines. Segments shorter than 1e-9
// do not count. Entries of these meshes are equal, up to 1e-13, or 1e-9 apart.
std::vector<std::int32_t> by_entry(const TetMesh& mesh, const View& view, const View::Ray& ray) {
    std::vector<MetTet> met;
    for (std::int32_t tet = 0; tet < std::ssize(mesh.tets()); ++tet) {
        MetTet found = meet(mesh, tet, ray);
        if (!(found.out - std::max(found.in, 0.) > 1e-9)) continue;
        if (view.projection == Projection::perspective) found.in = std::max(found.in, 0.);
        met.push_back(found);
    }
    // A bubble sort, for which an order up to a tolerance is good enough.
    const auto wrong = [](const MetTet& a, const MetTet& b) {
        return std::abs(a.in - b.in) < 1e-11 ? a.tet > b.tet : a.in > b.in;
    };
    for (std::size_t i = 0; i < met.size(); ++i) {
        for (std::size_t j = 1; j < met.size() - i; ++j)
            if (wrong(met[j - 1], met[j])) std::swap(met[j - 1], met[j]);
    }
    std::vector<std::int32_t> tets;
    for (const MetTet& each : met) tets.push_back(each.tet);
    return tets;
}

struct EntryCounts {
    int covered = 0, wrong = 0;
    int wrong_on_the_left = 0;  // in the left half of the picture
};

// Lists, for each pixel, the tets that an order draws there, front to back.
std::vector<std::vector<std::int32_t>> drawn_by_pixel(const View& view,
                                                      const DrawOrder<std::int32_t>& order) {
    std::vector<std::vector<std::int32_t>> drawn(
        static_cast<std::size_t>(view.width * view.height));
    const PixelArea all{0, view.width - 1, 0, view.height - 1};
    for (std::size_t i = order.items.size(); i-- > 0;) {
        const PixelArea* const limit = order.pixels(i);
        const PixelArea& area = limit != nullptr ? *limit : all;
        for (int row = area.first_row; row <= area.last_row; ++row) {
            for (int column = area.first_column; column <= area.last_column; ++column)
                drawn[static_cast<std::size_t>(row * view.width + column)].push_back(
                    order.items[i]);
        }
    }
    return drawn;
}

EntryCounts judge_by_entry(const TetMesh& mesh, const View& view,
                           const DrawOrder<std::int32_t>& order) {
    EntryCounts counts;
    auto drawn = drawn_by_pixel(view, order);
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            const glm::dvec3 moved = ray_perturbation(view);
            const View::Ray ray = view.ray(column + moved.x, row - moved.y);
            const std::vector<std::int32_t> expected = by_entry(mesh, view, ray);
            auto& here = drawn[static_cast<std::size_t>(row * view.width + column)];
            std::erase_if(here, [&](std::int32_t tet) {
                return std::ranges::find(expected, tet) == expected.end();
            });
            counts.covered += !expected.empty();
            counts.wrong += here != expected;
            if (2 * column < view.width) counts.wrong_on_the_left += here != expected;
        }
    }
    return counts;
}

Camera camera_from(const glm::dvec3& eye, Projection projection) {
    Camera camera;
    camera.eye = eye;
    camera.center = {.5, .5, .5};
    camera.projection = projection;
    camera.height = 1.6;
    camera.fov_y = 40;
    return camera;
}

TEST(OverlapOrder, DrawsEachRaysTetsByEntry) {
    for (const test::OverlapCase& each : test::overlap_cases()) {
        const TetMesh mesh(each.mesh, "mesh");
        const std::vector<TetPair> pairs = find_overlaps(mesh, 10'000).pairs;
        ASSERT_FALSE(pairs.empty()) << each.name;
        VisibilityOrder order(mesh, OrderMethod::exact, pairs);
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            // The last two eyes are inside of some meshes, and in a plane of others' faces.
            for (const glm::dvec3& eye :
                 {glm::dvec3(.3, .4, 2.4), glm::dvec3(-1, 1.5, -.9), glm::dvec3(1.9, -.6, .2),
                  glm::dvec3(.52, .45, .43), glm::dvec3(2, .3, .5)}) {
                const View view(camera_from(eye, projection), 57, 49);
                const DrawOrder<std::int32_t> found = order.sort_pixels(view);
                EXPECT_EQ(order.report().broken, 0) << each.name;
                const EntryCounts counts = judge_by_entry(mesh, view, found);
                EXPECT_GT(counts.covered, 20) << each.name;
                EXPECT_EQ(counts.wrong, 0) << each.name << ", " << name_of(projection) << " from "
                                           << eye.x << ", " << eye.y << ", " << eye.z;
            }
        }
    }
}

// The following draw meshes and cameras at random, and hold the order of each pixel against a list
// of all tets on its ray.

struct Draw {
    std::mt19937 random;
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    int integer(int low, int high) {  // both included
        return std::uniform_int_distribution<int>(low, high)(random);
    }
    glm::dvec3 point() { return {uniform(0, 1), uniform(0, 1), uniform(0, 1)}; }
    // Returns a point of a lattice, so that faces lie in one plane and edges on one line.
    glm::dvec3 lattice_point() {
        return glm::dvec3(integer(0, 4), integer(0, 4), integer(0, 4)) / 4.;
    }
};

// Appends a mesh of tets that are random, on a lattice, parts of a box that share faces, or tets
// that share points with earlier ones.
void append_tets(MeshData& mesh, Draw& draw) {
    const int kind = draw.integer(0, 3), count = draw.integer(1, 6);
    if (kind == 2) {
        const MeshData box = test::kuhn_box({2, 2, 2}, [](const glm::dvec3&) { return 0.; });
        const bool shifted = draw.integer(0, 1) == 1;
        const glm::dvec3 by = shifted ? .5 * draw.point() : .5 * draw.lattice_point();
        std::vector<glm::dvec3> points;
        for (const glm::dvec3& point : box.points) points.push_back(.4 * point + by);
        std::vector<Tet> tets;
        for (const Tet& tet : box.tets)
            if (draw.integer(0, 3) == 0) tets.push_back(tet);
        return test::append(mesh, points, tets);
    }
    for (int i = 0; i < count; ++i) {
        const auto corner = [&] { return kind == 1 ? draw.lattice_point() : draw.point(); };
        std::array<glm::dvec3, 4> corners{corner(), corner(), corner(), corner()};
        if (kind == 3 && !mesh.points.empty()) {
            const int shared = draw.integer(1, 3);
            for (int j = 0; j < shared; ++j)
                corners[static_cast<std::size_t>(j)] = mesh.points[static_cast<std::size_t>(
                    draw.integer(0, static_cast<int>(mesh.points.size()) - 1))];
        }
        test::append_tet(mesh, corners);
    }
}

bool all_repeat_a_corner(const MeshData& mesh) {
    return std::ranges::all_of(mesh.tets, [&](const Tet& tet) {
        const auto point = [&](std::size_t i) {
            return mesh.points[static_cast<std::size_t>(tet[i])];
        };
        return std::ranges::any_of(
            tet_edges, [&](const auto& edge) { return point(edge[0]) == point(edge[1]); });
    });
}

View random_view(Draw& draw) {
    Camera camera;
    camera.eye = draw.integer(0, 2) == 0   ? draw.point()
                 : draw.integer(0, 1) == 0 ? 3. * draw.lattice_point() - 1.
                                           : 5. * draw.point() - 2.;
    do camera.center = draw.integer(0, 1) == 0 ? draw.point() : draw.lattice_point();
    while (glm::distance(camera.center, camera.eye) < .1);
    const glm::dvec3 forward = camera.center - camera.eye;
    camera.up = std::abs(forward.y) < .5 * glm::length(forward)   ? glm::dvec3(0, 1, 0)
                : std::abs(forward.x) < .5 * glm::length(forward) ? glm::dvec3(1, 0, 0)
                                                                  : glm::dvec3(0, 0, 1);
    camera.projection =
        draw.integer(0, 1) == 0 ? Projection::perspective : Projection::orthographic;
    camera.height = draw.uniform(.3, 2);
    camera.fov_y = draw.uniform(10, 100);
    return {camera, draw.integer(1, 40), draw.integer(1, 30)};
}

// Lists the tets of a ray by entry, or nothing if rounding may change the list: an entry is as
// uncertain as its face is steep to the ray. Short segments do not count; they are not listed.
std::optional<std::vector<std::int32_t>> surely_by_entry(const TetMesh& mesh, const View& view,
                                                         const View::Ray& ray) {
    struct Entry {
        double at, error;
        std::int32_t tet;
    };
    constexpr double shortest = 1e-4;   // far above the near plane of the order, 1e-6
    constexpr double rounding = 1e-14;  // of a coordinate, some ten products and sums of up to 5
    const EntryRule rule = entry_rule(mesh, eye_of(view), ray.direction);
    std::vector<Entry> entries;
    for (std::int32_t tet = 0; tet < std::ssize(mesh.tets()); ++tet) {
        const MetTet met = meet(mesh, tet, ray);
        const double in =
            std::max(met.in, view.projection == Projection::perspective ? 0. : met.in);
        if (std::ranges::count(mesh.flat_tets(), tet) > 0 || !(met.out - in > shortest)) continue;
        double steepest = 1;  // the least sine of a face and the ray
        for (std::int32_t face = 0; face < 4; ++face) {
            const auto [a, b, c] = mesh.corners({tet, face});
            const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
            steepest =
                std::min(steepest, std::abs(glm::dot(normal, glm::normalize(ray.direction))));
        }
        entries.push_back({in, rounding / steepest, tet});
    }
    std::ranges::sort(entries, {}, &Entry::at);
    for (std::size_t i = 1; i < entries.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double apart = entries[i].at - entries[j].at,
                         error = entries[i].error + entries[j].error;
            if (apart > .5 * rule.tie - error && apart < 2 * rule.tie + error) return {};
        }
    }
    std::vector<std::int32_t> tets;
    for (std::size_t first = 0, end = 0; first < entries.size(); first = end) {
        while (end < entries.size() && entries[end].at - entries[first].at <= rule.tie) ++end;
        const std::size_t begin = tets.size();
        for (std::size_t i = first; i < end; ++i) tets.push_back(entries[i].tet);
        std::sort(tets.begin() + static_cast<std::ptrdiff_t>(begin), tets.end());
    }
    return tets;
}

TEST(OverlapOrder, DrawsRandomTetsByEntry) {
    std::int64_t pixels = 0, covered = 0, doubtful = 0, ordered_rings = 0;
    std::vector<std::uint32_t> seeds(600);
    std::iota(seeds.begin(), seeds.end(), 1);
    // Tets without volume lie within others.
    seeds.insert(seeds.end(), {1742, 5215, 14944, 15156, 19014});
    for (const std::uint32_t seed : seeds) {
        Draw draw{std::mt19937(seed)};
        MeshData data;
        for (int parts = draw.integer(1, 3); parts > 0; --parts) append_tets(data, draw);
        if (data.tets.empty() || all_repeat_a_corner(data)) continue;
        const TetMesh mesh(data, "random");
        const TetOverlaps overlaps = find_overlaps(mesh, 100'000);
        ASSERT_TRUE(overlaps.complete);
        VisibilityOrder order(mesh, OrderMethod::exact, overlaps.pairs);
        for (int views = 0; views < 3; ++views) {
            const View view = random_view(draw);
            const DrawOrder<std::int32_t> found = order.sort_pixels(view);
            EXPECT_EQ(order.report().broken, 0) << "seed " << seed << ", view " << views;
            ordered_rings += !found.limited.empty();
            auto drawn = drawn_by_pixel(view, found);
            const glm::dvec3 moved = ray_perturbation(view);
            for (int row = 0; row < view.height; ++row) {
                for (int column = 0; column < view.width; ++column) {
                    const View::Ray ray = view.ray(column + moved.x, row - moved.y);
                    const auto expected = surely_by_entry(mesh, view, ray);
                    ++pixels;
                    doubtful += !expected;
                    if (!expected) continue;
                    covered += !expected->empty();
                    auto& here = drawn[static_cast<std::size_t>(row * view.width + column)];
                    std::erase_if(here, [&](std::int32_t tet) {
                        return std::ranges::find(*expected, tet) == expected->end();
                    });
                    ASSERT_EQ(here, *expected) << "seed " << seed << ", view " << views
                                               << ", pixel " << column << ", " << row;
                }
            }
        }
    }
    // The test would say nothing if it left out all rays, or saw no rings.
    EXPECT_GT(covered, pixels / 5);
    EXPECT_LT(doubtful, pixels / 50);
    EXPECT_GT(ordered_rings, 100);
}

// Without the pairs, the orders of the same meshes are wrong, so judge_by_entry() can find errors.
TEST(OverlapOrder, IsWrongWithoutThePairs) {
    const TetMesh mesh(test::tet_soup(20, 20), "soup");
    VisibilityOrder order(mesh, OrderMethod::exact);
    const View view(camera_from({.3, .4, 2.4}, Projection::perspective), 57, 49);
    EXPECT_GT(judge_by_entry(mesh, view, order.sort_pixels(view)).wrong, 100);
    EXPECT_GT(order.report().broken, 0);
}

// Three sticks in a ring on the left, and tets that overlap on the right. If the latter would take
// too long to order, the ring is solved all the same, unless it is not known which tets overlap.
TEST(OverlapOrder, SolvesOnlyRingsWithoutOverlapsIfAsked) {
    MeshData data = test::tet_soup(20, 20);
    for (glm::dvec3& point : data.points) point.x += 4;
    const MeshData sticks = test::three_sticks({.3, .2, .25});
    test::append(data, sticks.points, sticks.tets);
    const TetMesh mesh(data, "ring and soup");
    Camera camera = camera_from({2.5, .1, 8}, Projection::orthographic);
    camera.center = {2.5, .1, 0};
    camera.height = 5;
    const View view(camera, 180, 100);  // 9 wide: the left half ends at x = 2.5
    const std::vector<TetPair> pairs = find_overlaps(mesh, 1000).pairs;
    VisibilityOrder order(mesh, OrderMethod::exact, pairs);
    EXPECT_EQ(judge_by_entry(mesh, view, order.sort_pixels(view)).wrong, 0);
    EXPECT_GE(order.report().cycles, 2);
    EXPECT_EQ(order.report().broken, 0);
    const auto some = order.sort_pixels(
        view, [] {}, false);
    EXPECT_FALSE(some.limited.empty());
    const EntryCounts solved = judge_by_entry(mesh, view, some);
    EXPECT_EQ(solved.wrong_on_the_left, 0);
    EXPECT_GT(solved.wrong, 10);
    EXPECT_GT(order.report().broken, 0);
    VisibilityOrder unknown(mesh, OrderMethod::exact);
    const auto none = unknown.sort_pixels(
        view, [] {}, false);
    EXPECT_TRUE(none.limited.empty());
    EXPECT_GT(judge_by_entry(mesh, view, none).wrong_on_the_left, 0);
}

// Two tets that cut one another are ordered pixel by pixel only beside the lines on which they
// cross, so twice the picture's sides make twice as many rectangles. If all pixels that see both
// were ordered alone, there would be four times as many.
TEST(OverlapOrder, HalvesTheRectanglesOfFewTets) {
    const TetMesh mesh(test::overlap_cases().front().mesh, "two");
    VisibilityOrder order(mesh, OrderMethod::exact, find_overlaps(mesh, 1).pairs);
    const Camera camera = camera_from({.3, .4, 2.4}, Projection::perspective);
    const std::size_t small = order.sort_pixels(View(camera, 400, 300)).limited.size();
    EXPECT_GT(small, 0);
    EXPECT_LT(order.sort_pixels(View(camera, 800, 600)).limited.size(), 3 * small);
}

// Many tets, each in few pixels, are not ordered pixel by pixel, however many constraints they
// have.
TEST(OverlapOrder, SplitsThePictureOfManySmallTets) {
    MeshData data;
    for (int i = 0; i < 1500; ++i)
        test::append_tet(data, test::regular_tet({.5 + .33 * std::sin(1.7 * i),
                                                  .5 + .33 * std::sin(.37 * i * i), .5 + 1e-4 * i},
                                                 .04));
    const TetMesh mesh(data, "many");
    VisibilityOrder order(mesh, OrderMethod::exact, find_overlaps(mesh, 50'000).pairs);
    const View view(camera_from({.3, .4, 2.4}, Projection::perspective), 57, 49);
    EXPECT_EQ(judge_by_entry(mesh, view, order.sort_pixels(view)).wrong, 0);
}

}  // namespace
}  // namespace lamina
