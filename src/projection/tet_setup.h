// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "facts/drawn_range.h"
#include "mesh/tet_mesh.h"
#include "projection/part_area.h"
#include "projection/tet_record.h"
#include "scene/camera.h"
#include "simd/target.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// Computes the results of TetProjector on vectors of several cell fragments, if nothing is
// doubtful: the eye is well outside all faces and the tet lies beyond the near plane. All others
// are left to the projector.
class TetSetup {
  public:
    static constexpr std::size_t most_parts = 8;  // in one call
    enum class Outcome : std::uint8_t { invisible, done, doubtful };
    struct Parts {
        std::array<PartArea, most_parts> areas;  // areas of the whole tets, rows from the top
        std::array<Outcome, most_parts> outcomes;
    };

    // Takes the arguments of TetProjector's constructor.
    TetSetup(const TetMesh& mesh, std::span<const double> scalar, const ValueRange& range,
             const TetPieces& pieces, const View& view, double near_depth, double margin,
             std::span<const glm::vec3> gradients = {})
        : points_(mesh.points()),
          tets_(mesh.tets()),
          scalar_(scalar),
          gradients_(gradients),
          range_(range),
          pieces_(pieces),
          window_(view),
          near_depth_(near_depth),
          margin_(margin) {}

    // Takes at most `most_parts` cell fragments: either all are whole tets or none is. Records and
    // areas are defined if the outcome is `done`; the others are overwritten, too. `records`: one
    // for each cell fragment; `lit`, too, or null if there are no gradients. `next`: cell fragments
    // that will follow, which are prefetched.
    void set_up(std::span<const TetPart> parts, std::span<const TetPart> next,
                SilhouetteRecord* records, GradientRecord* lit, Parts& result) const;

    struct Lanes;  // memory of the vectors (projection/tet_setup_lanes.h)

  private:
    LAMINA_INLINE void prefetch(std::span<const TetPart> next) const;
    void load(std::span<const TetPart> parts, Lanes& lanes) const;
    void store(std::span<const TetPart> parts, const Lanes& lanes, const SilhouetteRecord* records,
               Parts& result) const;
    void load_gradients(std::span<const TetPart> parts, Lanes& lanes) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    std::span<const double> scalar_;
    std::span<const glm::vec3> gradients_;
    ValueRange range_;
    const TetPieces& pieces_;
    WindowView window_;
    double near_depth_, margin_;
};

}  // namespace lamina
