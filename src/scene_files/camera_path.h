// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "lamina/camera.h"

namespace lamina {

// A camera at a time of a film.
struct Keyframe {
    double time = 0;  // seconds
    Camera camera;
};

// Cameras on a smooth curve in time through keyframes. The camera's axes, which turn about the
// centre, are Bezier curves of rotations (Shoemake, "Animating rotation with quaternion curves",
// SIGGRAPH 1985); the centre and the logarithms of distance and field of view (or height) are cubic
// polynomials. The rate at a keyframe is that of the parabola through it and its neighbours, so
// equal turns in equal times are one steady turn; the rate is 0 beside an equal keyframe, so that
// a rest is a rest.
class CameraPath {
  public:
    static constexpr std::size_t most_keyframes = 10000;

    // Takes keyframes whose times rise and whose projections are equal. Throws Error if a camera
    // has no direction.
    explicit CameraPath(std::vector<Keyframe> keyframes);

    const std::vector<Keyframe>& keyframes() const { return keyframes_; }
    double seconds() const { return keyframes_.back().time - keyframes_.front().time; }
    // Returns the camera at a time, in seconds, since the first keyframe: at a keyframe, its camera
    // itself; before and after all, the nearest one's.
    Camera at(double seconds) const;
    // Returns the cameras of a film: one each 1 / `rate` seconds, from the first keyframe to the
    // last, both included.
    std::vector<Camera> cameras(double rate) const;

  private:
    using Numbers = std::array<double, 5>;  // centre, logarithms of distance and of size

    struct Pose {
        glm::dquat axes{1, 0, 0, 0};  // turns x, y, z to right, up and back
        Numbers numbers{};
    };
    // Change of a pose in a second.
    struct Rate {
        glm::dvec3 turn{0};  // radians, about the pose's own axes
        Numbers numbers{};
    };

    static Pose pose_of(const Camera& camera);
    static Rate rate_between(const Pose& a, const Pose& b, double seconds);
    static Rate sum(double factor_a, const Rate& a, double factor_b, const Rate& b);
    static Pose moved(const Pose& pose, const Rate& rate, double seconds);
    static Pose mixed(const Pose& a, const Pose& b, double share);

    double length_of(std::size_t segment) const;
    Rate rate_along(std::size_t segment) const;
    bool rests_at(std::size_t keyframe) const;
    Rate rate_at(std::size_t keyframe) const;

    std::vector<Keyframe> keyframes_;
    std::vector<Pose> poses_;  // of each keyframe; each turns at most half around from the last
    std::vector<Rate> rates_;  // at each keyframe
};

// Reads a camera path (docs/films.md): {"keyframes": [{"time": 0, "camera": {...}}, ...]}. Times
// may be left out of all keyframes, which are then a second apart. Throws Error, which names file
// and key.
CameraPath read_camera_path(const std::filesystem::path& file);

}  // namespace lamina
