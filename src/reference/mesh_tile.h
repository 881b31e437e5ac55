// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "mesh/face_tree.h"
#include "mesh/tet_mesh.h"
#include "optics/ray_lights.h"
#include "reference/clip.h"
#include "reference/mesh_walk.h"
#include "reference/segment_sum.h"
#include "reference/tiles.h"
#include "reference/transfer_intervals.h"
#include "scene/camera.h"

namespace lamina {

// Traces one tile of a mesh's picture.
class MeshTile {
  public:
    // All tiles of a picture share this.
    struct Picture {
        const TetMesh& mesh;
        const FaceTree& open_faces;
        std::span<const double> scalar;
        std::span<const char> no_value;         // marks tets with a scalar that is not finite
        std::span<const glm::dvec3> gradients;  // at the points; empty: nothing is lit
        const TransferFunction& transfer_function;
        const TransferIntervals& intervals;
        const View& view;
        const TraceOptions& options;
        double reach;  // no point of the mesh is farther from the eye
    };
    struct Totals {
        double error_estimate = 0;
        std::int64_t segments = 0, overlapping = 0;
    };

    MeshTile(const Picture& picture, const PictureTile& tile, PreciseImage& image,
             const RowDone& row_done);

    Totals trace();

  private:
    struct MeshRay {
        glm::ivec2 pixel{0};
        std::size_t entered = 0;  // number of entries that are done
        std::optional<RayLights> lights;
        SegmentSum sum;
    };

    void begin(std::size_t lane);
    void go_on(std::size_t lane);
    void add_overlapping(std::size_t lane);
    void add_shown(std::size_t lane);
    template <typename Segment>
    void add(std::size_t lane, std::int32_t tet, const SeenSegment& part, double length,
             double slack, const Segment& segment);
    GradientAlong gradient_along(const TetSegment& segment, double from, double to) const;
    glm::dvec3 gradient_at(const FaceCrossing& crossing) const;

    const Picture& picture_;
    PreciseImage& image_;
    TileFaces faces_;
    bool listed_ = false;  // whether faces_ has the tile's faces
    PixelsInTurn pixels_;
    PacketWalk walk_;
    SeenLanes seen_{};
    std::vector<MeshRay> rays_;            // one a lane
    std::vector<TetSegment> overlapping_;  // memory of add_overlapping()
    Totals totals_;
};

}  // namespace lamina
