// SPDX-License-Identifier: Apache-2.0
#include "executors/transfer_tables.h"

#include <algorithm>
#include <utility>

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

// Sets in the last row each interval's right end, and the scalar up to which nothing is visible.
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

// Returns the extinction's remainder beyond float32, because codes of n bits need doubles.
float low_part(const OpticalProperties& optics) {
    const double extinction = std::min(optics.extinction, max_shader_extinction);
    return static_cast<float>(extinction - static_cast<double>(static_cast<float>(extinction)));
}

// Returns a coloured table's texels: extinction beside emission, as entries are read as a whole.
CpuTransfer::Aligned texels_of(const KnotTable& table) {
    const std::size_t entries = table.mean_extinction.size(), layers = table.lengths.size();
    const std::size_t size = table.request.lit ? 8 : 4;
    CpuTransfer::Aligned texels(entries * size * layers);
    const auto place = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    for (std::size_t entry = 0; entry < entries; ++entry) {
        for (std::size_t layer = 0; layer < layers; ++layer) {
            const std::size_t from = layer * entries + entry;
            const auto to = texels.begin() + place(size * (entry * layers + layer));
            std::copy_n(table.emission.begin() + place(3 * from), 3, to);
            to[3] = table.mean_extinction[entry];
            if (table.request.lit)
                std::copy_n(table.front_parts.begin() + place(4 * from), 4, to + 4);
        }
    }
    return texels;
}

// Returns the bends of `count` intervals; those beyond the last piece are copies of it.
std::array<std::vector<float>, 2> bends_of(const std::vector<CurvedPiece>& pieces,
                                           std::size_t count) {
    std::array<std::vector<float>, 2> bends;
    for (std::size_t i = 0; i < count; ++i) {
        const CurvedPiece& piece = pieces[std::min(i, pieces.size() - 1)];
        for (std::size_t k = 0; k < bends.size(); ++k)
            bends[k].push_back(static_cast<float>(piece.bend[k]));
    }
    return bends;
}

CpuTransfer::Aligned records_of(const CpuTransfer& transfer) {
    const std::size_t size = CpuTransfer::record_size;
    CpuTransfer::Aligned records(size * transfer.left_end.size());
    for (std::size_t i = 0; i < transfer.left_end.size(); ++i) {
        float* to = records.data() + size * i;
        const auto &left = transfer.left, &change = transfer.change;
        for (const float value : {left[3][i], change[3][i], transfer.left_end[i],
                                  transfer.right_end[i], transfer.inverse_width[i], left[0][i],
                                  left[1][i], left[2][i], change[0][i], change[1][i], change[2][i]})
            *to++ = value;
        for (const std::vector<float>& row : transfer.bend) *to++ = row.empty() ? 0 : row[i];
    }
    return records;
}

}  // namespace

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
        const bool step = !places.empty() && is_step(before, piece.at_from);
        const double advance = step ? step_advance : 0;
        intervals.steps = intervals.steps || step;
        before = piece.at_to;
        places.push_back(static_cast<float>(normalised(piece.from) - advance));
        places.push_back(piece_width > 0
                             ? static_cast<float>(std::min(1 / piece_width, max_inverse_width))
                             : 0.0f);
        // A step is two anchors of one value; pieces lie between anchors of different values.
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

CpuTransfer::CpuTransfer(const TransferFunction& transfer_function, const ValueRange& range,
                         std::shared_ptr<const KnotTable> knot_table, double step_advance,
                         bool curved)
    : table(std::move(knot_table)) {
    std::vector<KnotTable::Anchor> anchors;
    if (table) {
        const TableRequest& request = table->request;
        anchors = table->anchors;
        if (request.colored) texels = texels_of(*table);
        if (request.max_length > 0) {
            layers_per_length =
                static_cast<float>((request.length_layers - 1) / request.max_length);
        }
    }
    const auto pieces = pieces_between(transfer_function, range.lo, range.hi, curved);
    const ShaderIntervals shader = make_intervals(pieces, range, anchors, step_advance);
    intervals = shader.count;
    steps = shader.steps;
    const int padded = std::max(intervals, 0) + few;
    const auto component = [&](int row, int channel) {
        std::vector<float> values(static_cast<std::size_t>(padded));
        for (int i = 0; i < padded; ++i) {
            const int column = std::min(i, intervals - 1);
            values[static_cast<std::size_t>(i)] =
                shader.texels[static_cast<std::size_t>(4 * (row * intervals + column) + channel)];
        }
        return values;
    };
    left_end = component(0, 0);
    inverse_width = component(0, 1);
    first_node = component(0, 2);
    nodes = component(0, 3);
    for (int channel = 0; channel < 4; ++channel) {
        const auto c = static_cast<std::size_t>(channel);
        left[c] = component(1, channel);
        change[c] = component(2, channel);
        for (std::size_t i = 0; i < left[c].size(); ++i) change[c][i] -= left[c][i];
    }
    right_extinction = component(2, 3);
    right_end = component(3, 3);
    if (curved) bend = bends_of(pieces, left_end.size());
    records = records_of(*this);
    float before = 0;
    for (std::size_t i = 0; i < right_extinction.size(); ++i) {
        const bool at_left = left[3][i] > 0, shows = at_left || right_extinction[i] > 0;
        shown_before.push_back(before);
        shown_beyond.push_back(!shows ? beyond_all_scalars : at_left ? -1 : left_end[i]);
        if (shows) ++before;
    }
    left_rest = component(3, 0);
    right_rest = component(3, 1);
    for (const float start : shader.starts) starts.push_back(static_cast<std::int32_t>(start));
}

std::int64_t CpuTransfer::byte_count() const {
    const std::size_t per_interval = 4 + 8 + 6 + (bend[0].empty() ? 0 : 2) + record_size;
    return static_cast<std::int64_t>(sizeof(float) *
                                         (per_interval * left_end.size() + texels.size()) +
                                     sizeof(std::int32_t) * starts.size()) +
           (table ? table->byte_count() : 0);
}

}  // namespace lamina
