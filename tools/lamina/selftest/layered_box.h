// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "lamina/clip.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "selftest/interval.h"

namespace lamina::selftest {

// A box whose scalar depends on one of its axes alone and is linear between samples there. Along
// every ray the scalar is piecewise linear, so every picture of the box has a closed form. Points
// of the box are (u, v, w) in [0, 1]^3.
struct LayeredBox {
    std::vector<double> samples{0, 1};  // along w, at least one; may be NaN
    SampleType type = SampleType::float32;
    glm::dvec3 corner{0};  // world position of (0, 0, 0)
    std::array<glm::dvec3, 3> edges{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // orthogonal
    std::array<std::int64_t, 2> samples_across{2, 2};                    // along u and v
    std::vector<ClipPlane> cuts;  // planes that cut it, world space

    Volume volume() const;

    glm::dvec3 world(const glm::dvec3& place) const;  // world position of (u, v, w)
    glm::dvec3 place(const glm::dvec3& world) const;
    double longest_edge() const;

    std::size_t layers() const { return samples.size() > 1 ? samples.size() - 1 : 1; }
    // The layer that contains w, and the scalar there; w is clamped.
    std::size_t layer_at(double w) const;
    double layer_begin(std::size_t layer) const;
    double scalar(std::size_t layer, double w) const;
    // Whether a layer has a sample that is not finite; it then shows nothing.
    bool is_void(std::size_t layer) const;
    // The range of the finite samples.
    Interval range() const;
};

// The segment of a ray inside the box, by the ray's parameter.
struct BoxChord {
    glm::dvec3 start{0}, step{0};  // the ray in coordinates (u, v, w)
    double world_per_parameter = 1;
    Interval parameters;

    double length() const { return parameters.width() * world_per_parameter; }
    double w(double parameter) const { return start.z + parameter * step.z; }
};

// The chord of the box widened by `slack` (a share of each edge) on all sides, cuts included (by
// that share of the longest edge); empty where the ray misses it.
std::optional<BoxChord> box_chord(const LayeredBox& box, const View::Ray& ray, double slack);

}  // namespace lamina::selftest
