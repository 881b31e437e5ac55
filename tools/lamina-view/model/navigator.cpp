// SPDX-License-Identifier: Apache-2.0
#include "model/navigator.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace lamina::view {
namespace {

constexpr double double_click_seconds = .4, double_click_reach = 5;  // reach: pointer units
// Time for which the camera counts as moving after a step, because another step may follow.
constexpr double step_seconds = .2;
constexpr double zoom_of_wheel = .88;  // one step of the wheel multiplies the view's height by this
constexpr double zoom_of_height = 4;   // a drag over the picture's height zooms by e^4
constexpr double fly_share = .02;      // length of a key's step, as a share of the data's diagonal

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

std::optional<double> CameraControl::rest_at() const {
    return steps_until_ > 0 ? std::optional(steps_until_) : std::nullopt;
}

void CameraControl::step_until(double seconds) {
    steps_until_ = seconds + step_seconds;
}

bool CameraControl::handle(const InputEvent& event, const Around& around, Document& document) {
    if (event.kind == InputEvent::Kind::release && dragging_ && event.button == button_) {
        dragging_ = false;
        return true;
    }
    if (!document.is_open() || document.scene().camera.is_automatic()) return false;
    switch (event.kind) {
        case InputEvent::Kind::press:
            return press(event, around, document);
        case InputEvent::Kind::pointer:
            return drag(event, around, document);
        case InputEvent::Kind::wheel:
            if (!around.area.contains(last_)) return false;
            document.set_camera(zoomed(*document.scene().camera,
                                       std::pow(zoom_of_wheel, event.place.y),
                                       around.area.share(last_)));
            step_until(event.seconds);
            return true;
        case InputEvent::Kind::key:
            return key(event, around, document);
        default:
            return false;
    }
}

bool CameraControl::press(const InputEvent& event, const Around& around, Document& document) {
    if (!around.area.contains(event.place) || dragging_) return false;
    const bool twice = event.button == PointerButton::left && pressed_at_ >= 0 &&
                       event.seconds - pressed_at_ < double_click_seconds &&
                       glm::distance(event.place, pressed_) < double_click_reach;
    pressed_at_ = twice || event.button != PointerButton::left ? -1 : event.seconds;
    pressed_ = last_ = event.place;
    if (twice) {
        const glm::dvec2 pixel = around.area.pixel(event.place);
        const auto seen = around.probe ? around.probe->seen(pixel.x, pixel.y) : std::nullopt;
        if (seen) document.set_camera(looking_at(*document.scene().camera, seen->position));
        return true;
    }
    dragging_ = true;
    button_ = event.button;
    motion_ = event.button == PointerButton::right                   ? Motion::zoom
              : event.button == PointerButton::middle || event.shift ? Motion::pan
                                                                     : Motion::orbit;
    return true;
}

bool CameraControl::drag(const InputEvent& event, const Around& around, Document& document) {
    const glm::dvec2 moved = around.area.share(event.place) - around.area.share(last_);
    last_ = event.place;
    if (!dragging_ || moved == glm::dvec2(0)) return false;
    const Camera& camera = *document.scene().camera;
    switch (motion_) {
        case Motion::orbit:
            document.set_camera(orbited(camera, moved));
            break;
        case Motion::pan:
            document.set_camera(panned(camera, moved));
            break;
        case Motion::zoom:
            document.set_camera(zoomed(camera, std::exp(-zoom_of_height * moved.y)));
            break;
    }
    return true;
}

bool CameraControl::key(const InputEvent& event, const Around& around, Document& document) {
    if (event.control) return false;
    if (event.key >= '1' && event.key <= '6') {
        const int number = event.key - '1';
        see_axis(number / 2, number % 2 == 0 ? 1 : -1, around, document);
        return true;
    }
    if (event.key >= 'X' && event.key <= 'Z') {
        see_axis(event.key - 'X', event.shift ? -1 : 1, around, document);
        return true;
    }
    switch (event.key) {
        case 'F':
            fit(around, document);
            return true;
        case 'P':
            set_projection(document, document.scene().camera->projection == Projection::perspective
                                         ? Projection::orthographic
                                         : Projection::perspective);
            return true;
        case key::home:
            document.choose_camera();
            return true;
        default:
            return fly(event, around, document);
    }
}

bool CameraControl::fly(const InputEvent& event, const Around& around, Document& document) {
    glm::dvec3 way(0);
    switch (event.key) {
        case 'A':
        case 'D':
            way.x = event.key == 'D' ? 1 : -1;
            break;
        case 'Q':
        case 'E':
            way.y = event.key == 'E' ? 1 : -1;
            break;
        case 'S':
        case 'W':
            way.z = event.key == 'W' ? 1 : -1;
            break;
        default:
            return false;
    }
    const double diagonal = glm::distance(around.bounds.min, around.bounds.max);
    document.set_camera(flown(*document.scene().camera, fly_share * diagonal * way));
    step_until(event.seconds);
    return true;
}

void CameraControl::set_projection(Document& document, Projection projection) const {
    document.set_camera(with_projection(*document.scene().camera, projection));
}

void CameraControl::fit(const Around& around, Document& document) const {
    document.set_camera(fitted(*document.scene().camera, around.bounds, around.area.aspect()));
}

void CameraControl::see_axis(int axis, double sign, const Around& around,
                             Document& document) const {
    glm::dvec3 from(0);
    from[axis] = sign;
    document.set_camera(
        seen_from(*document.scene().camera, from, around.bounds, around.area.aspect()));
}

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
    // A camera that is already closer to the pole may stay as close.
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
