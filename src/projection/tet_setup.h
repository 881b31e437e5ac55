// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/base.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/tet_mesh.h"
#include "projection/tet_part.h"
#include "projection/tet_record.h"
#include "projection/tile_chunk.h"
#include "projection/window_view.h"
#include "facts/tet_pieces.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// What TetProjector computes, for several parts at a time in vectors, where nothing is doubtful:
// the eye well outside all faces, and the tet behind the near plane. What it leaves goes to the
// projector.
class TetSetup {
  public:
    static constexpr std::size_t most_parts = 8;  // at a time
    enum class Outcome : std::uint8_t { invisible, done, doubtful };
    struct Parts {
        std::array<PartArea, most_parts> areas;  // whole tets', rows from the top
        std::array<Outcome, most_parts> outcomes;
    };

    // As TetProjector's.
    TetSetup(const TetMesh& mesh, std::span<const double> scalar, const ValueRange& range,
             const TetPieces& pieces, const View& view, double near_depth, double margin)
        : points_(mesh.points()),
          tets_(mesh.tets()),
          scalar_(scalar),
          range_(range),
          pieces_(pieces),
          window_(view),
          near_depth_(near_depth),
          margin_(margin) {}

    // At most `most_parts`, all cut into pieces or all whole. Records and areas are defined where
    // the outcome is `done`. `next`: parts that will follow. `records`: as many as parts.
    void set_up(std::span<const TetPart> parts, std::span<const TetPart> next, TetRecord* records,
                Parts& result) const;

    struct Lanes;  // of the vectors; in the implementation

  private:
    HWY_INLINE void prefetch(std::span<const TetPart> next) const;
    void load(std::span<const TetPart> parts, Lanes& lanes) const;
    void store(std::span<const TetPart> parts, const Lanes& lanes, TetRecord* records,
               Parts& result) const;
    void store_faces(const Lanes& lanes, std::size_t lane, TetRecord& record) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    std::span<const double> scalar_;
    ValueRange range_;
    const TetPieces& pieces_;
    WindowView window_;
    double near_depth_, margin_;
};

}  // namespace lamina
