// SPDX-License-Identifier: Apache-2.0
#include "model/navigator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamina::view {
namespace {

using Kind = InputEvent::Kind;

class CameraControls : public testing::Test {
  protected:
    CameraControls() {
        document_.open(Scene());
        camera_ = *document_.scene().camera;
    }

    bool pointer(double x, double y) { return handle({.kind = Kind::pointer, .place = {x, y}}); }
    bool press(PointerButton button, double x, double y, bool shift = false) {
        return handle({.kind = Kind::press,
                       .seconds = seconds_,
                       .place = {x, y},
                       .button = button,
                       .shift = shift});
    }
    bool release(PointerButton button) { return handle({.kind = Kind::release, .button = button}); }
    bool key(int key) { return handle({.kind = Kind::key, .seconds = seconds_, .key = key}); }
    bool handle(const InputEvent& event) { return control_.handle(event, around_, document_); }
    const Camera& now() const { return *document_.scene().camera; }

    Document document_;
    Camera camera_;
    CameraControl control_;
    // The picture in the window, in pixels: 400 x 200, its corner at (10, 20); and the bounds of
    // the data.
    CameraControl::Around around_{{{10, 20}, {400, 200}, 800}, {{-1, -1, -1}, {1, 1, 1}}, nullptr};
    double seconds_ = 1;
};

TEST_F(CameraControls, TheButtonDecidesWhatADragDoes) {
    struct Case {
        PointerButton button;
        bool shift;
        Camera expected;
    };
    const glm::dvec2 drag(.25, .1);  // in heights of the picture: 50 pixels to the right, 20 up
    for (const Case& a : {Case{PointerButton::left, false, orbited(camera_, drag)},
                          Case{PointerButton::left, true, panned(camera_, drag)},
                          Case{PointerButton::middle, false, panned(camera_, drag)},
                          Case{PointerButton::right, false, zoomed(camera_, std::exp(-.4))}}) {
        document_.set_camera(camera_);
        EXPECT_TRUE(press(a.button, 100, 100, a.shift));
        EXPECT_TRUE(control_.moving(seconds_));
        EXPECT_TRUE(pointer(150, 80));
        EXPECT_NEAR(now().eye.x, a.expected.eye.x, 1e-12);
        EXPECT_NEAR(now().eye.y, a.expected.eye.y, 1e-12);
        EXPECT_NEAR(now().eye.z, a.expected.eye.z, 1e-12);
        EXPECT_TRUE(release(a.button));
        EXPECT_FALSE(control_.moving(seconds_));
        EXPECT_FALSE(pointer(200, 80));
        seconds_ += 10;
    }
}

TEST_F(CameraControls, EventsOutsideThePictureChangeNothing) {
    EXPECT_FALSE(press(PointerButton::left, 5, 100));
    EXPECT_FALSE(pointer(150, 80));
    pointer(411, 100);
    EXPECT_FALSE(handle({.kind = Kind::wheel, .place = {0, 1}}));
    EXPECT_EQ(now().eye, camera_.eye);
}

TEST_F(CameraControls, StepsCountAsMovingForAMoment) {
    pointer(110, 120);
    EXPECT_TRUE(handle({.kind = Kind::wheel, .seconds = seconds_, .place = {0, 1}}));
    EXPECT_LT(height_at_center(now()), height_at_center(camera_));
    EXPECT_TRUE(control_.moving(seconds_ + .1));
    EXPECT_FALSE(control_.moving(seconds_ + 1));
    const Camera before = now();
    EXPECT_TRUE(key('W'));
    EXPECT_LT(now().eye.z, before.eye.z);
    EXPECT_FALSE(key('J'));
}

TEST_F(CameraControls, KeysTurnTheViewAlongAxes) {
    for (int i = 0; i < 6; ++i) {
        EXPECT_TRUE(key('1' + i));
        glm::dvec3 from(0);
        from[i / 2] = i % 2 == 0 ? 1 : -1;
        EXPECT_EQ(now().eye, seen_from(camera_, from, around_.bounds, 2).eye);
    }
    EXPECT_TRUE(key('P'));
    EXPECT_EQ(now().projection, Projection::orthographic);
    EXPECT_TRUE(key(key::home));
    EXPECT_TRUE(document_.scene().camera.is_automatic());
    EXPECT_FALSE(key('1'));  // while the camera is automatic, no key turns it
}

}  // namespace
}  // namespace lamina::view
