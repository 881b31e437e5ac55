// SPDX-License-Identifier: Apache-2.0
#include "model/camera_control.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "model/navigator.h"

namespace lamina::view {
namespace {

constexpr double double_click_seconds = .4, double_click_reach = 5;
constexpr double step_seconds = .2;    // after a step another one may follow
constexpr double zoom_of_wheel = .88;  // for a step of the wheel
constexpr double zoom_of_height = 4;   // e to this, for a drag over the picture's height
constexpr double fly_share = .02;      // of the data's diagonal, for each step

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
    way_ = event.button == PointerButton::right                   ? Way::zoom
           : event.button == PointerButton::middle || event.shift ? Way::pan
                                                                  : Way::orbit;
    return true;
}

bool CameraControl::drag(const InputEvent& event, const Around& around, Document& document) {
    const glm::dvec2 moved = around.area.share(event.place) - around.area.share(last_);
    last_ = event.place;
    if (!dragging_ || moved == glm::dvec2(0)) return false;
    const Camera& camera = *document.scene().camera;
    switch (way_) {
        case Way::orbit:
            document.set_camera(orbited(camera, moved));
            break;
        case Way::pan:
            document.set_camera(panned(camera, moved));
            break;
        case Way::zoom:
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

}  // namespace lamina::view
