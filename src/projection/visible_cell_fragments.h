// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compositing/tree_shape.h"
#include "facts/drawn_range.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"
#include "projection/tet_record.h"
#include "scene/camera.h"
#include "visibility/ring_order.h"
#include "visibility/visibility_order.h"

namespace lamina {

// Lists the cell fragments of a mesh that are drawn, farthest first.
class VisibleCellFragments {
  public:
    // `cut`: tets are cut into cell fragments at the transfer function's points, or else drawn
    // whole. `draw_transparent`: invisible ones are listed, too. All arguments must outlive it.
    VisibleCellFragments(const TetMesh& mesh, std::span<const double> scalar,
                         const TetPieces& pieces, bool cut, bool draw_transparent);

    // Lists the cell fragments of tets in visibility order, until the next call. Parallel.
    std::span<const CellFragment> list(std::span<const std::int32_t> order, const Eye& eye);
    // Sorts the tets for this view, then lists their cell fragments. `scattered` (equal in every
    // call): lists them in a random order instead, equal for every view, so that cell fragments of
    // one region lie in different leaves of a tree; the first list then serves all calls.
    // `solve_rings`: as `overlapping_rings` of VisibilityOrder::sort_pixels().
    DrawOrder<CellFragment> sorted(VisibilityOrder& order, const View& view, bool scattered,
                                   bool solve_rings);
    // Returns the number of cell fragments. Lists are longer if tets are listed more than once, for
    // different areas of the picture (DrawOrder::limited).
    std::int64_t count() const { return count_; }

  private:
    // The pieces of the transfer function between a tet's least and largest scalar.
    struct TetSpan {
        TetPieces::Span span;
        std::int32_t nearest;  // the piece that is nearest to the scalar extrapolated to the eye
    };

    void look_from(const Eye& eye);  // parallel
    std::span<const CellFragment> list_tets(std::span<const std::int32_t> order);
    void limit(const DrawOrder<std::int32_t>& order);
    void scatter();
    std::int64_t count_in(const TetPieces::Span& span) const;
    std::size_t count_in_tet(std::int32_t tet) const;
    std::int32_t nearest_piece(std::size_t index, const Eye& eye) const;
    // Writes the tet's cell fragments from `next` on; returns the place for those of the next tet.
    CellFragment* list_cell_fragments(std::int32_t tet, CellFragment* next) const;

    const TetMesh& mesh_;
    std::span<const double> scalar_;
    const TetPieces& pieces_;
    bool cut_, draw_transparent_;
    std::vector<TetSpan> spans_;  // for each tet; empty if all are drawn whole
    std::int64_t count_ = 0;
    std::vector<CellFragment> cell_fragments_;
    // Index in cell_fragments_ of the first cell fragment of each block of tets, and the end.
    std::vector<std::size_t> firsts_;
    std::vector<LimitedItems> limited_;  // limited ranges of the last list
    bool is_scattered_ = false;
};

// Returns the cell fragments of a tree's leaf. A tree has `samples` samples, that is,
// VisibleCellFragments::count(), the nearest first; a longer list is shared out in proportion.
DrawOrder<CellFragment> cell_fragments_of_leaf(const DrawOrder<CellFragment>& cell_fragments,
                                               const SampleSpan& leaf, std::int64_t samples);

}  // namespace lamina
