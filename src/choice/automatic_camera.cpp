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
constexpr double margin = 1.0 / 25;  // as a share of half the picture
constexpr double least_across = 0.02;

// A camera's own axes: right-handed and orthonormal.
struct Axes {
    glm::dvec3 right, up, toward;  // from the scene to the eye
};

// The camera stands in front of the patient: its right is the patient's left.
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

// Quarter turns have exact cosines and sines, and so has a turn by 0.
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

// Distance that a point reaches along a direction. If the camera turns all around an axis, the
// point describes a circle.
class Reach {
  public:
    Reach(const glm::dvec3& axis, bool all_around) : axis_(axis), all_around_(all_around) {}

    void add(const glm::dvec3& point, const glm::dvec3& along, Extent& extent) const {
        if (!all_around_) return extent.add(glm::dot(point, along));
        const double rise = glm::dot(along, axis_), height = glm::dot(point, axis_);
        const double swing =
            glm::length(along - rise * axis_) * glm::length(point - height * axis_);
        extent.add(rise * height - swing);
        extent.add(rise * height + swing);
    }

  private:
    glm::dvec3 axis_;
    bool all_around_;
};

glm::dvec3 middle_of(std::span<const glm::dvec3> points) {
    Extent box[3];
    for (const glm::dvec3& point : points) {
        for (int axis = 0; axis < 3; ++axis) box[axis].add(point[axis]);
    }
    return {box[0].middle(), box[1].middle(), box[2].middle()};
}

}  // namespace

// A point at (r, u) across and depth d behind the eye at (R, U, D) is in a picture of slope s if
// |r - R| <= s (d - D). So R lies between max(r - s d) + s D and min(r + s d) - s D; the nearest D
// with such an R makes both ends equal. U follows likewise.
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height, bool all_around) {
    const Axes to = turned(axes_of(axes), {three_quarter_azimuth + turn.azimuth,
                                           three_quarter_elevation + turn.elevation});
    Camera camera;
    camera.fov_y = fov_y;
    // The data's own up, if it is not along the view, so that turntables stand upright.
    const glm::dvec3 up = axes_of(axes).up;
    camera.up = glm::dot(up, to.up) > least_across ? up : to.up;
    const double slope_up = std::tan(fov_y / 2 * degree) * (1 - margin);
    const double slope_right = slope_up * width / height;
    // Relative to the middle, so that a distant origin costs no digits.
    const glm::dvec3 middle = middle_of(points);
    const Reach reach(camera.up, all_around);
    Extent right_near, right_far, up_near, up_far, toward;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 arm = point - middle;
        reach.add(arm, to.right + slope_right * to.toward, right_near);
        reach.add(arm, to.right - slope_right * to.toward, right_far);
        reach.add(arm, to.up + slope_up * to.toward, up_near);
        reach.add(arm, to.up - slope_up * to.toward, up_far);
        reach.add(arm, to.toward, toward);
    }
    const double eye_depth = std::min((right_far.lo - right_near.hi) / (2 * slope_right),
                                      (up_far.lo - up_near.hi) / (2 * slope_up));
    const double eye_right = (right_far.lo + right_near.hi) / 2;
    const double eye_up = (up_far.lo + up_near.hi) / 2;
    const glm::dvec3 across = eye_right * to.right + eye_up * to.up;
    camera.eye = middle + across - eye_depth * to.toward;
    // The camera's centre: the middle of the visible points along the view's axis or, if the camera
    // turns all around, the common centre of their circles.
    const glm::dvec3 level = to.toward - glm::dot(to.toward, camera.up) * camera.up;
    const double along =
        all_around ? -glm::dot(across, level) / glm::dot(to.toward, level) : toward.middle();
    camera.center = middle + across + along * to.toward;
    return camera;
}

Camera turned(const Camera& camera, const ViewTurn& turn) {
    if (turn.azimuth == 0 && turn.elevation == 0) return camera;
    const glm::dvec3 arm = camera.eye - camera.center;
    const double distance = glm::length(arm);
    const glm::dvec3 toward = arm / distance;
    const glm::dvec3 right = glm::normalize(glm::cross(camera.up, toward));
    // Azimuth turns around the camera's own up, which need not be at a right angle to its view.
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
