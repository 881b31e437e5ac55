// SPDX-License-Identifier: Apache-2.0
#include "choice/orientation.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/enum_words.h"

namespace lamina {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

// The angles of the three-quarter view, in degrees.
constexpr double three_quarter_azimuth = 30, three_quarter_elevation = 20;

// An axis is the longest if it is this many times as long as each of the others.
constexpr double upright_ratio = 1.25;

// Data are flat if their height is less than this share of each other axis.
constexpr double flat_ratio = .2;

// Returns the opposite direction, whose zeros are not negative: people read them.
glm::dvec3 opposite(const glm::dvec3& direction) {
    return glm::dvec3(0) - direction;
}

// Returns the front of data with this axis up: a positive axis to the right, the eye where the
// three are right-handed. With a negative axis up, the picture is the same, upside down.
Axes front_of(UpAxis up) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    switch (up) {
        case UpAxis::plus_x:
            return {y, x, opposite(z)};
        case UpAxis::minus_x:
            return {opposite(y), opposite(x), opposite(z)};
        case UpAxis::plus_y:
            return {x, y, z};
        case UpAxis::minus_y:
            return {opposite(x), opposite(y), z};
        case UpAxis::plus_z:
            return {x, z, opposite(y)};
        case UpAxis::minus_z:
            return {opposite(x), opposite(z), opposite(y)};
    }
    unreachable_enum();
}

// Returns the front of a patient, whose left is to the right of the picture.
std::optional<Axes> front_of_patient(WorldAxes axes) {
    switch (axes) {
        case WorldAxes::left_posterior_superior:
            return Axes{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
        case WorldAxes::right_anterior_superior:
            return Axes{{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
        case WorldAxes::left_anterior_superior:  // a left-handed world
            return Axes{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
        case WorldAxes::unnamed:
        case WorldAxes::named:
            return std::nullopt;
    }
    unreachable_enum();
}

using Lengths = std::array<double, 3>;  // of a box

Lengths lengths_of(const std::array<glm::dvec3, 8>& corners) {
    Lengths length;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [lo, hi] = std::ranges::minmax(
            corners, {}, [&](const glm::dvec3& corner) { return corner[static_cast<int>(axis)]; });
        length[axis] = hi[static_cast<int>(axis)] - lo[static_cast<int>(axis)];
    }
    return length;
}

// Returns the axis along which the box is longest, if it is so by upright_ratio.
std::optional<UpAxis> longest_axis(const Lengths& length) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double longest_other = std::max(length[(axis + 1) % 3], length[(axis + 2) % 3]);
        if (length[axis] > upright_ratio * longest_other) return static_cast<UpAxis>(2 * axis);
    }
    return std::nullopt;
}

bool along_z(UpAxis up) {
    return up == UpAxis::plus_z || up == UpAxis::minus_z;
}

Orientation chosen_orientation(WorldAxes axes, const Lengths& length, bool axial_slices) {
    if (axes == WorldAxes::named) {
        Orientation found{front_of(UpAxis::plus_z), false,
                          "z is up, as in meshes and where axes have names"};
        found.flat = length[2] < flat_ratio * std::min(length[0], length[1]);
        if (found.flat) found.reason += "; what is flat is seen from above";
        return found;
    }
    if (axial_slices) {
        return {front_of(UpAxis::minus_z), false,
                "-z is up, as in axial slices of a body from head to feet, which these seem to be"};
    }
    const auto longest = longest_axis(length);
    if (!longest) return {front_of(UpAxis::plus_y), false, "y is up, no axis is much the longest"};
    // Rows of pictures that are wider than high stay level, and so does what lies along x.
    if (*longest == UpAxis::plus_x)
        return {front_of(UpAxis::plus_y), false, "y is up, x is the longest axis and lies level"};
    return {front_of(*longest), false,
            fmt::format("{}, the longest axis, is up", name_of(*longest) + 1)};
}

}  // namespace

const char* name_of(UpAxis axis) {
    static constexpr const char* words[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
    return word_of(axis, words);
}

const char* name_of(ViewSide side) {
    static constexpr const char* words[] = {"iso",   "front", "back",  "left",
                                            "right", "top",   "bottom"};
    return word_of(side, words);
}

Axes turned(const Axes& axes, const ViewTurn& turn) {
    const double a = turn.azimuth * radians_per_degree, e = turn.elevation * radians_per_degree;
    const glm::dvec3 right = std::cos(a) * axes.right - std::sin(a) * axes.toward;
    const glm::dvec3 around = std::sin(a) * axes.right + std::cos(a) * axes.toward;
    return {right, std::cos(e) * axes.up - std::sin(e) * around,
            std::sin(e) * axes.up + std::cos(e) * around};
}

Orientation orientation_of(WorldAxes axes, const std::array<glm::dvec3, 8>& corners,
                           std::optional<UpAxis> up, bool axial_slices) {
    const std::optional<Axes> patient = front_of_patient(axes);
    if (!up) {
        if (patient) return {*patient, true, "the patient's head is up"};
        return chosen_orientation(axes, lengths_of(corners), axial_slices);
    }
    const std::string reason = fmt::format("{} is up, as asked", name_of(*up));
    if (!patient || !along_z(*up)) return {front_of(*up), false, reason};
    if (*up == UpAxis::plus_z) return {*patient, true, reason};
    // Upside down, the patient's left is on the left of the picture.
    return {{opposite(patient->right), opposite(patient->up), patient->toward}, false, reason};
}

namespace {

// Returns the direction among `first`, `second` and their opposites that is nearest to `wanted`.
glm::dvec3 nearest(const glm::dvec3& wanted, const glm::dvec3& first, const glm::dvec3& second) {
    const double one = glm::dot(wanted, first), other = glm::dot(wanted, second);
    if (std::abs(one) >= std::abs(other)) return one < 0 ? opposite(first) : first;
    return other < 0 ? opposite(second) : second;
}

// Returns the axes of a camera for these directions in the picture, which need not be at right
// angles.
Axes axes_of(const glm::dvec3& right, const glm::dvec3& up) {
    Axes axes{glm::normalize(right), {}, {}};
    axes.up = glm::normalize(up - glm::dot(up, axes.right) * axes.right);
    axes.toward = glm::cross(axes.right, axes.up);
    return axes;
}

// Returns a slice's axes with the patient's left or, of sagittal slices, back to the right.
Axes patient_axes(const Axes& patient, const glm::dvec3& first, const glm::dvec3& second) {
    const glm::dvec3 across = glm::cross(first, second);
    const glm::dvec3 left = patient.right, head = patient.up, front = patient.toward;
    const double along_body = std::abs(glm::dot(across, head));
    const double sideways = std::abs(glm::dot(across, left));
    const double forward = std::abs(glm::dot(across, front));
    const bool axial = along_body >= std::max(sideways, forward);
    const bool sagittal = !axial && sideways > forward;
    const glm::dvec3 up = nearest(axial ? front : head, first, second);
    const glm::dvec3 rest = std::abs(glm::dot(up, first)) > .5 ? second : first;
    const glm::dvec3 wanted = sagittal ? opposite(front) : left;
    return axes_of(glm::dot(wanted, rest) < 0 ? opposite(rest) : rest, up);
}

}  // namespace

std::optional<Orientation> orientation_of_slice(const SliceAxes& slice, WorldAxes axes,
                                                std::optional<UpAxis> up) {
    const Axes plane = axes_of(slice.right, opposite(slice.down));
    const std::optional<Axes> patient = front_of_patient(axes);
    Orientation found{
        patient ? patient_axes(*patient, plane.right, opposite(plane.up)) : plane, false,
        patient ? "one slice is seen straight, with the patient's left, or back, to the right"
                : "one slice is seen straight, its first axis to the right and its second down"};
    found.straight = true;
    if (!up) return found;
    constexpr double least_in_plane = .7;  // cosine: half a right angle
    const Axes before = found.front;
    const glm::dvec3 asked = front_of(*up).up;
    const glm::dvec3 highest = nearest(asked, before.right, before.up);
    if (glm::dot(asked, highest) < least_in_plane) return std::nullopt;
    const bool turned = std::abs(glm::dot(highest, before.right)) > .5;
    found.front = axes_of(turned ? opposite(before.up) : before.right, highest);
    found.reason = fmt::format("one slice is seen straight; {} is up, as asked", name_of(*up));
    return found;
}

ViewTurn turn_to(ViewSide side, const Orientation& orientation) {
    // The left of a patient who stands upright is to the right of who looks from in front.
    const double left = orientation.patient ? 90 : -90;
    switch (side) {
        case ViewSide::iso:
            if (orientation.straight) return {};
            if (orientation.flat) return turn_to(ViewSide::top, orientation);
            return {three_quarter_azimuth, three_quarter_elevation};
        case ViewSide::front:
            return {0, 0};
        case ViewSide::back:
            return {180, 0};
        case ViewSide::left:
            return {left, 0};
        case ViewSide::right:
            return {-left, 0};
        case ViewSide::top:
            return {0, 90};
        case ViewSide::bottom:
            return {0, -90};
    }
    unreachable_enum();
}

}  // namespace lamina
