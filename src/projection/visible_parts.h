// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/eye.h"
#include "mesh/tet_mesh.h"
#include "visibility/visibility_order.h"
#include "projection/tet_part.h"
#include "facts/tet_pieces.h"

namespace lamina {

// What of a mesh is drawn, farthest first.
class VisibleParts {
  public:
    // `cut`: into the transfer function's pieces, else whole tets; with `draw_transparent` also
    // what shows nothing. All must outlive it.
    VisibleParts(const TetMesh& mesh, std::span<const double> scalar, const TetPieces& pieces,
                 bool cut, bool draw_transparent);

    // Of tets in visibility order. Valid until the next call, which takes no memory. Parallel.
    std::span<const TetPart> list(std::span<const std::int32_t> order, const Eye& eye);
    // The same, of tets that are sorted for this eye first. `scattered`, always or never: in a
    // random order that is the same for every view, so that parts of one region come to lie in
    // different leaves of a tree; the first view's stays valid.
    std::span<const TetPart> sorted(VisibilityOrder& order, const Eye& eye, bool scattered);
    std::int64_t count() const { return count_; }  // of every list

  private:
    struct TetSpan {
        TetPieces::Span span;
        std::int32_t nearest;  // its part that is nearest to what the scalar would be at the eye
    };

    void look_from(const Eye& eye);  // parallel
    std::span<const TetPart> list_tets(std::span<const std::int32_t> order);
    void scatter();
    std::int64_t parts_in(const TetPieces::Span& span) const;
    std::size_t parts_of(std::int32_t tet) const;
    std::int32_t nearest_piece(std::size_t tet, const Eye& eye) const;
    // From `next` on; returns where the next tet's go.
    TetPart* list_parts(std::int32_t tet, TetPart* next) const;
    double scalar_at_eye(const Tet& tet, const Eye& eye) const;

    const TetMesh& mesh_;
    std::span<const double> scalar_;
    const TetPieces& pieces_;
    bool cut_, draw_transparent_;
    std::vector<TetSpan> spans_;  // of tets; empty where all are drawn whole
    std::int64_t count_ = 0;
    std::vector<TetPart> parts_;
    std::vector<std::size_t> firsts_;  // number of each block of tets' first part, and the end
    bool is_scattered_ = false;
};

}  // namespace lamina
