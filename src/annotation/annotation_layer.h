// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Room at the edges of a picture that an automatic camera leaves to annotations, in pixels.
struct PictureMargins {
    double left = 0, right = 0, top = 0, bottom = 0;
};

// Properties of data that annotations tell.
struct AnnotatedData {
    Quantity quantity;        // of the values
    std::string length_unit;  // empty if it is unknown
    WorldAxes axes = WorldAxes::unnamed;
    // Corners of the data's box in the world: corner number b has the far end of axis i if bit i of
    // b is set.
    std::array<glm::dvec3, 8> corners{};
    ValueRange range;  // of the finite values
    // Labels that occur in the data, with what the file says of them, if values are labels.
    bool are_labels = false;
    std::vector<Label> labels;
};

// Returns the room that the scene's annotations take from an automatic camera. The scene's transfer
// function must be chosen; its camera does not matter.
PictureMargins annotation_margins(const Scene& scene, const AnnotatedData& data);

// Draws the annotations of a picture of the scene, in which nothing may be automatic; returns null
// if it has none. What the picture shows under a text gets a plate. Warns of what cannot be shown.
// Throws Error for texts that are not UTF-8 and for bad formats.
template <typename Real>
std::shared_ptr<const Image> annotation_layer(const Scene& scene, const AnnotatedData& data,
                                              const RgbaImage<Real>& picture);

extern template std::shared_ptr<const Image> annotation_layer(const Scene&, const AnnotatedData&,
                                                              const Image&);
extern template std::shared_ptr<const Image> annotation_layer(const Scene&, const AnnotatedData&,
                                                              const PreciseImage&);

}  // namespace lamina
