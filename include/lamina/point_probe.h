// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <memory>
#include <optional>

#include "lamina/export.h"

namespace lamina {

// Where a ray has half of its opacity: what an eye takes for the place of what it sees.
struct SeenPoint {
    glm::dvec3 position{0};  // world
    double value = 0;        // of the data there
    double opacity = 0;      // of the whole ray, 0..1
};

// Finds what is seen at a place of a picture: Session::probe(). It has the scene and the data as
// they were then; a copy is cheap, and any thread may use it while the session goes on.
class LAMINA_API PointProbe {
  public:
    struct Parts;
    explicit PointProbe(std::shared_ptr<Parts> parts);

    // The centre of pixel (column, row), row 0 on top, is at whole numbers; places between them and
    // outside of the picture are welcome. Nothing where no ray has any opacity.
    std::optional<SeenPoint> seen(double column, double row) const;

  private:
    std::shared_ptr<Parts> parts_;
};

}  // namespace lamina
