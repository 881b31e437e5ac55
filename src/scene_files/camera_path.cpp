// SPDX-License-Identifier: Apache-2.0
#include "scene_files/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/json_text.h"
#include "scene/camera.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"

namespace lamina {
namespace {

// Times that differ by less, in seconds, are equal: rounding of frame / rate is far below it.
constexpr double same_time = 1e-9;
constexpr double longest_path = 1e6;  // seconds: 11 days

// Returns the vector whose direction is the axis and whose length is the angle of a rotation.
glm::dvec3 vector_of(const glm::dquat& rotation) {
    const glm::dvec3 v(rotation.x, rotation.y, rotation.z);
    const double sine = glm::length(v);
    return sine > 0 ? v * (2 * std::atan2(sine, rotation.w) / sine) : glm::dvec3(0);
}

glm::dquat rotation_of(const glm::dvec3& vector) {
    const double angle = glm::length(vector);
    if (angle == 0) return {1, 0, 0, 0};
    return {std::cos(.5 * angle), vector * (std::sin(.5 * angle) / angle)};
}

// Interpolates between unit quaternions along their great circle. It does not take -b for a nearer
// b, as glm::slerp() does: curves would jump.
glm::dquat between(const glm::dquat& a, const glm::dquat& b, double share) {
    const double angle = 2 * std::atan2(glm::length(a - b), glm::length(a + b));
    if (angle < 1e-8) return glm::normalize(a * (1 - share) + b * share);
    return (a * std::sin((1 - share) * angle) + b * std::sin(share * angle)) / std::sin(angle);
}

// A direction of a camera's axes: the size of the picture does not matter.
View view_of(const Camera& camera) {
    return {camera, 1, 1};
}

bool equal(const Camera& a, const Camera& b) {
    return a.eye == b.eye && a.center == b.center && a.up == b.up && a.fov_y == b.fov_y &&
           a.height == b.height;
}

Camera read_camera(JsonReader& keyframe) {
    if (!keyframe.has("camera") || !keyframe.value("camera").is_object())
        keyframe.reject("camera", "an object {...} as in a scene");
    JsonReader reader = keyframe.object("camera");
    Camera camera;
    table_of<camera_keys>().read(reader, camera);
    try {
        view_of(camera);
    } catch (const Error& error) {
        keyframe.fail_at("camera", error.what());
    }
    return camera;
}

double read_time(JsonReader& reader, double before) {
    const double time = reader.number("time");
    if (std::abs(time) > longest_path) reader.reject("time", "seconds, at most 1e6");
    if (time < before + 1e-3)
        reader.reject("time", fmt::format("more than the time before, {}, by .001 s", before));
    return time;
}

}  // namespace

CameraPath::Pose CameraPath::pose_of(const Camera& camera) {
    const View view = view_of(camera);
    const double size = camera.projection == Projection::perspective ? camera.fov_y : camera.height;
    return {glm::quat_cast(glm::dmat3(view.right, view.up, -view.forward)),
            {camera.center.x, camera.center.y, camera.center.z,
             std::log(glm::length(camera.eye - camera.center)), std::log(size)}};
}

CameraPath::Rate CameraPath::rate_between(const Pose& a, const Pose& b, double seconds) {
    Rate rate{vector_of(glm::conjugate(a.axes) * b.axes) / seconds, {}};
    for (std::size_t i = 0; i < rate.numbers.size(); ++i)
        rate.numbers[i] = (b.numbers[i] - a.numbers[i]) / seconds;
    return rate;
}

CameraPath::Rate CameraPath::sum(double factor_a, const Rate& a, double factor_b, const Rate& b) {
    Rate rate{factor_a * a.turn + factor_b * b.turn, {}};
    for (std::size_t i = 0; i < rate.numbers.size(); ++i)
        rate.numbers[i] = factor_a * a.numbers[i] + factor_b * b.numbers[i];
    return rate;
}

CameraPath::Pose CameraPath::moved(const Pose& pose, const Rate& rate, double seconds) {
    Pose moved{pose.axes * rotation_of(seconds * rate.turn), pose.numbers};
    for (std::size_t i = 0; i < moved.numbers.size(); ++i)
        moved.numbers[i] += seconds * rate.numbers[i];
    return moved;
}

CameraPath::Pose CameraPath::mixed(const Pose& a, const Pose& b, double share) {
    Pose mixed{between(a.axes, b.axes, share), {}};
    for (std::size_t i = 0; i < mixed.numbers.size(); ++i)
        mixed.numbers[i] = (1 - share) * a.numbers[i] + share * b.numbers[i];
    return mixed;
}

double CameraPath::length_of(std::size_t segment) const {
    return keyframes_[segment + 1].time - keyframes_[segment].time;
}

CameraPath::Rate CameraPath::rate_along(std::size_t segment) const {
    return rate_between(poses_[segment], poses_[segment + 1], length_of(segment));
}

// Tells whether a neighbour is equal.
bool CameraPath::rests_at(std::size_t keyframe) const {
    const auto equals = [&](std::size_t other) {
        return equal(keyframes_[keyframe].camera, keyframes_[other].camera);
    };
    return (keyframe > 0 && equals(keyframe - 1)) ||
           (keyframe + 1 < keyframes_.size() && equals(keyframe + 1));
}

// Returns the rate at a keyframe. Turns are bounded: within a segment control points lie then less
// than a full turn apart, and the curve between them is one.
CameraPath::Rate CameraPath::rate_at(std::size_t keyframe) const {
    const std::size_t last = keyframes_.size() - 1;
    if (rests_at(keyframe)) return {};
    Rate rate;
    double longest = 0;
    if (keyframe > 0 && keyframe < last) {
        const double before = length_of(keyframe - 1), after = length_of(keyframe);
        rate = sum(after / (before + after), rate_along(keyframe - 1), before / (before + after),
                   rate_along(keyframe));
        longest = std::max(before, after);
    } else {
        const std::size_t segment = keyframe == 0 ? 0 : last - 1;
        const std::size_t inner = keyframe == 0 ? 1 : last - 1;
        rate = rate_along(segment);
        longest = length_of(segment);
        if (last > 1) rate = sum(2, rate, -1, rate_at(inner));
    }
    const double turn = glm::length(rate.turn) * longest;
    if (turn > std::numbers::pi) rate.turn *= std::numbers::pi / turn;
    return rate;
}

CameraPath::CameraPath(std::vector<Keyframe> keyframes) : keyframes_(std::move(keyframes)) {
    for (const Keyframe& keyframe : keyframes_) {
        Pose pose = pose_of(keyframe.camera);
        // A rotation has two quaternions; the nearer one takes the shorter way round.
        if (!poses_.empty() && glm::dot(poses_.back().axes, pose.axes) < 0) pose.axes = -pose.axes;
        poses_.push_back(pose);
    }
    for (std::size_t i = 0; i < keyframes_.size(); ++i) rates_.push_back(rate_at(i));
}

Camera CameraPath::at(double seconds) const {
    const double time = keyframes_.front().time + seconds;
    const auto after = std::ranges::find_if(
        keyframes_, [&](const Keyframe& k) { return k.time > time - same_time; });
    if (after == keyframes_.end()) return keyframes_.back().camera;
    if (after == keyframes_.begin() || after->time < time + same_time) return after->camera;
    const auto end = static_cast<std::size_t>(after - keyframes_.begin()), begin = end - 1;
    if (equal(keyframes_[begin].camera, after->camera)) return after->camera;
    const double length = length_of(begin), share = (time - keyframes_[begin].time) / length;
    std::array<Pose, 4> curve{poses_[begin], moved(poses_[begin], rates_[begin], length / 3),
                              moved(poses_[end], rates_[end], -length / 3), poses_[end]};
    for (std::size_t count = 3; count > 0; --count) {  // de Casteljau's algorithm
        for (std::size_t i = 0; i < count; ++i) curve[i] = mixed(curve[i], curve[i + 1], share);
    }
    const auto& [axes, numbers] = curve[0];
    Camera camera = after->camera;
    camera.center = {numbers[0], numbers[1], numbers[2]};
    camera.eye = camera.center + std::exp(numbers[3]) * (axes * glm::dvec3(0, 0, 1));
    camera.up = axes * glm::dvec3(0, 1, 0);
    const double size = std::exp(numbers[4]);
    if (camera.projection == Projection::perspective)
        camera.fov_y = std::min(size, 179.0);  // the curve may rise above the keyframes
    else
        camera.height = size;
    return camera;
}

std::vector<Camera> CameraPath::cameras(double rate) const {
    std::vector<Camera> cameras;
    const auto last = static_cast<std::int64_t>(std::llround(seconds() * rate));
    for (std::int64_t i = 0; i < last; ++i) cameras.push_back(at(static_cast<double>(i) / rate));
    cameras.push_back(keyframes_.back().camera);
    return cameras;
}

CameraPath read_camera_path(const std::filesystem::path& file) {
    const nlohmann::json document = load_json(file);
    JsonReader reader(document, file);
    std::vector<JsonReader> listed = reader.objects("keyframes");
    reader.close();
    if (listed.size() < 2 || listed.size() > CameraPath::most_keyframes) {
        reader.fail_at("keyframes", fmt::format("found {}, expected 2 to {}", listed.size(),
                                                CameraPath::most_keyframes));
    }
    const bool timed = listed.front().has("time");
    std::vector<Keyframe> keyframes;
    for (JsonReader& one : listed) {
        Keyframe keyframe{static_cast<double>(keyframes.size()), read_camera(one)};
        if (one.has("time") != timed) {
            one.reject("time", timed ? "a time in seconds, as the first keyframe has one"
                                     : "none, as the first keyframe has none");
        }
        if (timed)
            keyframe.time =
                read_time(one, keyframes.empty() ? -2 * longest_path : keyframes.back().time);
        one.close();
        if (!keyframes.empty() &&
            keyframe.camera.projection != keyframes.front().camera.projection) {
            one.fail_at("camera.projection",
                        fmt::format("found {}, expected {} in all keyframes",
                                    name_of(keyframe.camera.projection),
                                    name_of(keyframes.front().camera.projection)));
        }
        keyframes.push_back(keyframe);
    }
    return CameraPath(std::move(keyframes));
}

}  // namespace lamina
