// SPDX-License-Identifier: Apache-2.0
#include "choice/automatic_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace lamina {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double three_quarter_azimuth = 30, three_quarter_elevation = 20;
constexpr double fov_y = 30;
constexpr double margin = 1.0 / 25;  // of half the picture
constexpr double least_across = 0.02;

// Right-handed, orthonormal: a camera's own axes.
struct Axes {
    glm::dvec3 right, up, toward;  // toward: from what is seen to the eye
};

// In front of a patient: right is the patient's left.
Axes axes_of(WorldAxes axes) {
    switch (axes) {
        case WorldAxes::left_posterior_superior:
            return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
        case WorldAxes::right_anterior_superior:
            return {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
        case WorldAxes::left_anterior_superior:  // a left-handed world
            return {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
        case WorldAxes::unnamed:
            return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    }
    return {};
}

// Along the axes of the world cosine and sine are exact, and so is a turn of nothing.
Axes turned(const Axes& axes, const ViewTurn& turn) {
    const double a = turn.azimuth * degree, e = turn.elevation * degree;
    const glm::dvec3 right = std::cos(a) * axes.right - std::sin(a) * axes.toward;
    const glm::dvec3 around = std::sin(a) * axes.right + std::cos(a) * axes.toward;
    return {right, std::cos(e) * axes.up - std::sin(e) * around,
            std::sin(e) * axes.up + std::cos(e) * around};
}

struct Extent {
    double lo = INFINITY, hi = -INFINITY;
    void add(double value) {
        lo = std::min(lo, value);
        hi = std::max(hi, value);
    }
    double middle() const { return lo + (hi - lo) / 2; }
};

}  // namespace

// A point at (r, u) across and depth d behind the eye at (R, U, D) is in a picture of slope s if
// |r - R| <= s (d - D). So R lies between max(r - s d) + s D and min(r + s d) - s D, and the
// nearest D for which there is such an R makes the two ends the same; likewise for U.
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height) {
    const Axes to = turned(axes_of(axes), {three_quarter_azimuth + turn.azimuth,
                                           three_quarter_elevation + turn.elevation});
    const double slope_up = std::tan(fov_y / 2 * degree) * (1 - margin);
    const double slope_right = slope_up * width / height;
    Extent box[3];
    for (const glm::dvec3& point : points) {
        for (int axis = 0; axis < 3; ++axis) box[axis].add(point[axis]);
    }
    // Relative to the middle, so that a distant origin costs no digits.
    const glm::dvec3 middle(box[0].middle(), box[1].middle(), box[2].middle());
    Extent right_near, right_far, up_near, up_far, depth;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 arm = point - middle;
        const double r = glm::dot(arm, to.right), u = glm::dot(arm, to.up);
        const double d = -glm::dot(arm, to.toward);
        right_near.add(r - slope_right * d);
        right_far.add(r + slope_right * d);
        up_near.add(u - slope_up * d);
        up_far.add(u + slope_up * d);
        depth.add(d);
    }
    const double eye_depth = std::min((right_far.lo - right_near.hi) / (2 * slope_right),
                                      (up_far.lo - up_near.hi) / (2 * slope_up));
    const double eye_right = (right_far.lo + right_near.hi) / 2;
    const double eye_up = (up_far.lo + up_near.hi) / 2;
    const glm::dvec3 axis = middle + eye_right * to.right + eye_up * to.up;
    Camera camera;
    camera.center = axis - depth.middle() * to.toward;
    camera.eye = axis - eye_depth * to.toward;
    // The data's own up where that is a direction across the view, so that turntables stand
    // upright.
    const glm::dvec3 up = axes_of(axes).up;
    camera.up = glm::dot(up, to.up) > least_across ? up : to.up;
    camera.fov_y = fov_y;
    return camera;
}

Camera turned(const Camera& camera, const ViewTurn& turn) {
    if (turn.azimuth == 0 && turn.elevation == 0) return camera;
    const glm::dvec3 arm = camera.eye - camera.center;
    const double distance = glm::length(arm);
    const glm::dvec3 toward = arm / distance;
    const glm::dvec3 right = glm::normalize(glm::cross(camera.up, toward));
    // Azimuth goes around the camera's own up, which need not be at a right angle to its view.
    const Axes around = turned(Axes{right, glm::cross(toward, right), toward}, turn);
    Camera result = camera;
    result.eye = camera.center + distance * around.toward;
    result.up = around.up;
    return result;
}

Camera zoomed(Camera camera, double factor) {
    camera.height /= factor;
    const double half = std::atan(std::tan(camera.fov_y / 2 * degree) / factor);
    if (factor != 1) camera.fov_y = 2 * half / degree;
    return camera;
}

}  // namespace lamina
