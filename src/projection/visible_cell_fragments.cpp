// SPDX-License-Identifier: Apache-2.0
#include "projection/visible_cell_fragments.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/profile.h"
#include "compositing/codes.h"
#include "projection/tet_projector.h"

namespace lamina {

constexpr std::size_t block = 4096;  // number of tets whose cell fragments one task lists

VisibleCellFragments::VisibleCellFragments(const TetMesh& mesh, std::span<const double> scalar,
                                           const TetPieces& pieces, bool cut, bool draw_transparent)
    : mesh_(mesh),
      scalar_(scalar),
      pieces_(pieces),
      cut_(cut),
      draw_transparent_(draw_transparent) {
    const auto tets = mesh.tets();
    count_ = static_cast<std::int64_t>(tets.size());
    if (cut || !draw_transparent || !mesh.flat_tets().empty()) {
        spans_.resize(tets.size());
        parallel_for(count_, 4096, [&](std::int64_t index) {
            const auto tet = static_cast<std::size_t>(index);
            const TetPieces::Span span = draw_transparent ? pieces_.met(scalar_, tets[tet])
                                                          : pieces_.visible(scalar_, tets[tet]);
            spans_[tet] = {span, span.first};
        });
        // Flat tets have no volume, and planes that bound nothing.
        for (const std::int32_t tet : mesh.flat_tets())
            spans_[static_cast<std::size_t>(tet)].span = {};
        count_ = std::transform_reduce(
            spans_.begin(), spans_.end(), std::int64_t{0}, std::plus<>(),
            [&](const TetSpan& tet) -> std::int64_t { return count_in(tet.span); });
    }
    cell_fragments_.reserve(static_cast<std::size_t>(count_));
    firsts_.reserve(tets.size() / block + 2);
}

// Finds nearest pieces, in the mesh's own order: there, corners lie near one another in memory.
void VisibleCellFragments::look_from(const Eye& eye) {
    if (!cut_) return;
    parallel_for(static_cast<std::int64_t>(spans_.size()), block, [&](std::int64_t index) {
        const auto tet = static_cast<std::size_t>(index);
        TetSpan& cell_fragments = spans_[tet];
        if (cell_fragments.span.first < cell_fragments.span.last)
            cell_fragments.nearest = nearest_piece(tet, eye);
    });
}

std::span<const CellFragment> VisibleCellFragments::list(std::span<const std::int32_t> order,
                                                         const Eye& eye) {
    look_from(eye);
    return list_tets(order);
}

// Lists the cell fragments in two passes: the first counts those of each block of tets, so that in
// the second each task knows the place of its first one.
std::span<const CellFragment> VisibleCellFragments::list_tets(std::span<const std::int32_t> order) {
    const std::size_t blocks = (order.size() + block - 1) / block;
    const auto tets_of = [&](std::size_t number) {
        return order.subspan(number * block, std::min(block, order.size() - number * block));
    };
    firsts_.assign(blocks + 1, 0);
    parallel_for(static_cast<std::int64_t>(blocks), 1, [&](std::int64_t index) {
        const auto number = static_cast<std::size_t>(index);
        std::size_t cell_fragments = 0;
        for (const std::int32_t tet : tets_of(number)) cell_fragments += count_in_tet(tet);
        firsts_[number + 1] = cell_fragments;
    });
    std::partial_sum(firsts_.begin(), firsts_.end(), firsts_.begin());
    cell_fragments_.resize(firsts_.back());
    parallel_for(static_cast<std::int64_t>(blocks), 1, [&](std::int64_t index) {
        const auto number = static_cast<std::size_t>(index);
        CellFragment* next = cell_fragments_.data() + firsts_[number];
        const auto tets = tets_of(number);
        for (const std::int32_t tet : tets) next = list_cell_fragments(tet, next);
    });
    return cell_fragments_;
}

DrawOrder<CellFragment> VisibleCellFragments::sorted(VisibilityOrder& order, const View& view,
                                                     bool scattered, bool solve_rings) {
    if (is_scattered_) return {cell_fragments_, {}};
    Stage sorting("sort");
    const Eye eye = eye_of(view);
    const auto look = [&] { look_from(eye); };
    const DrawOrder<std::int32_t> tets = order.sort_pixels(view, look, solve_rings);
    sorting.end();
    const Stage listing("parts");
    list_tets(tets.items);
    limit(tets);
    if (scattered) scatter();
    return {cell_fragments_, limited_};
}

// Translates the limited ranges of the list of tets into ranges of the list of cell fragments.
void VisibleCellFragments::limit(const DrawOrder<std::int32_t>& order) {
    limited_.clear();
    std::size_t place = 0, cell_fragments = 0;  // next tet in the order; cell fragments before it
    const auto go_to = [&](std::size_t end) {
        while (place < end) cell_fragments += count_in_tet(order.items[place++]);
        return cell_fragments;
    };
    for (const LimitedItems& limited : order.limited) {
        if (limited.first / block > place / block) {
            place = limited.first / block * block;
            cell_fragments = firsts_[limited.first / block];
        }
        const std::size_t first = go_to(limited.first), end = go_to(limited.end);
        if (first < end) limited_.push_back({first, end, limited.pixels});
    }
}

void VisibleCellFragments::scatter() {
    // Sorted by tet and piece first, so that the random order does not depend on the eye.
    std::ranges::sort(cell_fragments_, {}, [](const CellFragment& cell_fragment) {
        return std::pair(cell_fragment.tet, cell_fragment.piece);
    });
    SplitMix64 random(1);
    for (std::size_t left = cell_fragments_.size(); left > 1; --left)
        std::swap(cell_fragments_[left - 1], cell_fragments_[random.next() % left]);
    is_scattered_ = true;
}

std::int64_t VisibleCellFragments::count_in(const TetPieces::Span& span) const {
    if (span.empty()) return 0;
    if (!cut_) return 1;
    return draw_transparent_ ? span.last - span.first + 1 : pieces_.count(span);
}

std::size_t VisibleCellFragments::count_in_tet(std::int32_t tet) const {
    return spans_.empty()
               ? 1
               : static_cast<std::size_t>(count_in(spans_[static_cast<std::size_t>(tet)].span));
}

// Returns the piece of the transfer function that is nearest to the scalar's value at the eye,
// extrapolated linearly from the tet (at infinity: below or above all scalars). Along every ray
// through a tet the scalar changes monotonically, away from this value. So this piece's cell
// fragment hides all others; cell fragments above it hide the ones farther above, cell fragments
// below it the ones farther below, and no ray meets both sides.
std::int32_t VisibleCellFragments::nearest_piece(std::size_t index, const Eye& eye) const {
    const TetPieces::Span& span = spans_[index].span;
    const Tet& tet = mesh_.tets()[index];
    const TetField::Corners corners = mesh_.corners(static_cast<std::int32_t>(index));
    TetField::Values values;
    for (std::size_t i = 0; i < 4; ++i) values[i] = scalar_[static_cast<std::size_t>(tet[i])];
    const TetField field(corners, values, nullptr);
    const double at_eye = !eye.at_infinity                               ? field.at(eye.position)
                          : glm::dot(field.gradient(), eye.position) > 0 ? -INFINITY
                                                                         : INFINITY;
    std::int32_t nearest = span.first;
    while (nearest < span.last && pieces_.pieces()[static_cast<std::size_t>(nearest)].to < at_eye)
        ++nearest;
    return nearest;
}

CellFragment* VisibleCellFragments::list_cell_fragments(std::int32_t tet,
                                                        CellFragment* next) const {
    if (count_in_tet(tet) == 0) return next;
    if (!cut_) {
        *next++ = {tet};
        return next;
    }
    const auto append = [&](std::int32_t piece) {
        if (draw_transparent_ || !pieces_.transparent(piece)) *next++ = {tet, piece};
    };
    const auto& [span, nearest] = spans_[static_cast<std::size_t>(tet)];
    for (std::int32_t piece = span.last; piece > nearest; --piece) append(piece);
    for (std::int32_t piece = span.first; piece < nearest; ++piece) append(piece);
    append(nearest);
    return next;
}

DrawOrder<CellFragment> cell_fragments_of_leaf(const DrawOrder<CellFragment>& cell_fragments,
                                               const SampleSpan& leaf, std::int64_t samples) {
    const auto count = static_cast<std::int64_t>(cell_fragments.items.size());
    const auto before = [&](int sample) { return sample * count / samples; };
    return cell_fragments.subrange(
        static_cast<std::size_t>(count - before(leaf.end())),
        static_cast<std::size_t>(before(leaf.end()) - before(leaf.first)));
}

}  // namespace lamina
