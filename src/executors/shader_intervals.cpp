// SPDX-License-Identifier: Apache-2.0
#include "executors/shader_intervals.h"

#include <algorithm>

namespace lamina {
namespace {

constexpr double max_inverse_width = 1e30;

bool is_step(const OpticalProperties& before, const OpticalProperties& after) {
    return before.extinction != after.extinction || before.color != after.color;
}

void append_optics(const OpticalProperties& optics, std::vector<float>& row) {
    for (int channel = 0; channel < 3; ++channel)
        row.push_back(static_cast<float>(optics.color[channel]));
    row.push_back(static_cast<float>(std::min(optics.extinction, max_shader_extinction)));
}

// Sets for each interval its right end, and the scalar, from its left end on, from which something
// is visible.
void set_ends(std::vector<float>& last_row, const std::vector<float>& places,
              const std::vector<float>& left, const std::vector<float>& right) {
    float right_end = beyond_all_scalars, shown_beyond = beyond_all_scalars;
    for (std::size_t i = places.size(); i > 0;) {
        i -= 4;
        if (left[i + 3] > 0 || right[i + 3] > 0) shown_beyond = places[i];
        last_row[i + 2] = shown_beyond;
        last_row[i + 3] = right_end;
        right_end = places[i];
    }
}

// The part of the extinction that float32 drops. Codes of n bits are computed in double precision.
float low_part(const OpticalProperties& optics) {
    const double extinction = std::min(optics.extinction, max_shader_extinction);
    return static_cast<float>(extinction - static_cast<double>(static_cast<float>(extinction)));
}

}  // namespace

ShaderIntervals make_intervals(const TransferFunction& transfer_function, const ValueRange& range,
                               const std::vector<KnotTable::Anchor>& anchors, double step_advance) {
    return make_intervals(pieces_between(transfer_function, range.lo, range.hi, false), range,
                          anchors, step_advance);
}

ShaderIntervals make_intervals(const std::vector<CurvedPiece>& pieces, const ValueRange& range,
                               const std::vector<KnotTable::Anchor>& anchors, double step_advance) {
    ShaderIntervals intervals;
    const double width = range.hi - range.lo;
    const auto normalised = [&](double value) {
        return width > 0 ? (value - range.lo) / width : 0.0;
    };
    std::vector<float> places, left, right, low;
    std::size_t anchor = 0;
    OpticalProperties before = pieces.front().at_from;
    for (const CurvedPiece& piece : pieces) {
        const double piece_width = normalised(piece.to) - normalised(piece.from);
        const double advance = !places.empty() && is_step(before, piece.at_from) ? step_advance : 0;
        before = piece.at_to;
        places.push_back(static_cast<float>(normalised(piece.from) - advance));
        places.push_back(piece_width > 0
                             ? static_cast<float>(std::min(1 / piece_width, max_inverse_width))
                             : 0.0f);
        // A step is two anchors at one value: pieces lie between anchors of different value.
        while (anchor + 2 < anchors.size() && anchors[anchor].value == anchors[anchor + 1].value)
            ++anchor;
        const bool has_table = anchor + 1 < anchors.size();
        const int node = has_table ? anchors[anchor].node : 0;
        places.push_back(static_cast<float>(node));
        places.push_back(has_table ? static_cast<float>(anchors[anchor + 1].node - node) : 0.0f);
        append_optics(piece.at_from, left);
        append_optics(piece.at_to, right);
        low.insert(low.end(), {low_part(piece.at_from), low_part(piece.at_to), 0.0f, 0.0f});
        ++anchor;
    }
    set_ends(low, places, left, right);
    intervals.count = static_cast<int>(places.size() / 4);
    int interval = 0;
    for (int i = 0; i < ShaderIntervals::start_count; ++i) {
        const float start = static_cast<float>(i) / ShaderIntervals::start_count;
        while (interval + 1 < intervals.count &&
               places[4 * static_cast<std::size_t>(interval + 1)] <= start) {
            ++interval;
        }
        intervals.starts[static_cast<std::size_t>(i)] = static_cast<float>(interval);
    }
    intervals.texels = std::move(places);
    intervals.texels.insert(intervals.texels.end(), left.begin(), left.end());
    intervals.texels.insert(intervals.texels.end(), right.begin(), right.end());
    intervals.texels.insert(intervals.texels.end(), low.begin(), low.end());
    return intervals;
}

}  // namespace lamina
