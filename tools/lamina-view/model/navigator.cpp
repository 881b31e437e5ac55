// SPDX-License-Identifier: Apache-2.0
#include "model/navigator.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace lamina::view {
namespace {

double distance_of(const Camera& camera) {
    return glm::length(camera.center - camera.eye);
}

double half_height_per_distance(const Camera& camera) {
    return std::tan(glm::radians(camera.fov_y) / 2);
}

// Turns a vector by an angle about a unit vector (Rodrigues).
glm::dvec3 turned_about(const glm::dvec3& axis, const glm::dvec3& v, double angle) {
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * glm::dot(axis, v) * (1 - std::cos(angle));
}

Camera shifted(Camera camera, const glm::dvec3& by) {
    camera.eye += by;
    camera.center += by;
    return camera;
}

template <typename Visit>
void for_corners(const Grid::Bounds& box, const Visit& visit) {
    for (int corner = 0; corner < 8; ++corner)
        visit(glm::dvec3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z));
}

}  // namespace

ViewAxes axes_of(const Camera& camera) {
    const glm::dvec3 forward = glm::normalize(camera.center - camera.eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    return {right, glm::cross(right, forward), forward};
}

double height_at_center(const Camera& camera) {
    if (camera.projection == Projection::orthographic) return camera.height;
    return 2 * distance_of(camera) * half_height_per_distance(camera);
}

Camera orbited(const Camera& camera, const glm::dvec2& drag) {
    constexpr double pi = 3.14159265358979323846, least = pi / 180;
    const double distance = distance_of(camera);
    const glm::dvec3 pole = glm::normalize(camera.up);
    glm::dvec3 back = (camera.eye - camera.center) / distance;
    const double from_pole = std::acos(std::clamp(glm::dot(back, pole), -1.0, 1.0));
    // A camera that is closer to the pole already stays as close.
    const double closest = std::min({least, from_pole, pi - from_pole});
    const double wanted = std::clamp(from_pole + pi * drag.y, closest, pi - closest);
    back = turned_about(axes_of(camera).right, back, wanted - from_pole);
    back = turned_about(pole, back, -pi * drag.x);
    Camera next = camera;
    next.eye = camera.center + distance * glm::normalize(back);
    return next;
}

Camera panned(const Camera& camera, const glm::dvec2& drag) {
    const ViewAxes axes = axes_of(camera);
    return shifted(camera, -height_at_center(camera) * (drag.x * axes.right + drag.y * axes.up));
}

Camera zoomed(const Camera& camera, double factor, const glm::dvec2& place) {
    const ViewAxes axes = axes_of(camera);
    const double height = height_at_center(camera);
    Camera next = camera;
    if (camera.projection == Projection::orthographic)
        next.height *= factor;
    else
        next.eye = camera.center + factor * (camera.eye - camera.center);
    return shifted(next, height * (1 - factor) * (place.x * axes.right + place.y * axes.up));
}

Camera flown(const Camera& camera, const glm::dvec3& step) {
    const ViewAxes axes = axes_of(camera);
    Camera next = shifted(camera, step.x * axes.right + step.y * axes.up);
    if (camera.projection == Projection::perspective) return shifted(next, step.z * axes.forward);
    next.height *= std::exp(-step.z / camera.height);
    return next;
}

Camera looking_at(const Camera& camera, const glm::dvec3& point) {
    Camera next = camera;
    next.center = point;
    if (camera.projection == Projection::orthographic) {
        next.eye = point - (camera.center - camera.eye);
        return next;
    }
    // If the view direction is parallel to `up`, the picture's own up direction replaces it.
    const glm::dvec3 forward = point - camera.eye;
    const double across =
        glm::length(glm::cross(glm::normalize(forward), glm::normalize(camera.up)));
    if (across < 1e-3) next.up = axes_of(camera).up;
    return next;
}

Camera fitted(const Camera& camera, const Grid::Bounds& box, double aspect) {
    const ViewAxes axes = axes_of(camera);
    const glm::dvec3 middle = .5 * (box.min + box.max);
    const double slope = half_height_per_distance(camera);
    double distance = 0, half_height = 0, reach = 0;
    for_corners(box, [&](const glm::dvec3& corner) {
        const glm::dvec3 from_middle = corner - middle;
        const double across = std::abs(glm::dot(from_middle, axes.right)) / aspect;
        const double needed = std::max(across, std::abs(glm::dot(from_middle, axes.up)));
        const double depth = glm::dot(from_middle, axes.forward);
        distance = std::max(distance, needed / slope - depth);
        half_height = std::max(half_height, needed);
        reach = std::max(reach, glm::length(from_middle));
    });
    Camera next = camera;
    next.center = middle;
    if (camera.projection == Projection::orthographic) {
        next.height = 2 * half_height;
        distance = 2 * reach;
    }
    next.eye = middle - distance * axes.forward;
    return next;
}

Camera seen_from(const Camera& camera, const glm::dvec3& from, const Grid::Bounds& box,
                 double aspect) {
    Camera next = camera;
    next.center = .5 * (box.min + box.max);
    next.eye = next.center + from;
    next.up = from.x == 0 && from.y == 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return fitted(next, box, aspect);
}

Camera with_projection(const Camera& camera, Projection projection) {
    if (projection == camera.projection) return camera;
    const double height = height_at_center(camera);
    Camera next = camera;
    next.projection = projection;
    if (projection == Projection::orthographic) {
        next.height = height;
    } else {
        const double distance = height / 2 / half_height_per_distance(camera);
        next.eye = camera.center - distance * axes_of(camera).forward;
    }
    return next;
}

}  // namespace lamina::view
