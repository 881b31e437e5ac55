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

// The data that choices are made from: a volume or a mesh, as far as choices need to know it.
class Field {
  public:
    virtual ~Field() = default;

    virtual WorldAxes axes() const = 0;
    virtual ValueRange range() const = 0;  // of the finite values
    // World distance over which the scalar is known to change: of neighbouring samples, the
    // smallest of the axes' (infinite where no axis has two), or the mean edge of the tets.
    virtual double spacing() const = 0;
    // Whether the values are whole numbers, as labels are.
    virtual bool whole_numbers() const = 0;
    // The share of the field that a value has to take to be padding (choice/padding.h).
    virtual double least_padding_share() const = 0;
    // Of the finite values, by volume; of large data evenly chosen ones. Empty where none is
    // finite.
    virtual ValueDistribution distribution() const = 0;

    // Points whose hull contains all that shows more than `least` extinction: corners of parts of
    // the data. Empty where nothing does. least >= 0.
    virtual std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                                 double least) const = 0;
    // The corners of the whole.
    virtual std::array<glm::dvec3, 8> corners() const = 0;

    // The optical depths of some 1000 rays of the scene's view, all over the picture; those of rays
    // that meet no data may be missing. Only transfer function, camera and size of the scene count.
    virtual std::vector<double> optical_depths(const Scene& scene) const = 0;
};

}  // namespace lamina
