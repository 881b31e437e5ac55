// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

#include "lamina/error.h"

namespace lamina {

// Colour and extinction of the medium.
struct OpticalProperties {
    glm::dvec3 color{0};    // in the scene's colour space, not associated, >= 0
    double extinction = 0;  // per world unit, >= 0
    bool operator==(const OpticalProperties&) const = default;
};

// A point of a transfer function.
struct TransferKnot {
    double value = 0;  // scalar, in the volume's own units
    OpticalProperties optics;
    // True if extinction is meant as a curve without a corner here, and the straight pieces on both
    // sides are an approximation. Pictures may follow such a curve, within 1.3e-3 of the pieces'
    // extinction.
    bool smooth = false;
    bool operator==(const TransferKnot&) const = default;
};

// A point of a transfer function that is given by opacity, as in VTK and ParaView.
struct OpacityKnot {
    double value = 0;
    glm::dvec3 color{1};
    double opacity = 0;  // 0..1, over a unit length
};

// Maps a scalar value to colour and extinction, linearly between knots and constant outside them.
// Two knots at one value make a step; at that value itself the later knot counts. A palette
// (`nearest`) has a step halfway between neighbouring points. A palette is stored as these steps,
// so no other code needs to know of palettes.
class LAMINA_API TransferFunction {
  public:
    // Makes a transfer function from knots in order of value. There must be at least one, and at
    // most two at one value; all numbers must be finite, colour and extinction >= 0. Else throws
    // Error, which names the point by its index.
    static TransferFunction linear(const std::vector<TransferKnot>& points);
    static TransferFunction nearest(const std::vector<TransferKnot>& points);
    // Makes a transfer function whose opacity over `unit_length` > 0 world units is linear between
    // points. Its knots follow the extinction that this means within 7.8e-4 of the extinction, so
    // that no ray is off by more than .1 / 255 (docs/precision.md, "Opacity that is linear").
    static TransferFunction linear_opacity(const std::vector<OpacityKnot>& points,
                                           double unit_length = 1);

    // Tells whether values are codes of a volume's labels (lamina/volume.h, VolumeLabels), and not
    // the file's numbers. It matters only if the volume is renumbered.
    bool of_codes() const { return of_codes_; }
    // Returns this function with values that are codes of labels, and which labels these are:
    // empty if that is not known, as if a user wrote the function.
    TransferFunction with_codes(std::string labels = {}) const;
    const std::string& labels() const { return labels_; }

    // Returns the knots, without those that lie on the straight line between their neighbours.
    std::span<const TransferKnot> knots() const { return knots_; }
    OpticalProperties at(double value) const;
    // Returns this function with all extinctions times `factor`, clamped to the largest finite
    // number.
    TransferFunction attenuated(double factor) const;
    bool operator==(const TransferFunction&) const = default;

    // The functions of lo and hi are about the closed interval [lo, hi]; both sides of a step in it
    // count.
    double max_extinction(double lo, double hi) const;
    bool transparent(double lo, double hi) const { return max_extinction(lo, hi) == 0; }
    bool constant(double lo, double hi) const;  // one colour and one extinction
    bool constant_extinction(double lo, double hi) const;
    bool constant_color(double lo, double hi) const;  // colours where extinction is 0 count, too
    // Returns true if all values with extinction > 0 have one colour.
    bool single_color(double lo, double hi) const;

  private:
    explicit TransferFunction(std::span<const TransferKnot> knots);
    std::vector<TransferKnot> knots_;
    // Largest extinction of each `block` knots: labels make functions of 100,000 knots, and every
    // brick asks for its largest extinction.
    static constexpr std::size_t block = 256;
    std::vector<double> largest_;
    bool of_codes_ = false;
    std::string labels_;
};

}  // namespace lamina
