// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lamina/mesh.h"
#include "lamina/scene.h"
#include "lamina/settings.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

// A box whose scalar depends on only one of its axes, along which it is linear between samples.
// Along every ray the scalar is then piecewise linear, so every picture of the box has a closed
// form. Points of the box are (u, v, w) in [0, 1]^3.
struct LayeredBox {
    std::vector<double> samples{0, 1};  // along w, at least one; may be NaN
    SampleType type = SampleType::float32;
    glm::dvec3 corner{0};  // world position of (0, 0, 0)
    std::array<glm::dvec3, 3> edges{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // orthogonal
    std::array<std::int64_t, 2> samples_across{2, 2};                    // along u and v
    std::vector<ClipPlane> cuts;  // clip planes that cut it, in world space

    Volume volume() const;

    glm::dvec3 world(const glm::dvec3& place) const;  // world position of (u, v, w)
    glm::dvec3 place(const glm::dvec3& world) const;
    double longest_edge() const;

    std::size_t layers() const { return samples.size() > 1 ? samples.size() - 1 : 1; }
    // Return the layer that contains w, where it begins, and the scalar in it; w is clamped.
    std::size_t layer_at(double w) const;
    double layer_begin(std::size_t layer) const;
    double scalar(std::size_t layer, double w) const;
    // Returns true if a sample of the layer is not finite. Such a layer shows nothing.
    bool is_void(std::size_t layer) const;
    // Returns the range of the finite samples.
    Interval range() const;
};

// The part of a ray inside the box, as an interval of the ray's parameter.
struct BoxChord {
    glm::dvec3 start{0}, step{0};  // the ray in coordinates (u, v, w)
    double world_per_parameter = 1;
    Interval parameters;

    double length() const { return parameters.width() * world_per_parameter; }
    double w(double parameter) const { return start.z + parameter * step.z; }
};

// Returns the chord of the box widened by `slack` on all sides; nothing if the ray misses it.
// `slack` is a share of the edge for sides, and of the longest edge for `cuts`.
std::optional<BoxChord> box_chord(const LayeredBox& box, const View::Ray& ray, double slack);

// The scene that a case of the self-test draws: a layered box, both as a volume and as a mesh.
struct SelftestScene {
    std::string name;
    std::string about;  // why it is stiff or extreme
    LayeredBox box;
    Scene scene;  // transfer function, camera, size, number of slabs; no files
    // Makes tets that fill the box. If it is empty, no mesh is drawn.
    std::function<MeshData(const LayeredBox&)> mesh;
};

// The next functions make meshes that are hard for a renderer. They fill a layered box and have its
// scalar at their corners.

// Makes tets that conform to the layers: across x across cuboids in each layer, six tets each
// (Kuhn).
MeshData kuhn_tets(const LayeredBox& box, int across);

// Makes tets for a box of one layer: 12 * across^2 tets from the middle of the box, which all of
// them share as a corner, to its surface.
MeshData fan_tets(const LayeredBox& box, int across);

// Makes tets for a box of one layer: kuhn_tets(box, 1), in which up to `splits` points each split
// the tet around them into four. The point's distance from a face, an edge or a corner of the tet
// is at most the share `least`, which gives flat tets, slivers and needles.
MeshData split_tets(const LayeredBox& box, int splits, double least, std::uint32_t seed);

// Returns the mesh with its tets, their corners and its points reordered.
MeshData shuffled(const MeshData& mesh, std::uint32_t seed);

}  // namespace lamina::selftest
