// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "visibility/face_signs.h"
#include "mesh/tet_mesh.h"
#include "projection/fragment_kind.h"
#include "projection/part_field.h"
#include "projection/screen_polygon.h"
#include "projection/tet_part.h"
#include "projection/tet_record.h"
#include "projection/window_view.h"
#include "scene/camera.h"
#include "facts/tet_pieces.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Projects tets, or parts of them, in one view. Safe from many threads.
class TetProjector {
  public:
    // `scalar`: one value a point; `range`: of scalars that becomes [0, 1] in whole tets; `pieces`:
    // that parts are of. `margin`: see pixel_bounds(). All must outlive it.
    TetProjector(const TetMesh& mesh, std::span<const double> scalar, const ValueRange& range,
                 const TetPieces& pieces, const View& view, double near_depth, double margin);

    // What its fragments need; none where it covers the centre of no pixel: the outputs are
    // undefined. The outline covers the part and may cover more of its tet.
    std::optional<FragmentKind> project(const TetPart& part, TetRecord& record,
                                        ScreenOutline& outline) const;
    double margin() const { return margin_; }
    const View& view() const { return window_.view(); }

  private:
    // A point relative to the eye: along right, up and forward.
    using Seen = glm::dvec3;

    // `depth` (TetRecord) on a plane, as a function of window coordinates from the middle of the
    // picture.
    struct DepthPlane {
        double at_middle, per_column, per_row;
        bool front;
    };
    DepthPlane depth_plane(const Tet& tet, std::size_t face, FaceSigns signs,
                           const std::array<Seen, 4>& corners) const;
    DepthPlane level_plane(const PartField& field, double level) const;
    // The part of a tet in front of the near plane has at most 6 corners.
    struct VisibleCorners {
        std::size_t count = 0;
        std::array<Seen, 6> seen;
    };
    VisibleCorners clip_near(const std::array<Seen, 4>& corners) const;
    // Of what is visible of a tet.
    struct Extent {
        double columns, rows;  // pixels
        double depth_range;    // at its far end
        bool cut;              // by the near plane
    };
    Extent place_center(const VisibleCorners& visible, TetRecord& record) const;
    ScreenOutline outline_of(const VisibleCorners& visible, const PartField& field,
                             bool cut_by_near) const;
    // True where float32 is good enough.
    bool set_depths(const Tet& tet, FaceSigns signs, const std::array<Seen, 4>& corners,
                    const Extent& extent, TetRecord& record) const;
    double inverted(double value) const;
    void set_scalars(const PartField& field, double origin, double width, TetRecord& record) const;
    void set_part(const PartField& field, const LinearPiece& piece, TetRecord& record) const;
    std::array<float, 3> plane_at_center(const DepthPlane& plane, const TetRecord& record) const;
    double depth_at_center(const DepthPlane& plane, const TetRecord& record) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    std::span<const double> scalar_;
    ValueRange range_;
    const TetPieces& pieces_;
    WindowView window_;
    FaceSigner signer_;
    double near_depth_, margin_;
};

}  // namespace lamina
