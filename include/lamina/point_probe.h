// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <memory>
#include <optional>

#include "lamina/export.h"

namespace lamina {

// Point at which a ray has half of its opacity: what an eye takes for the place of what it sees.
struct SeenPoint {
    glm::dvec3 position{0};  // world
    double value = 0;        // value of the data there
    double opacity = 0;      // opacity of the whole ray, 0..1
};

// Finds what is seen at a place of a picture. Session::probe() makes it, with the scene and the
// data as they are then. A copy is cheap, and any thread may use it while the session goes on.
class LAMINA_API PointProbe {
  public:
    struct Parts;
    explicit PointProbe(std::shared_ptr<Parts> parts);

    // Returns the point that is seen at (column, row), or nothing if the ray there has no opacity.
    // Whole numbers are the centres of pixels, row 0 on top; fractions and places outside the
    // picture are allowed.
    std::optional<SeenPoint> seen(double column, double row) const;

  private:
    std::shared_ptr<Parts> parts_;
};

}  // namespace lamina
