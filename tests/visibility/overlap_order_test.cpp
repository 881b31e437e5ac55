// SPDX-License-Identifier: Apache-2.0
// Orders of tets that overlap, against a list of all tets on each ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

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

// Without the pairs, the orders of the same meshes are wrong, so judge_by_entry() can find errors.
TEST(OverlapOrder, IsWrongWithoutThePairs) {
    const TetMesh mesh(test::tet_soup(20, 20), "soup");
    VisibilityOrder order(mesh, OrderMethod::exact);
    const View view(camera_from({.3, .4, 2.4}, Projection::perspective), 57, 49);
    EXPECT_GT(judge_by_entry(mesh, view, order.sort_pixels(view)).wrong, 100);
    EXPECT_GT(order.report().broken, 0);
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
