// SPDX-License-Identifier: Apache-2.0
#include "visibility/ring_order.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "mesh/face_tree.h"
#include "mesh/ray_walk.h"
#include "support/carved_mesh.h"
#include "support/needle_soup.h"
#include "visibility/visibility_order.h"

namespace lamina {
namespace {

struct PixelCounts {
    int covered = 0, wrong = 0, missing = 0;
};

// Tells whether a pixel is in an area; null is all pixels.
bool is_drawn(const PixelArea* pixels, int column, int row) {
    return pixels == nullptr || (column >= pixels->first_column && column <= pixels->last_column &&
                                 row >= pixels->first_row && row <= pixels->last_row);
}

// Compares the tets drawn in each pixel with the exact list of tets on its ray: each must be drawn
// once, the farther before the nearer. Segments shorter than 1e-9 do not count.
PixelCounts judge(const TetMesh& mesh, const View& view, const DrawOrder<std::int32_t>& order) {
    const FaceTree tree(mesh, mesh.open_faces());
    RayWalk walk(mesh, tree);
    std::vector<TetSegment> segments;
    PixelCounts counts;
    for (int row = 0; row < view.height; ++row) {
        for (int column = 0; column < view.width; ++column) {
            const View::Ray ray = view.ray(column, row);
            walk.aim(ray.origin, ray.direction);
            walk.list(segments);
            std::map<std::int32_t, int> left;  // how often each tet must still be drawn
            for (const TetSegment& segment : segments) {
                if (segment.out.at - std::max(segment.in.at, 0.0) > 1e-9) left[segment.tet] = 1;
            }
            counts.covered += !left.empty();
            std::erase_if(segments, [&](const TetSegment& s) { return !left.contains(s.tet); });
            std::size_t next = segments.size();
            bool wrong = false;
            for (std::size_t i = 0; i < order.items.size(); ++i) {
                const auto found = left.find(order.items[i]);
                if (found == left.end() || !is_drawn(order.pixels(i), column, row)) continue;
                --found->second;
                wrong |= next == 0 || segments[--next].tet != order.items[i];
            }
            for (const auto& [tet, times] : left) counts.missing += times != 0;
            counts.wrong += wrong;
        }
    }
    return counts;
}

Camera camera_at(const glm::dvec3& eye, const glm::dvec3& center, Projection projection) {
    Camera camera;
    camera.eye = eye;
    camera.center = center;
    camera.projection = projection;
    camera.height = 3;
    camera.fov_y = 36;
    return camera;
}

TEST(RingOrder, EveryPixelHasItsTetsOnceAndInOrder) {
    struct Case {
        MeshData mesh;
        glm::dvec3 eye, center;
        OrderMethod method;
    };
    std::vector<Case> cases{
        {test::three_sticks({.3, .2, .25}), {.2, .1, 6}, {0, 0, 0}, OrderMethod::exact},
        {test::three_sticks({.02, .2, .25}), {.2, .1, -6}, {0, 0, 0}, OrderMethod::exact},
        {test::twisted_prism(20), {.1, .03, 5}, {0, 0, 0}, OrderMethod::exact}};
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const int count = 20 << (seed % 4);
        cases.push_back({test::needle_soup(count, seed, 1.1, .03 + .01 * (seed % 3)),
                         {.5, .4, seed % 5 == 0 ? .5 : 3},  // one inside
                         {.5, .5, -.5},
                         OrderMethod::exact});
    }
    int rings = 0, limited = 0;
    for (const Case& each : cases) {
        const TetMesh mesh(each.mesh, "mesh");
        VisibilityOrder order(mesh, each.method);
        for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
            const View view(camera_at(each.eye, each.center, projection), 151, 119);
            const DrawOrder<std::int32_t> found = order.sort_pixels(view);
            rings += order.report().cycles > 0;
            limited += !found.limited.empty();
            EXPECT_EQ(order.report().broken, 0);
            const PixelCounts counts = judge(mesh, view, found);
            EXPECT_GT(counts.covered, 100);
            EXPECT_EQ(counts.wrong, 0);
            EXPECT_EQ(counts.missing, 0);
        }
    }
    EXPECT_GT(rings, 15);
    EXPECT_GT(limited, 10);
}

// For the same meshes an order without RingOrder is wrong in some pixels, so judge() can find
// errors.
TEST(RingOrder, AnOrderOfWholeTetsIsWrongSomewhere) {
    const TetMesh mesh(test::three_sticks({.3, .2, .25}), "sticks");
    const View view(camera_at({.2, .1, 6}, {0, 0, 0}, Projection::perspective), 200, 160);
    VisibilityOrder order(mesh, OrderMethod::exact);
    EXPECT_GT(judge(mesh, view, {order.sort(eye_of(view)), {}}).wrong, 0);
    EXPECT_EQ(judge(mesh, view, order.sort_pixels(view)).wrong, 0);
}

TEST(RingOrder, KeepsAllOverlappingTets) {
    // Turns the first stick over, so that it cuts others.
    MeshData mesh = test::three_sticks({.3, .3, .3});
    for (std::size_t i = 0; i < 4; ++i) mesh.points[i].z *= -1;
    const TetMesh crossed(mesh, "crossed");
    VisibilityOrder order(crossed, OrderMethod::exact);
    const View view(camera_at({.2, .1, 6}, {0, 0, 0}, Projection::perspective), 100, 80);
    const DrawOrder<std::int32_t> found = order.sort_pixels(view);
    EXPECT_EQ(judge(crossed, view, found).missing, 0);
}

// Batches, which are parts of a list, keep the pixels of their items.
TEST(DrawOrder, SublistsKeepTheirPixels) {
    const std::vector<int> items{0, 1, 2, 3, 4, 5, 6, 7};
    const std::vector<LimitedItems> runs{
        {1, 3, {0, 0, 0, 0}}, {3, 4, {1, 1, 0, 0}}, {6, 8, {2, 2, 0, 0}}};
    const DrawOrder<int> order{items, runs};
    for (std::size_t first = 0; first < items.size(); ++first) {
        for (std::size_t count = 0; first + count <= items.size(); ++count) {
            const DrawOrder<int> part = order.subrange(first, count);
            for (std::size_t i = 0; i < count; ++i) {
                EXPECT_EQ(part.items[i], items[first + i]);
                EXPECT_EQ(part.pixels(i), order.pixels(first + i));
            }
        }
    }
    EXPECT_EQ(order.pixels(0), nullptr);
    EXPECT_EQ(order.pixels(2), &runs[0].pixels);
    EXPECT_EQ(order.pixels(5), nullptr);
}

}  // namespace
}  // namespace lamina
