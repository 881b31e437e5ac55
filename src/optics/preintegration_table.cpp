// SPDX-License-Identifier: Apache-2.0
#include "optics/preintegration_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "optics/linear_pieces.h"
#include "optics/opacity.h"
#include "optics/table_memory.h"

namespace lamina {

namespace {

constexpr std::size_t most_knots = 1022;  // two nodes an interval: textures of 2048 hold them
constexpr std::size_t most_bytes = std::size_t{1} << 30;
// The rest of a segment that is seen through less than this is left out: it is far below a float's
// precision.
constexpr double least_transmittance = 1e-12;

float as_float(double x) {
    return static_cast<float>(std::min<double>(x, std::numeric_limits<float>::max()));
}

// The nodes, each with the transfer function's one-sided limit, and the next anchors above and
// below.
struct Node {
    double value;
    OpticalProperties optics;
    int next_anchor;      // the nearest anchor's node above this one (the last node: itself)
    int previous_anchor;  // below
    bool anchor;
};

class NodeBuilder {
  public:
    explicit NodeBuilder(PreintegrationTable& table) : table_(table) {}

    void add_interval(const LinearPiece& piece, int wanted_cells) {
        // Points that are a few roundings apart leave no room for more nodes.
        const double rounding = std::numeric_limits<double>::epsilon() *
                                std::max(std::abs(piece.from), std::abs(piece.to));
        const int cells = piece.to - piece.from > 2 * wanted_cells * rounding ? wanted_cells : 1;
        add_anchor(piece.from, piece.at_from);
        const TransferKnot a{piece.from, piece.at_from}, b{piece.to, piece.at_to};
        for (int i = 1; i < cells; ++i) {
            const double value = piece.from + (piece.to - piece.from) * i / cells;
            nodes_.push_back({value, interpolate(a, b, value), 0, 0, false});
        }
        add_anchor(piece.to, piece.at_to);
    }

    void add_anchor(double value, const OpticalProperties& optics) {
        if (!nodes_.empty() && nodes_.back().value == value &&
            nodes_.back().optics.extinction == optics.extinction &&
            nodes_.back().optics.color == optics.color) {
            return;  // the function is continuous here: one node for both sides
        }
        table_.anchors.push_back({value, static_cast<int>(nodes_.size())});
        nodes_.push_back({value, optics, 0, 0, true});
    }

    std::vector<Node> finish() {
        const auto count = static_cast<int>(nodes_.size());
        for (std::size_t a = 0; a + 1 < table_.anchors.size(); ++a) {
            const int first = table_.anchors[a].node, last = table_.anchors[a + 1].node;
            for (int n = first; n < last; ++n) nodes_[n].next_anchor = last;
            for (int n = first + 1; n <= last; ++n) nodes_[n].previous_anchor = first;
        }
        nodes_[count - 1].next_anchor = count - 1;
        for (const Node& node : nodes_) table_.nodes.push_back(node.value);
        return std::move(nodes_);
    }

  private:
    PreintegrationTable& table_;
    std::vector<Node> nodes_;
};

std::vector<Node> place_nodes(const TransferFunction& transfer_function,
                              const PreintegrationRequest& request, PreintegrationTable& table) {
    NodeBuilder builder(table);
    if (request.lo == request.hi) {
        builder.add_anchor(request.lo, transfer_function.at(request.lo));
        return builder.finish();
    }
    const double width = request.hi - request.lo;
    // Emission is a product of two linear functions even within an interval, so narrow intervals
    // need inner nodes, too.
    int intervals = 0;
    for_each_linear_piece(transfer_function.knots(), request.lo, request.hi,
                          [&](const LinearPiece&) { ++intervals; });
    const int fewest_cells = std::clamp(request.scalar_nodes / (2 * intervals), 2, 16);
    for_each_linear_piece(
        transfer_function.knots(), request.lo, request.hi, [&](const LinearPiece& piece) {
            const double share = (piece.to - piece.from) / width;
            const double cells = std::round((request.scalar_nodes - 1) * share);
            builder.add_interval(piece, std::max(fewest_cells, static_cast<int>(cells)));
        });
    return builder.finish();
}

void check(const TransferFunction& transfer_function, const PreintegrationRequest& request) {
    const auto inside = static_cast<std::size_t>(
        std::ranges::count_if(transfer_function.knots(), [&](const TransferKnot& knot) {
            return knot.value > request.lo && knot.value < request.hi;
        }));
    if (inside > most_knots) {
        fail(
            "transfer_function.points: found {} between {} and {}, expected at most {} for a "
            "pre-integration table: \"post\" or \"analytic\" do without",
            inside, request.lo, request.hi, most_knots);
    }
}

void check_size(const PreintegrationTable& table) {
    if (!table.colored) return;
    const std::size_t nodes = table.nodes.size();
    const std::size_t bytes = nodes * nodes * table.lengths.size() * 3 * sizeof(float);
    if (bytes > most_bytes) {
        fail(
            "a pre-integration table of {} x {} scalars x {} lengths takes {} MiB, expected at "
            "most "
            "{} MiB: fewer points in the transfer function or fewer lengths",
            nodes, nodes, table.lengths.size(), bytes >> 20, most_bytes >> 20);
    }
}

class TableBuilder {
  public:
    TableBuilder(PreintegrationTable& table, const std::vector<Node>& nodes)
        : table_(table), nodes_(nodes), count_(static_cast<int>(nodes.size())) {}

    void fill_row(int front) {
        store(front, front, nodes_[front].optics.extinction,
              nodes_[front].optics.extinction * nodes_[front].optics.color);
        fill_half_row(front, +1);
        fill_half_row(front, -1);
    }

  private:
    // Fills in the means over the scalars between `front` and each node on one side of it. They are
    // running sums, in which nothing cancels.
    void fill_half_row(int front, int direction) {
        double extinction = 0;
        glm::dvec3 emission(0);
        for (int back = front + direction; back >= 0 && back < count_; back += direction) {
            const Node& a = nodes_[back - direction];
            const Node& b = nodes_[back];
            const double p = a.optics.extinction, q = b.optics.extinction;
            const double step = std::abs(b.value - a.value);
            const double width = std::abs(b.value - nodes_[front].value);
            extinction += step * (p / 2 + q / 2);
            emission +=
                step * (a.optics.color * (p / 3 + q / 6) + b.optics.color * (p / 6 + q / 3));
            if (width > 0) {
                store(front, back, extinction / width, emission / width);
            } else {  // both sides of a step
                store(front, back, p / 2 + q / 2, (p * a.optics.color + q * b.optics.color) / 2.0);
            }
        }
    }

    void store(int front, int back, double extinction, const glm::dvec3& limit) {
        const std::size_t entry = static_cast<std::size_t>(back) * count_ + front;
        table_.mean_extinction[entry] = as_float(extinction);
        if (!table_.colored) return;
        store_emission(0, entry, limit);
        for (std::size_t layer = 1; layer < table_.lengths.size(); ++layer) {
            const double length = table_.lengths[layer];
            const double alpha = opacity_from_depth(extinction * length);
            // The limit is taken at length 0 (max_length = 0) and where the depth underflows.
            const bool at_limit = front == back || !is_looked_up(front, back) ||
                                  !(alpha > std::numeric_limits<double>::min());
            store_emission(layer, entry,
                           at_limit ? limit : color(front, back, length) * (extinction / alpha));
        }
    }

    // Segments are cut at the first and at the last anchor between their ends. So look-ups reach
    // the other entries by rounding alone, with next to no weight.
    bool is_looked_up(int front, int back) const {
        const int lower = std::min(front, back), upper = std::max(front, back);
        return upper <= nodes_[lower].next_anchor || (nodes_[lower].anchor && nodes_[upper].anchor);
    }

    void store_emission(std::size_t layer, std::size_t entry, const glm::dvec3& emission) {
        const std::size_t first = (layer * nodes_.size() * nodes_.size() + entry) * 3;
        for (int c = 0; c < 3; ++c) table_.emission[first + c] = as_float(emission[c]);
    }

    // Returns the associated colour of the segment. This is integrate_segment() without the search
    // for pieces, because both ends of every piece are nodes.
    glm::dvec3 color(int front, int back, double length) const {
        const double width = nodes_[back].value - nodes_[front].value;
        glm::dvec3 sum(0);
        double transmittance = 1;
        if (width == 0) {  // both sides of a step, half the length on each
            add_piece(nodes_[front], nodes_[front], length / 2, transmittance, sum);
            add_piece(nodes_[back], nodes_[back], length / 2, transmittance, sum);
            return sum;
        }
        for (int from = front; from != back && transmittance > least_transmittance;) {
            const int to = front < back ? std::min(nodes_[from].next_anchor, back)
                                        : std::max(nodes_[from].previous_anchor, back);
            const double share = (nodes_[to].value - nodes_[from].value) / width;
            add_piece(nodes_[from], nodes_[to], length * share, transmittance, sum);
            from = to;
        }
        return sum;
    }

    static void add_piece(const Node& a, const Node& b, double length, double& transmittance,
                          glm::dvec3& sum) {
        const double p = length * a.optics.extinction, q = length * b.optics.extinction;
        if (p == 0 && q == 0) return;
        if (a.optics.color == b.optics.color) {
            sum += transmittance * opacity_from_depth(p / 2 + q / 2) * a.optics.color;
        } else {
            const PieceWeights weights = piece_weights(p, q);
            sum += transmittance * (weights.front * a.optics.color + weights.back * b.optics.color);
        }
        transmittance *= std::exp(-(p / 2 + q / 2));
    }

    PreintegrationTable& table_;
    const std::vector<Node>& nodes_;
    int count_;
};

}  // namespace

PreintegrationTable build_preintegration_table(const TransferFunction& transfer_function,
                                               const PreintegrationRequest& request) {
    check(transfer_function, request);
    PreintegrationTable table;
    table.colored = request.colored;
    const std::vector<Node> nodes = place_nodes(transfer_function, request, table);
    for (int layer = 0; layer < request.length_layers; ++layer) {
        table.lengths.push_back(
            layer == 0 ? 0 : request.max_length * layer / (request.length_layers - 1));
    }
    check_size(table);
    const std::size_t entries = nodes.size() * nodes.size();
    table.mean_extinction.resize(entries);
    if (table.colored) table.emission.resize(entries * table.lengths.size() * 3);
    const auto seen =
        std::ranges::find_if(nodes, [](const Node& node) { return node.optics.extinction > 0; });
    if (seen != nodes.end()) table.single_color = seen->optics.color;

    TableBuilder builder(table, nodes);
    const auto count = static_cast<std::int64_t>(nodes.size());
    Progress progress("pre-integrating", count);
    parallel_for(count, 4, [&](std::int64_t front) {
        builder.fill_row(static_cast<int>(front));
        progress.advance();
    });
    return table;
}

std::shared_ptr<const PreintegrationTable> preintegration_table(
    const TransferFunction& transfer_function, const PreintegrationRequest& request) {
    static TableMemory<PreintegrationRequest, PreintegrationTable> memory;
    return memory.get(transfer_function, request, build_preintegration_table);
}

}  // namespace lamina
