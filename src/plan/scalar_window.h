// SPDX-License-Identifier: Apache-2.0
// Ways to integrate tets depend on the window of a mesh's scalars (facts/drawn_range.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "facts/mesh_facts.h"
#include "optics/linear_pieces.h"

namespace lamina {

// Scalars are normalised to the window of what shows if the whole range is so many times as wide:
// below, no more than 3 of float32's 24 bits are at stake.
inline constexpr double least_narrowing = 8;

inline bool is_far_narrower(const ValueRange& window, const ValueRange& range) {
    return (range.hi - range.lo) / least_narrowing > window.hi - window.lo;
}

// Tets are cut into parts, however many, if the whole range is so many times as wide as most pieces
// of the transfer function and no window holds these: float32 would have 1e-3 of a piece.
inline constexpr double narrow_pieces = 0x1p12;

// Tells whether most pieces that show something are so narrow beside the range.
inline bool has_narrow_pieces(const TransferFunction& transfer_function, const ValueRange& range) {
    std::vector<double> widths;
    for_each_linear_piece(transfer_function.knots(), range.lo, range.hi,
                          [&](const LinearPiece& piece) {
                              if (piece.at_from.extinction > 0 || piece.at_to.extinction > 0)
                                  widths.push_back(piece.to - piece.from);
                          });
    if (widths.empty()) return false;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::ranges::nth_element(widths, middle);
    return *middle * narrow_pieces < range.hi - range.lo;
}

// Calls visit() with the parts of a run before the window, within it and behind it, as they are
// drawn; their scalars lie in the window. A run within it is its only part.
template <typename Visit>
void for_each_run_of_window(const MeshFacts::Run& run, const ValueRange& window,
                            const Visit& visit) {
    const double in = std::clamp(run.front, window.lo, window.hi),
                 out = std::clamp(run.back, window.lo, window.hi);
    if (in == out) return visit(MeshFacts::Run{in, out, run.length});
    const auto length = [&](double from, double to) {
        return run.length * ((to - from) / (run.back - run.front));
    };
    if (in != run.front) visit(MeshFacts::Run{in, in, length(run.front, in)});
    const bool whole = in == run.front && out == run.back;
    visit(MeshFacts::Run{in, out, whole ? run.length : length(in, out)});
    if (out != run.back) visit(MeshFacts::Run{out, out, length(out, run.back)});
}

}  // namespace lamina
