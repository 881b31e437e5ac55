// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <vector>

#include "lamina/export.h"

namespace lamina {

struct OpticalProperties {
    glm::dvec3 color{0};    // linear light, not associated, >= 0
    double extinction = 0;  // per world unit, >= 0
    bool operator==(const OpticalProperties&) const = default;
};

struct TransferKnot {
    double value = 0;  // scalar, in the volume's own units
    OpticalProperties optics;
};

// Scalar value to colour and extinction: linear between knots, constant outside them. Two knots at
// one value make a step; at the step's very value the later knot counts. A palette (`nearest`) is
// the same thing with a step halfway between neighbouring points, so nothing else needs to know
// about palettes.
class LAMINA_API TransferFunction {
  public:
    // Knots in order of value, at least one, at most two at one value, all numbers finite, colour
    // and extinction >= 0; else throws Error, naming the point by its index.
    static TransferFunction linear(const std::vector<TransferKnot>& points);
    static TransferFunction nearest(const std::vector<TransferKnot>& points);

    // Points on the straight line between their neighbours are left out.
    std::span<const TransferKnot> knots() const { return knots_; }
    OpticalProperties at(double value) const;
    // With all extinctions times `factor`, at most the largest number that there is.
    TransferFunction attenuated(double factor) const;

    // Largest extinction and the range of colours met over the closed interval [lo, hi] (both sides
    // of steps count).
    double max_extinction(double lo, double hi) const;
    bool transparent(double lo, double hi) const { return max_extinction(lo, hi) == 0; }
    bool constant(double lo, double hi) const;  // same colour and extinction everywhere
    bool constant_extinction(double lo, double hi) const;
    bool constant_color(double lo, double hi) const;  // also of what shows nothing
    bool single_color(double lo,
                      double hi) const;  // the colours of all parts with extinction > 0 are equal

  private:
    explicit TransferFunction(std::span<const TransferKnot> knots);
    std::vector<TransferKnot> knots_;
};

}  // namespace lamina
