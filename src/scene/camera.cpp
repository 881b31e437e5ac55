// SPDX-License-Identifier: Apache-2.0
#include "scene/camera.h"

#include <cmath>
#include <numbers>

#include "base/enum_words.h"
#include "base/error.h"

namespace lamina {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

// Returns v with length 1, or zero. Cameras may be tiny or huge: scaling first avoids overflow.
glm::dvec3 direction_of(const glm::dvec3& v) {
    const double scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return scale > 0 ? glm::normalize(v / scale) : glm::dvec3(0);
}

}  // namespace

View::View(const Camera& camera, int width_pixels, int height_pixels)
    : projection(camera.projection), width(width_pixels), height(height_pixels), eye(camera.eye) {
    forward = direction_of(camera.center - camera.eye);
    if (forward == glm::dvec3(0)) fail("camera: eye and center are the same point");
    const glm::dvec3 side = glm::cross(forward, direction_of(camera.up));
    // Below 1e-9 rounding of eye, center and up would decide where the picture's up points.
    if (glm::length(side) < 1e-9) fail("camera.up: is zero or parallel to the view direction");
    right = glm::normalize(side);
    up = glm::cross(right, forward);
    pixel = projection == Projection::perspective
                ? 2 * std::tan(0.5 * camera.fov_y * radians_per_degree) / height
                : camera.height / height;
}

View::Ray View::ray(double column, double row) const {
    const glm::dvec3 offset = x(column) * right + y(row) * up;
    if (projection == Projection::perspective) return {eye, forward + offset};
    return {eye + offset, forward};
}

const char* name_of(Projection projection) {
    return word_of(projection, {"perspective", "orthographic"});
}

Camera turned(const Camera& camera, double degrees) {
    const glm::dvec3 axis = direction_of(camera.up);
    const glm::dvec3 arm = camera.eye - camera.center;
    const double angle = degrees * radians_per_degree;
    Camera result = camera;  // Rodrigues' rotation
    result.eye = camera.center + std::cos(angle) * arm + std::sin(angle) * glm::cross(axis, arm) +
                 (1 - std::cos(angle)) * glm::dot(axis, arm) * axis;
    return result;
}

// Places the camera so that the sphere around the box just fits the height of the picture.
Camera orbit(const Grid::Bounds& box, double azimuth, double elevation, double fov_y) {
    const double a = azimuth * radians_per_degree, e = elevation * radians_per_degree;
    const glm::dvec3 toward(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
    const double radius = 0.5 * glm::length(box.max - box.min);
    Camera camera;
    camera.center = 0.5 * (box.min + box.max);
    camera.eye = camera.center + radius / std::sin(0.5 * fov_y * radians_per_degree) * toward;
    // `up` is +y, about which turntables turn, unless the view is along it or beyond a pole.
    if (std::cos(e) < least_across)
        camera.up = {-std::sin(a) * std::sin(e), std::cos(e), -std::cos(a) * std::sin(e)};
    camera.fov_y = fov_y;
    return camera;
}

double world_unit(double diagonal) {
    return diagonal > 0 ? std::scalbn(1.0, -std::ilogb(diagonal)) : 1;
}

double box_diagonal(const Grid& grid) {
    return glm::distance(grid.to_world(grid.index_min()), grid.to_world(grid.index_max()));
}

Grid in_units(Grid grid, double unit) {
    grid.origin *= unit;
    for (glm::dvec3& step : grid.step) step *= unit;
    return grid;
}

View in_units(View view, double unit) {
    view.eye *= unit;
    if (view.projection == Projection::orthographic) view.pixel *= unit;
    return view;
}

TransferFunction in_units(const TransferFunction& transfer_function, double unit) {
    return transfer_function.attenuated(1 / unit);
}

}  // namespace lamina
