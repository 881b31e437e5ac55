// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "facts/tet_pieces.h"
#include "mesh/tet_mesh.h"
#include "projection/fragment_kind.h"
#include "projection/gradient_record.h"
#include "projection/part_field.h"
#include "projection/screen_polygon.h"
#include "projection/tet_part.h"
#include "projection/tet_record.h"
#include "projection/window_view.h"
#include "scene/camera.h"
#include "visibility/face_signs.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Projects tets or cell fragments in one view. Safe from many threads.
class TetProjector {
  public:
    // `scalar`: one value a point. `range`: the scalars that become [0, 1] in whole tets. `pieces`:
    // the pieces that cell fragments refer to. `margin`: see pixel_bounds(). `gradients`: at the
    // points, for project() with `lit`. All arguments must outlive it.
    TetProjector(const TetMesh& mesh, std::span<const double> scalar, const ValueRange& range,
                 const TetPieces& pieces, const View& view, double near_depth, double margin,
                 std::span<const glm::vec3> gradients = {});

    // Fills the record and the outline, and returns the kind of its fragments. The outline covers
    // the cell fragment and may cover more of its tet. Returns nothing, and leaves the outputs
    // undefined, where the centre of no pixel is covered. `lit`: null where nothing is lit.
    std::optional<FragmentKind> project(const TetPart& part, SilhouetteRecord& record,
                                        ScreenOutline& outline,
                                        GradientRecord* lit = nullptr) const;
    double margin() const { return margin_; }
    const View& view() const { return window_.view(); }

  private:
    // A point relative to the eye, along right, up and forward.
    using Seen = glm::dvec3;

    // The `Depth` (tet_record.h) on a plane, as a linear function of window coordinates relative to
    // the middle of the picture.
    struct DepthPlane {
        double at_middle, per_column, per_row;
        bool front;
    };
    DepthPlane depth_plane(const Tet& tet, std::size_t face, FaceSigns signs,
                           const std::array<Seen, 4>& corners) const;
    DepthPlane level_plane(const PartField& field, double level) const;
    // The corners of the region of a tet beyond the near plane (z >= near_depth), which is what can
    // be seen of it; at most 6.
    struct VisibleCorners {
        std::size_t count = 0;
        std::array<Seen, 6> seen;
    };
    VisibleCorners clip_near(const std::array<Seen, 4>& corners) const;
    // The size of that region.
    struct Extent {
        double columns, rows;  // pixels
        double depth_range;    // thickness of the tet in `Depth` at its far end
        bool cut;              // whether the near plane cuts the tet
    };
    Extent place_center(const VisibleCorners& visible, SeenTet& record) const;
    ScreenOutline outline_of(const VisibleCorners& visible, const PartField& field,
                             bool cut_by_near) const;
    // Returns whether float32 is good enough for the depths.
    bool set_depths(const Tet& tet, FaceSigns signs, const std::array<Seen, 4>& corners,
                    const Extent& extent, SilhouetteRecord& record) const;
    double inverted(double value) const;
    // A linear function: at the center, per z, per column and per row.
    using Linear = std::array<double, 4>;
    Linear linear(const PartField& field, double origin, double scale, const SeenTet& record) const;
    // Returns whether float32 is good enough for the scalars.
    bool set_whole(const PartField& field, TetRecord& record) const;
    void set_gradients(const Tet& tet, const std::array<Seen, 4>& corners, const SeenTet& record,
                       GradientRecord& lit) const;
    void set_part(const PartField& field, const LinearPiece& piece, FragmentRecord& record) const;
    std::array<float, 3> plane_at_center(const DepthPlane& plane, const SeenTet& record) const;
    double depth_at_center(const DepthPlane& plane, const SeenTet& record) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    std::span<const double> scalar_;
    std::span<const glm::vec3> gradients_;
    ValueRange range_;
    const TetPieces& pieces_;
    WindowView window_;
    FaceSigner signer_;
    double near_depth_, margin_;
};

}  // namespace lamina
