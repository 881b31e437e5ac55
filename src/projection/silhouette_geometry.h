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

// Projects each tet as one polygon around it. The fragments find the front and the back from the
// planes of the faces.
class SilhouetteGeometry : public TetGeometry {
  public:
    explicit SilhouetteGeometry(const TetProjector& projector) : projector_(projector) {}
    static Size largest_size(bool lit);
    Written write(const TetPart& part, const Place& place) const override;

  private:
    TetProjector projector_;
};

}  // namespace lamina
