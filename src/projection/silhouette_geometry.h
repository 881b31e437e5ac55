// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "projection/tet_geometry.h"
#include "projection/tet_projector.h"

namespace lamina {

// A corner of the polygon around a tet (shaders/projection/silhouette.vert).
struct SilhouetteVertex {
    glm::vec2 position;  // window coordinates
    std::uint32_t record;
};

// One polygon around each tet, whose fragments find front and back on the planes of the faces.
class SilhouetteGeometry : public TetGeometry {
  public:
    explicit SilhouetteGeometry(const TetProjector& projector) : projector_(projector) {}
    static Size largest_size();
    Written write(const TetPart& part, const Place& place) const override;

  private:
    TetProjector projector_;
};

}  // namespace lamina
