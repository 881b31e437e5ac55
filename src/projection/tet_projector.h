// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>

#include <cstdint>
#include <optional>
#include <vector>

#include "facts/drawn_range.h"
#include "lamina/settings.h"
#include "mesh/tet_mesh.h"
#include "optics/pieces.h"
#include "projection/screen_polygon.h"
#include "projection/tet_record.h"
#include "scene/camera.h"
#include "visibility/order_graph.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The scalar in a tet, linear in space, and the region of the tet that is drawn: the whole tet, or
// a cell fragment, in which the scalar stays within one linear piece of the transfer function.
class TetField {
  public:
    using Corners = std::array<glm::dvec3, 4>;
    using Values = std::array<double, 4>;  // scalars at the corners

    // `piece`: a piece with from < to, or null to draw the whole tet. `corners` must outlive this.
    TetField(const Corners& corners, const Values& values, const LinearPiece* piece);

    double least() const { return least_; }      // least scalar of the drawn region
    double largest() const { return largest_; }  // largest scalar of the drawn region
    // Tell whether the tet also has scalars below least() or above largest(). The drawn region then
    // ends at the plane on which the scalar has that value.
    bool cut_low() const { return cut_low_; }
    bool cut_high() const { return cut_high_; }
    const glm::dvec3& gradient() const { return gradient_; }
    // Returns the scalar at a point.
    double at(const glm::dvec3& point) const {
        return values_[0] + glm::dot(gradient_, point - corners_[0]);
    }

    // Returns points whose convex hull is the drawn region.
    FewPoints<glm::dvec3, 8> outline() const;

  private:
    const Corners& corners_;
    Values values_;
    glm::dvec3 gradient_;
    double least_, largest_;
    bool cut_low_ = false, cut_high_ = false;
};

inline const std::array world_axes{glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};

// Gradients at a mesh's points, scaled so that float32 holds them and the squares of small ones.
struct StoredGradients {
    StoredGradients() = default;  // no gradients: nothing is lit
    // `gradients`: scalar units per world unit. `smallest`: Lighting::smallest_gradient.
    StoredGradients(std::span<const glm::dvec3> gradients, double smallest);

    // The gradients times `scale`. Most are then far shorter than 1; the longer ones, as beside
    // missing data, are shortened tet by tet with scale_of_tet().
    std::vector<glm::vec3> at_points;
    double scale = 1;  // a power of two that depends on `smallest` alone

    // Largest component of the gradients in a tet after scale_of_tet(): all are shorter than 1.
    static constexpr double largest_in_tet = 0.5;
    // Returns the factor for all gradients of a tet; `largest`: their largest component. Light
    // depends on directions, which a common factor keeps, and on lengths near the smallest gradient
    // alone. A tet is shortened only if a gradient is 2^38 times the smallest or more; then lengths
    // come near the smallest in less than 1e-11 of the tet.
    static double scale_of_tet(double largest) {
        return largest > largest_in_tet ? largest_in_tet / largest : 1;
    }

    // Returns the square of the lighting's smallest gradient times `scale`. The smallest gradient
    // is clamped so that float32 holds the square; beyond the limits all or nothing is lit anyway.
    float smallest_square(const Lighting& lighting) const;
};

// TetsInView::margin if no rasteriser rounds outlines to its grid: pixels, far above their
// rounding.
inline constexpr double outline_margin = 1e-3;

// The tets of a mesh and the view in which they are projected. It does not own what it refers to.
struct TetsInView {
    const TetMesh& mesh;
    std::span<const double> scalar;  // one value for each point
    ValueRange range;                // scalars that whole tets' records map to [0, 1]
    const TetPieces& pieces;         // CellFragment::piece is an index into pieces.pieces()
    WindowView window;
    double near_depth;                     // eye-space depth of the near plane
    double margin;                         // pixels by which outlines are enlarged (pixel_bounds())
    std::span<const glm::vec3> gradients;  // one for each point; empty if nothing is lit

    const View& view() const { return window.view(); }
    // Returns the piece of the transfer function that a cell fragment shows; null for a whole tet.
    const LinearPiece* piece_of(const CellFragment& cell_fragment) const {
        if (cell_fragment.piece == CellFragment::whole) return nullptr;
        return &pieces.pieces()[static_cast<std::size_t>(cell_fragment.piece)];
    }
};

// Projects whole tets or cell fragments in one view, in double precision. Threads may share it.
class TetProjector {
  public:
    explicit TetProjector(const TetsInView& tets)
        : tets_(tets), signer_(tets.mesh, eye_of(tets.view())) {}

    // Projects one cell fragment: writes its record, an outline that contains its image (or more of
    // its tet's), and its gradients if `lit` is not null. Returns how its fragments are to be
    // computed; nothing, with undefined output, if it covers no pixel centre.
    std::optional<FragmentKind> project(const CellFragment& cell_fragment, SilhouetteRecord& record,
                                        ScreenOutline& outline, GradientRecord* lit) const;
    const TetsInView& tets() const { return tets_; }

  private:
    // Corners of a tet's region beyond the near plane (z >= near_depth), in eye space: relative to
    // the eye, along right, up and forward. A tet cut by one plane has at most 6.
    using VisibleCorners = FewPoints<glm::dvec3, 6>;
    VisibleCorners clip_near(const TetField::Corners& corners) const;
    ScreenOutline outline_of(const VisibleCorners& visible, const TetField& field,
                             bool cut_by_near) const;

    TetsInView tets_;
    FaceSigner signer_;
};

// Turns whole tets or cell fragments into triangles for a rasteriser. Threads may share it.
class TetGeometry {
  public:
    virtual ~TetGeometry() = default;

    // The most memory that one cell fragment needs.
    struct Size {
        std::size_t vertex_bytes;       // bytes of one vertex
        std::size_t vertices, indices;  // largest numbers of them
        bool has_record;                // a SilhouetteRecord
        bool has_gradient = false;      // a GradientRecord, if it is lit

        friend bool operator==(const Size&, const Size&) = default;
    };

    // The memory to which one cell fragment is written.
    struct Place {
        std::byte* vertices;
        std::uint32_t first_vertex;   // index of the vertex at `vertices`
        std::uint32_t* indices;       // three for each triangle
        SilhouetteRecord* record;     // null if Size::has_record is false
        GradientRecord* gradient;     // null if Size::has_gradient is false
        std::uint32_t record_number;  // index of `record`, which vertices refer to
    };
    // The numbers of vertices and indices written; both 0 if no pixel centre is covered.
    struct Written {
        std::size_t vertices = 0, indices = 0;
        FragmentKind kind = FragmentKind::thin;
    };
    // Writes one cell fragment. Its triangles do not overlap.
    virtual Written write(const CellFragment& cell_fragment, const Place& place) const = 0;
};

// A corner of the polygon around a tet (shaders/projection/silhouette.vert).
struct SilhouetteVertex {
    glm::vec2 position;    // window coordinates
    std::uint32_t record;  // index of its SilhouetteRecord
};

// Draws the silhouette of each tet as one polygon. The fragment program finds at which depths the
// ray enters and leaves from the planes of the tet's faces in its record.
class SilhouetteGeometry : public TetGeometry {
  public:
    explicit SilhouetteGeometry(const TetProjector& projector) : projector_(projector) {}
    static Size largest_size(bool lit);
    Written write(const CellFragment& cell_fragment, const Place& place) const override;

  private:
    TetProjector projector_;
};

}  // namespace lamina
