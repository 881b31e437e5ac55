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

// The scalar in a tet, linear between its corners, and the region of the tet that is drawn: all of
// it, or the cell fragment whose scalars lie in one piece of the transfer function.
class PartField {
  public:
    using Corners = std::array<glm::dvec3, 4>;
    using Values = std::array<double, 4>;  // at the corners

    // `piece`: ascending; null for the whole tet. The corners must outlive it.
    PartField(const Corners& corners, const Values& values, const LinearPiece* piece);

    double least() const { return least_; }      // least scalar of the drawn region
    double largest() const { return largest_; }  // >= least
    bool cut_low() const { return cut_low_; }    // the tet also has smaller scalars
    bool cut_high() const { return cut_high_; }
    const glm::dvec3& gradient() const { return gradient_; }
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

// Gradients at a mesh's points, in a unit in which float32 holds them and squares of small ones.
struct StoredGradients {
    StoredGradients() = default;  // nothing is lit
    // `gradients`: in scalar units per world unit. `smallest`: the light's smallest gradient.
    StoredGradients(std::span<const glm::dvec3> gradients, double smallest);

    // Gradients times `scale`, which depends on the smallest gradient alone. Most are then far
    // below 1. Longer ones, around missing data, are shortened in each tet by scale_of_tet().
    std::vector<glm::vec3> at_points;
    double scale = 1;  // a power of two

    // Largest component of a tet's gradients after scaling: lengths are then below 1.
    static constexpr double most_of_tet = 0.5;
    // Returns the factor for all gradients of a tet whose largest component is `largest`. It keeps
    // directions, on which light depends. Lengths matter only near the smallest gradient: in a tet
    // that is scaled, with gradients of 2^38 times that and more, in less than 1e-11 of the tet.
    static double scale_of_tet(double largest) {
        return largest > most_of_tet ? most_of_tet / largest : 1;
    }

    // Returns the square of the lighting's smallest gradient in the unit of at_points. It is
    // limited to numbers that float32 can square; beyond them, everything or nothing is lit.
    float smallest_square(const Lighting& lighting) const;
};

// The tets of a mesh in one view, and how they are projected. The members must outlive it.
struct TetsInView {
    const TetMesh& mesh;
    std::span<const double> scalar;  // one value a point
    ValueRange range;                // the scalars that become [0, 1] in whole tets
    const TetPieces& pieces;         // TetPart::piece refers to these
    WindowView window;
    double near_depth;
    double margin;                         // see pixel_bounds()
    std::span<const glm::vec3> gradients;  // at the points; empty if nothing is lit

    const View& view() const { return window.view(); }
    const LinearPiece* piece_of(const TetPart& part) const {
        if (part.piece == TetPart::whole) return nullptr;
        return &pieces.pieces()[static_cast<std::size_t>(part.piece)];
    }
};

// Projects tets or cell fragments in one view. Safe from many threads.
class TetProjector {
  public:
    explicit TetProjector(const TetsInView& tets)
        : tets_(tets), signer_(tets.mesh, eye_of(tets.view())) {}

    // Fills the record and the outline, and returns the kind of the fragments. The outline covers
    // the cell fragment and may cover more of its tet. Returns nothing, and leaves the outputs
    // undefined, if no pixel centre is covered. `lit`: gets the gradients; null if nothing is lit.
    std::optional<FragmentKind> project(const TetPart& part, SilhouetteRecord& record,
                                        ScreenOutline& outline, GradientRecord* lit) const;
    const TetsInView& tets() const { return tets_; }

  private:
    // Corners of the tet's region z >= near_depth, relative to the eye along right, up and forward.
    using VisibleCorners = FewPoints<glm::dvec3, 6>;
    VisibleCorners clip_near(const PartField::Corners& corners) const;
    ScreenOutline outline_of(const VisibleCorners& visible, const PartField& field,
                             bool cut_by_near) const;

    TetsInView tets_;
    FaceSigner signer_;
};

// Turns tets or cell fragments of a view into triangles for a rasteriser. Safe from many threads.
class TetGeometry {
  public:
    virtual ~TetGeometry() = default;

    // The memory that one cell fragment needs at most.
    struct Size {
        std::size_t vertex_bytes;  // of one vertex
        std::size_t vertices, indices;
        bool has_record;
        bool has_gradient = false;  // for a lit record

        friend bool operator==(const Size&, const Size&) = default;
    };

    // The memory to which a cell fragment is written.
    struct Place {
        std::byte* vertices;
        std::uint32_t first_vertex;  // number of the vertex at `vertices`, for the indices
        std::uint32_t* indices;      // of triangles
        SilhouetteRecord* record;    // null without records
        GradientRecord* gradient;    // null if nothing is lit
        std::uint32_t record_number;
    };
    // Numbers of written vertices and indices, 0 if nothing is covered; triangles do not overlap.
    struct Written {
        std::size_t vertices = 0, indices = 0;
        FragmentKind kind = FragmentKind::thin;
    };
    virtual Written write(const TetPart& part, const Place& place) const = 0;
};

// A corner of the polygon around a tet (shaders/projection/silhouette.vert).
struct SilhouetteVertex {
    glm::vec2 position;  // window coordinates
    std::uint32_t record;
};

// Projects each tet as one polygon; fragments find front and back from the planes of its faces.
class SilhouetteGeometry : public TetGeometry {
  public:
    explicit SilhouetteGeometry(const TetProjector& projector) : projector_(projector) {}
    static Size largest_size(bool lit);
    Written write(const TetPart& part, const Place& place) const override;

  private:
    TetProjector projector_;
};

}  // namespace lamina
