// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "facts/drawn_range.h"
#include "mesh/tet_mesh.h"
#include "projection/part_field.h"
#include "projection/screen_polygon.h"
#include "projection/tet_record.h"
#include "scene/camera.h"
#include "visibility/order_graph.h"
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
    // undefined, if the centre of no pixel is covered. `lit`: null if nothing is lit.
    std::optional<FragmentKind> project(const TetPart& part, SilhouetteRecord& record,
                                        ScreenOutline& outline,
                                        GradientRecord* lit = nullptr) const;
    double margin() const { return margin_; }
    const View& view() const { return window_.view(); }

  private:
    // A point relative to the eye, along right, up and forward.
    using Seen = glm::dvec3;

    // The corners of the region of a tet beyond the near plane (z >= near_depth), which is the
    // visible one; at most 6.
    struct VisibleCorners {
        std::size_t count = 0;
        std::array<Seen, 6> seen;
    };
    VisibleCorners clip_near(const std::array<Seen, 4>& corners) const;
    ScreenOutline outline_of(const VisibleCorners& visible, const PartField& field,
                             bool cut_by_near) const;

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
