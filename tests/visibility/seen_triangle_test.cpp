// SPDX-License-Identifier: Apache-2.0
#include "visibility/open_face_constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <random>

#include "mesh/predicates.h"
#include "visibility/order_graph.h"

namespace lamina {
namespace {

constexpr double pi = std::numbers::pi;

class RandomTriangles {
  public:
    explicit RandomTriangles(std::uint32_t seed) : random_(seed) {}
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random_);
    }
    glm::dvec3 point() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
    // Returns a triangle whose sign_as_seen() is `sign`.
    Triangle seen(const Eye& eye, int sign) {
        Triangle t{point(), point(), point()};
        if (sign_as_seen(eye, t[0], t[1], t[2]) != sign) std::swap(t[1], t[2]);
        return t;
    }
    glm::dvec3 point_on(const Triangle& t) {
        double u = uniform(0, 1), v = uniform(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
    }

  private:
    std::mt19937 random_;
};

// Returns the parameter at which the ray through `through` meets the triangle, 0 at `through` and
// growing with the distance; nothing if it misses.
std::optional<double> hit(const Eye& eye, const glm::dvec3& through, const Triangle& t) {
    const glm::dvec3 origin = eye.at_infinity ? through : eye.position;
    const glm::dvec3 direction = eye.at_infinity ? eye.position : through - eye.position;
    const glm::dvec3 u = t[1] - t[0], v = t[2] - t[0], n = glm::cross(u, v), w = origin - t[0];
    const double at = -glm::dot(n, w) / glm::dot(n, direction);
    const glm::dvec3 p = w + at * direction;
    const double b = glm::dot(glm::cross(p, v), n) / glm::dot(n, n);
    const double c = glm::dot(glm::cross(u, p), n) / glm::dot(n, n);
    if (b <= 0 || c <= 0 || b + c >= 1 || (!eye.at_infinity && at <= 0)) return {};
    return eye.at_infinity ? at : at - 1;
}

bool edge_cuts(const glm::dvec3& a, const glm::dvec3& b, const Triangle& t) {
    if (orientation(t[0], t[1], t[2], a) * orientation(t[0], t[1], t[2], b) > 0) return false;
    const int s0 = orientation(a, b, t[0], t[1]), s1 = orientation(a, b, t[1], t[2]),
              s2 = orientation(a, b, t[2], t[0]);
    return s0 == s1 && s1 == s2;
}

bool cut_one_another(const Triangle& s, const Triangle& t) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (edge_cuts(s[i], s[(i + 1) % 3], t) || edge_cuts(t[i], t[(i + 1) % 3], s)) return true;
    }
    return false;
}

// Compares with 1000 rays through the exit, which find an overlap of 2 per cent of it with a
// probability of 1 - .98^1000 > 1 - 2e-9. Some eyes are among the triangles: what is behind the eye
// is not seen.
TEST(SeenTriangle, ShowsWhatRaysMeet) {
    RandomTriangles random(4);
    int shown = 0, hidden = 0, cut = 0;
    for (int round = 0; round < 3000; ++round) {
        Eye eye{random.point() * (round % 2 == 0 ? 1.0 : 4.0), round % 3 == 0};
        const Triangle exit = random.seen(eye, 1), entry = random.seen(eye, -1);
        if (cut_one_another(exit, entry)) {
            ++cut;
            continue;
        }
        const SeenTriangle seen_exit(eye, exit), seen_entry(eye, entry);
        ASSERT_EQ(seen_exit.sign(), 1);
        ASSERT_EQ(seen_entry.sign(), -1);
        const bool shows = seen_exit.shows(eye, seen_entry);
        int behind = 0, before = 0;
        for (int ray = 0; ray < 1000; ++ray) {
            const auto at = hit(eye, random.point_on(exit), entry);
            if (at) ++(*at > 0 ? behind : before);
        }
        ASSERT_TRUE(behind == 0 || before == 0) << round;
        EXPECT_TRUE(behind == 0 || shows) << round;
        EXPECT_TRUE(before == 0 || !shows) << round;
        const double share = seen_overlap(eye, exit, entry) / seen_area(eye, exit);
        EXPECT_TRUE(behind + before == 0 || share > 0) << round;
        // If the eye is at infinity, rays that are uniform on the triangle are uniform in the view.
        EXPECT_TRUE(!shows || behind > 0 || share < (eye.at_infinity ? .02 : .3)) << round;
        shown += shows;
        hidden += before > 0;
    }
    EXPECT_GT(shown, 200);
    EXPECT_GT(hidden, 200);
    EXPECT_GT(cut, 200);
}

// Triangles that touch along an edge or at a corner, or whose edges cross exactly as seen, give
// exact zeros.
TEST(SeenTriangle, DoesNotOverlapATriangleThatItTouches) {
    const Eye above{{0, 0, -1}, true};
    const Triangle exit{glm::dvec3(0, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0)};
    ASSERT_EQ(SeenTriangle(above, exit).sign(), 1);
    const auto shows = [&](Triangle entry) {
        const SeenTriangle seen(above, entry);
        EXPECT_EQ(seen.sign(), -1);
        return SeenTriangle(above, exit).shows(above, seen);
    };
    const auto p = [](double x, double y, double z) { return glm::dvec3(x, y, z); };
    EXPECT_FALSE(shows({p(0, 0, -1), p(0, 1, -1), p(-1, 0, -1)}));  // along x = 0
    EXPECT_FALSE(shows({p(1, 0, -1), p(1, 1, -2), p(0, 1, -1)}));   // along the hypotenuse
    // Along the hypotenuse, in the same plane.
    EXPECT_FALSE(shows({p(1, 0, 0), p(1, 1, 0), p(0, 1, 0)}));
    EXPECT_FALSE(shows({p(0, 0, -1), p(-1, 0, -1), p(0, -1, -1)}));  // at a corner
    // The exit triangle moved behind itself.
    EXPECT_TRUE(shows({p(0, 0, -1), p(1, 0, -1), p(0, 1, -1)}));
    EXPECT_TRUE(shows({p(0, 0, 0), p(1, 0, 0), p(0, 1, 0)}));               // in the exit
    EXPECT_FALSE(shows({p(0, 0, 1), p(1, 0, 1), p(0, 1, 1)}));              // before the exit
    EXPECT_TRUE(shows({p(1e-30, 1e-30, -1), p(-1, 0, -1), p(0, -1, -1)}));  // just over the corner
    EXPECT_TRUE(shows({p(0, 0, 0), p(1, 0, -1), p(0, 1, 0)}));  // hinged at an edge, behind
    EXPECT_FALSE(shows({p(0, 0, 0), p(1, 0, 1), p(0, 1, 0)}));  // hinged, before
}

// One triangle is behind the eye, and both look like a star of David: no plane through an edge of
// one separates their pyramids.
TEST(SeenTriangle, IgnoresTrianglesBehindTheEye) {
    const Eye eye{{0, 0, 0}, false};
    const auto ring = [](double start, double z, double sense) {
        Triangle t;
        for (int i = 0; i < 3; ++i) {
            const double turn = start + sense * 2 * pi / 3 * i;
            t[static_cast<std::size_t>(i)] = {std::cos(turn), std::sin(turn), z};
        }
        return t;
    };
    for (const double sense : {1., -1.}) {
        const Triangle exit = ring(0, 1, sense), opposite = ring(0, -1, sense),
                       turned = ring(pi, -1, sense);
        const SeenTriangle seen(eye, exit);
        if (seen.sign() != 1) continue;
        for (const Triangle& behind : {opposite, turned}) {
            SeenTriangle other(eye, behind);
            if (other.sign() != -1) other = SeenTriangle(eye, {behind[0], behind[2], behind[1]});
            EXPECT_FALSE(seen.shows(eye, other));
        }
    }
}

TEST(SeenThrough, KeepsEveryBoxWithSomethingShown) {
    RandomTriangles random(9);
    int kept = 0, dropped = 0;
    for (int round = 0; round < 20000; ++round) {
        const Eye eye{random.point(), round % 3 == 0};
        const Triangle exit = random.seen(eye, 1);
        const SeenThrough through(SeenTriangle(eye, exit), {glm::dvec3(-9), glm::dvec3(9)});
        // Takes a point behind the exit, on a ray through it, as a corner of the box.
        const glm::dvec3 on = random.point_on(exit);
        const glm::dvec3 ray = eye.at_infinity ? eye.position : on - eye.position;
        const glm::dvec3 corner = on + random.uniform(0, 2) * ray;
        const glm::dvec3 other = corner + .3 * random.point();
        EXPECT_TRUE(
            through.reaches(FaceTree::Box{glm::min(corner, other), glm::max(corner, other)}));
        EXPECT_TRUE(through.reaches(Triangle{corner, other, other + .1 * random.point()}));
        const glm::dvec3 far = 4. * random.point();
        const bool reached = through.reaches(FaceTree::Box{far, far + .1});
        ++(reached ? kept : dropped);
    }
    EXPECT_GT(dropped, kept);
}

TEST(SeenArea, IsExactForKnownTriangles) {
    const Triangle octant{glm::dvec3(5, 0, 0), glm::dvec3(0, 5, 0), glm::dvec3(0, 0, 5)};
    EXPECT_NEAR(seen_area({{0, 0, 0}}, octant), pi / 2, 1e-15);  // an eighth of the sphere
    EXPECT_NEAR(seen_area({{0, 0, -7}, true}, octant), 12.5, 1e-14);
    // The octant seen through a window next to the z axis, between y = 0 and y = x: half of the
    // octant.
    const Triangle window{glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0)};
    EXPECT_NEAR(seen_overlap({{0, 0, 0}}, window, octant), pi / 4, 1e-15);
}

}  // namespace
}  // namespace lamina
