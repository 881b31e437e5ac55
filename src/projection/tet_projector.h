// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>

#include "mesh/face_signs.h"
#include "mesh/tet_mesh.h"
#include "projection/screen_polygon.h"
#include "projection/tet_record.h"
#include "projection/window_view.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Projects the tets of a mesh in one view. Safe from many threads.
class TetProjector {
  public:
    // `scalar`: one value a point; `range`: of scalars that becomes [0, 1]. `margin`: see
    // surround(). All must outlive it.
    TetProjector(const TetMesh& mesh, std::span<const double> scalar, const ValueRange& range,
                 const View& view, double near_depth, double margin);

    enum class Result {
        hidden,   // covers the centre of no pixel: the outputs are undefined
        plain,    // the high parts of the depths in float32 are good enough
        careful,  // they are not, or the eye is inside, or the near plane cuts the tet
    };
    Result project(std::int32_t tet, TetRecord& record, ScreenPolygon& polygon) const;

  private:
    // A point relative to the eye: along right, up and forward.
    using Seen = glm::dvec3;

    // `depth` (TetRecord) on a face's plane, as a function of window coordinates from the middle of
    // the picture.
    struct DepthPlane {
        double at_middle, per_column, per_row;
        bool front;
    };
    DepthPlane depth_plane(const Tet& tet, std::size_t face, FaceSigns signs,
                           const std::array<Seen, 4>& corners) const;
    // Of what is visible of a tet.
    struct Extent {
        double columns, rows;  // pixels
        double depth_range;    // at its far end
        bool cut;              // by the near plane
    };
    Result set_depths(const Tet& tet, FaceSigns signs, const std::array<Seen, 4>& corners,
                      const Extent& extent, TetRecord& record) const;
    void set_scalars(const Tet& tet, const std::array<Seen, 4>& corners, TetRecord& record) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    std::span<const double> scalar_;
    ValueRange range_;
    WindowView window_;
    FaceSigner signer_;
    double near_depth_, margin_;
};

}  // namespace lamina
