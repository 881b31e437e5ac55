// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "projection/tet_projector.h"
#include "projection/tet_record.h"

namespace lamina {

// Turns the tets or cell fragments of one view into triangles for a rasteriser. Safe from many
// threads.
class TetGeometry {
  public:
    virtual ~TetGeometry() = default;

    // Largest memory that one cell fragment needs.
    struct Size {
        std::size_t vertex_bytes;  // of one vertex
        std::size_t vertices, indices;
        bool has_record;
        bool has_gradient = false;  // for a lit record

        friend bool operator==(const Size&, const Size&) = default;
    };

    // The place at which a cell fragment is written.
    struct Place {
        std::byte* vertices;
        std::uint32_t first_vertex;  // number of the vertex at `vertices`, for the indices
        std::uint32_t* indices;      // of triangles
        SilhouetteRecord* record;    // null without records
        GradientRecord* gradient;    // null if nothing is lit
        std::uint32_t record_number;
    };
    // The numbers of vertices and indices that were written; 0 if no pixel centre is covered.
    // Triangles of one cell fragment do not overlap.
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
