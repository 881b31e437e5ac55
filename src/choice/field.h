// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

#include "choice/value_distribution.h"
#include "lamina/grid.h"
#include "lamina/scene.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The data that choices are made from, a volume or a mesh, reduced to what choices need.
class Field {
  public:
    virtual ~Field() = default;

    virtual WorldAxes axes() const = 0;
    virtual ValueRange range() const = 0;  // range of the finite values
    // Returns the world distance over which the scalar is known to change: the smallest distance of
    // neighbouring samples (infinite if no axis has two), or the mean edge of the tets.
    virtual double spacing() const = 0;
    // Tells whether all values are whole, as labels are.
    virtual bool whole_numbers() const = 0;
    // Returns the share of the field that a value must have to be padding (choice/padding.h).
    virtual double least_padding_share() const = 0;
    // Returns the distribution of the finite values, by volume; large data are sampled evenly.
    // Empty if none is finite.
    virtual ValueDistribution distribution() const = 0;

    // Returns points whose hull contains everything with more than `least` >= 0 extinction: corners
    // of parts of the data. Empty if there is nothing.
    virtual std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                                 double least) const = 0;
    // The corners of the data's bounding box.
    virtual std::array<glm::dvec3, 8> corners() const = 0;

    // Returns the optical depths of about 1000 rays of the scene's view, spread over the picture;
    // rays that miss the data may be left out. Only transfer function, camera and size of the scene
    // matter.
    virtual std::vector<double> optical_depths(const Scene& scene) const = 0;
};

}  // namespace lamina
