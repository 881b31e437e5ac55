// SPDX-License-Identifier: Apache-2.0
// Builds and looks up tables whose nodes are aligned with the transfer function's knots:
//   1. Place nodes ("anchors") on the knots, and equally spaced nodes between two anchors.
//   2. For each pair of nodes, find the means over the scalars between them by running sums.
//   3. If look-ups use the pair, integrate the pieces between the nodes for each length > 0.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"
#include "optics/opacity.h"
#include "optics/pieces.h"
#include "preintegration/preintegration_table.h"
#include "preintegration/table_neighbors.h"

namespace lamina {
namespace {

constexpr std::size_t most_knots = 1022;  // with two nodes an interval, textures of 2048 hold them

// A node of the table, the optics there (at a step, on the node's side), and the next anchors.
struct Node {
    double value;
    OpticalProperties optics;
    int next_anchor;      // the nearest anchor's node above this one (the last node: itself)
    int previous_anchor;  // the nearest anchor's node below (the first node: itself)
    bool anchor;
};

// Lists the nodes of a table, linear piece by linear piece.
struct NodeBuilder {
    KnotTable& table;
    std::vector<Node> nodes = {};

    void add_interval(const LinearPiece& piece, int wanted_cells) {
        // Between points that are only a few roundings apart no further nodes fit.
        const double rounding = std::numeric_limits<double>::epsilon() *
                                std::max(std::abs(piece.from), std::abs(piece.to));
        const int cells = piece.to - piece.from > 2 * wanted_cells * rounding ? wanted_cells : 1;
        add_anchor(piece.from, piece.at_from);
        const TransferKnot a{piece.from, piece.at_from}, b{piece.to, piece.at_to};
        for (int i = 1; i < cells; ++i) {
            const double value = piece.from + (piece.to - piece.from) * i / cells;
            nodes.push_back({value, interpolate(a, b, value), 0, 0, false});
        }
        add_anchor(piece.to, piece.at_to);
    }

    void add_anchor(double value, const OpticalProperties& optics) {
        if (!nodes.empty() && nodes.back().value == value &&
            nodes.back().optics.extinction == optics.extinction &&
            nodes.back().optics.color == optics.color) {
            return;  // the function is continuous here: one node for both sides
        }
        table.anchors.push_back({value, static_cast<int>(nodes.size())});
        nodes.push_back({value, optics, 0, 0, true});
    }

    std::vector<Node> finish() {
        const auto count = static_cast<int>(nodes.size());
        for (std::size_t a = 0; a + 1 < table.anchors.size(); ++a) {
            const int first = table.anchors[a].node, last = table.anchors[a + 1].node;
            for (int n = first; n < last; ++n) nodes[n].next_anchor = last;
            for (int n = first + 1; n <= last; ++n) nodes[n].previous_anchor = first;
        }
        nodes[count - 1].next_anchor = count - 1;
        for (const Node& node : nodes) table.nodes.push_back(node.value);
        return std::move(nodes);
    }
};

std::vector<Node> place_nodes(const TransferFunction& transfer_function,
                              const TableRequest& request, KnotTable& table) {
    NodeBuilder builder{table};
    if (request.lo == request.hi) {
        builder.add_anchor(request.lo, transfer_function.at(request.lo));
        return builder.finish();
    }
    const double width = request.hi - request.lo;
    // Emission is quadratic even within a linear piece, so narrow pieces need inner nodes, too.
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

void check(const TransferFunction& transfer_function, const TableRequest& request) {
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

void check_size(const KnotTable& table) {
    if (!table.request.colored) return;
    const std::size_t nodes = table.nodes.size();
    const std::size_t numbers = table.request.lit ? 7 : 3;
    const std::size_t bytes = nodes * nodes * table.lengths.size() * numbers * sizeof(float);
    if (bytes > most_table_bytes) {
        fail(
            "a pre-integration table of {} x {} scalars x {} lengths takes {} MiB, expected at "
            "most "
            "{} MiB: fewer points in the transfer function or fewer lengths",
            nodes, nodes, table.lengths.size(), bytes >> 20, most_table_bytes >> 20);
    }
}

// Computes the table's entries for all pairs of nodes.
struct TableBuilder {
    KnotTable& table;
    const std::vector<Node>& nodes;

    void fill_row(int front) {
        const OpticalProperties& optics = nodes[front].optics;
        const glm::dvec3 emission = optics.extinction * optics.color;
        store(front, front, {optics.extinction, emission, {optics.extinction / 2, emission / 2.0}});
        fill_half_row(front, +1);
        fill_half_row(front, -1);
    }

    // The table's numbers in the limit of segments of length 0: means over the segment.
    struct Limit {
        double extinction = 0;
        glm::dvec3 emission{0};
        FrontParts front;
    };

    // Fills in the entries of segments between `front` and each node on one side of it, from means
    // over the scalars between both. These are running sums, in which nothing cancels. The sums
    // called `behind` are weighted with the distance from the front.
    void fill_half_row(int front, int direction) {
        double extinction = 0, extinction_behind = 0;
        glm::dvec3 emission(0), emission_behind(0);
        for (int back = front + direction; back >= 0 && back < std::ssize(nodes);
             back += direction) {
            const Node& a = nodes[back - direction];
            const Node& b = nodes[back];
            const double p = a.optics.extinction, q = b.optics.extinction;
            const glm::dvec3 &at_a = a.optics.color, &at_b = b.optics.color;
            const double step = std::abs(b.value - a.value);
            const double before = std::abs(a.value - nodes[front].value);
            const double width = std::abs(b.value - nodes[front].value);
            const double of_piece = p / 2 + q / 2;
            const glm::dvec3 emitted = at_a * (p / 3 + q / 6) + at_b * (p / 6 + q / 3);
            extinction += step * of_piece;
            emission += step * emitted;
            extinction_behind += step * (before * of_piece + step * (p / 6 + q / 3));
            emission_behind += step * (before * emitted +
                                       step * (at_a * (p / 12 + q / 12) + at_b * (p / 12 + q / 4)));
            if (width > 0) {
                store(front, back,
                      {extinction / width,
                       emission / width,
                       {(extinction - extinction_behind / width) / width,
                        (emission - emission_behind / width) / width}});
            } else {  // both sides of a step, half the length on each
                store(front, back,
                      {of_piece,
                       (p * at_a + q * at_b) / 2.0,
                       {(3 * p + q) / 8, (3 * p * at_a + q * at_b) / 8.0}});
            }
        }
    }

    void store(int front, int back, const Limit& limit) {
        const std::size_t entry = static_cast<std::size_t>(back) * nodes.size() + front;
        table.mean_extinction[entry] = as_float(limit.extinction);
        if (!table.request.colored) return;
        store_layer(0, entry, limit);
        for (std::size_t layer = 1; layer < table.lengths.size(); ++layer) {
            const double length = table.lengths[layer];
            const double alpha = opacity_from_depth(limit.extinction * length);
            // The limit is taken at length 0 (max_length = 0) and if the depth underflows.
            Limit there = limit;
            if (is_looked_up(front, back) && alpha > std::numeric_limits<double>::min()) {
                const double scale = limit.extinction / alpha;
                if (front != back) there.emission = color(front, back, length) * scale;
                if (table.request.lit) {
                    there.front = front_parts(front, back, length);
                    there.front.alpha *= scale;
                    there.front.color *= scale;
                }
            }
            store_layer(layer, entry, there);
        }
    }

    // Tells whether look-ups use an entry. They cut segments at the first and at the last anchor
    // between the ends, so only rounding leads to other entries, whose weight is then next to 0.
    bool is_looked_up(int front, int back) const {
        const int lower = std::min(front, back), upper = std::max(front, back);
        return upper <= nodes[lower].next_anchor || (nodes[lower].anchor && nodes[upper].anchor);
    }

    void store_layer(std::size_t layer, std::size_t entry, const Limit& values) {
        const std::size_t number = layer * nodes.size() * nodes.size() + entry;
        for (int c = 0; c < 3; ++c) table.emission[number * 3 + c] = as_float(values.emission[c]);
        if (!table.request.lit) return;
        for (int c = 0; c < 3; ++c)
            table.front_parts[number * 4 + c] = as_float(values.front.color[c]);
        table.front_parts[number * 4 + 3] = as_float(values.front.alpha);
    }

    // Calls visit(from, to, begin, end, share) for the linear pieces of a segment from the front
    // on, until it returns false. from, to: the piece's nodes; begin, end: their places in the
    // segment, 0 to 1; share: the piece's share of the segment's length.
    template <typename Visit>
    void for_each_piece(int front, int back, const Visit& visit) const {
        const double start = nodes[front].value, width = nodes[back].value - start;
        if (width == 0) {  // one value, or a step's two sides, each with half the length
            if (visit(front, front, 0, .5, .5)) visit(back, back, .5, 1, .5);
            return;
        }
        bool more = true;
        for (int from = front; from != back && more;) {
            const int to = front < back ? std::min(nodes[from].next_anchor, back)
                                        : std::max(nodes[from].previous_anchor, back);
            more = visit(from, to, (nodes[from].value - start) / width,
                         (nodes[to].value - start) / width,
                         (nodes[to].value - nodes[from].value) / width);
            from = to;
        }
    }

    // Returns the associated colour of the segment.
    glm::dvec3 color(int front, int back, double length) const {
        glm::dvec3 sum(0);
        double transmittance = 1;
        for_each_piece(front, back, [&](int from, int to, double, double, double share) {
            add_piece(nodes[from], nodes[to], length * share, transmittance, sum);
            return transmittance > least_transmittance;
        });
        return sum;
    }

    FrontParts front_parts(int front, int back, double length) const {
        FrontParts sum;
        double transmittance = 1;
        for_each_piece(front, back, [&](int from, int to, double begin, double end, double share) {
            const OpticalProperties &a = nodes[from].optics, &b = nodes[to].optics;
            const FrontParts parts = front_parts_of({a, b, length * share, begin, end});
            sum.alpha += transmittance * parts.alpha;
            sum.color += transmittance * parts.color;
            transmittance *= std::exp(-length * share * (a.extinction / 2 + b.extinction / 2));
            return transmittance > least_transmittance;
        });
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
};

}  // namespace

KnotTable::KnotTable(const TransferFunction& transfer_function, const TableRequest& asked)
    : PreintegrationTable(asked) {
    assert(request.kind == TableKind::knots);
    check(transfer_function, request);
    const std::vector<Node> placed = place_nodes(transfer_function, request, *this);
    for (int layer = 0; layer < request.length_layers; ++layer) {
        lengths.push_back(layer == 0 ? 0
                                     : request.max_length * layer / (request.length_layers - 1));
    }
    check_size(*this);
    const std::size_t entries = placed.size() * placed.size();
    mean_extinction.resize(entries);
    if (request.colored) emission.resize(entries * lengths.size() * 3);
    if (request.lit) front_parts.resize(entries * lengths.size() * 4);
    const auto seen =
        std::ranges::find_if(placed, [](const Node& node) { return node.optics.extinction > 0; });
    if (seen != placed.end()) single_color = seen->optics.color;

    TableBuilder builder{*this, placed};
    const auto count = static_cast<std::int64_t>(placed.size());
    Progress progress("pre-integrating", count);
    parallel_for(count, 4, [&](std::int64_t front) {
        builder.fill_row(static_cast<int>(front));
        progress.advance();
    });
}

std::int64_t KnotTable::byte_count() const {
    const std::size_t numbers = mean_extinction.size() + emission.size() + front_parts.size();
    return static_cast<std::int64_t>(numbers * sizeof(float));
}

namespace {

// Interpolates in the table. `front` and `back` are node coordinates.
LitIntegral sample(const KnotTable& table, double front, double back, double length) {
    const std::size_t count = table.nodes.size();
    const TableNeighbors f = neighbors_of(front, count), b = neighbors_of(back, count);
    const std::array<std::size_t, 4> entries = {
        b.first * count + f.first, b.first * count + f.second, b.second * count + f.first,
        b.second * count + f.second};
    const std::array<double, 4> weights = {(1 - b.weight) * (1 - f.weight),
                                           (1 - b.weight) * f.weight, b.weight * (1 - f.weight),
                                           b.weight * f.weight};
    double extinction = 0;
    for (int i = 0; i < 4; ++i) extinction += weights[i] * table.mean_extinction[entries[i]];
    LitIntegral result;
    SegmentIntegral& whole = result.whole;
    whole.optical_depth = extinction * length;
    whole.alpha = opacity_from_depth(whole.optical_depth);
    if (!table.request.colored) {
        whole.color = whole.alpha * table.single_color;
        return result;
    }
    if (extinction == 0) return result;
    const double longest = table.lengths.back();
    const double share = longest > 0 ? std::clamp(length / longest, 0.0, 1.0) : 0;
    const TableNeighbors l =
        neighbors_of(share * static_cast<double>(table.lengths.size() - 1), table.lengths.size());
    const double scale = whole.alpha / extinction;
    for (const auto& [layer, of_layer] : {std::pair(l.first, 1 - l.weight), {l.second, l.weight}}) {
        for (int i = 0; i < 4; ++i) {
            const std::size_t number = layer * count * count + entries[i];
            const double weight = scale * of_layer * weights[i];
            const float* const texel = &table.emission[number * 3];
            whole.color += weight * glm::dvec3(texel[0], texel[1], texel[2]);
            if (!table.request.lit) continue;
            const float* const front_part = &table.front_parts[number * 4];
            result.front.color += weight * glm::dvec3(front_part[0], front_part[1], front_part[2]);
            result.front.alpha += weight * front_part[3];
        }
    }
    return result;
}

double coordinate_between(const KnotTable::Anchor& a, const KnotTable::Anchor& b, double value) {
    return a.node + (value - a.value) / (b.value - a.value) * (b.node - a.node);
}

// Returns coordinate(), but for a step's value the left node.
double left_coordinate(const KnotTable& table, double value) {
    const auto& anchors = table.anchors;
    const auto at = std::ranges::lower_bound(anchors, value, {}, &KnotTable::Anchor::value);
    if (at == anchors.end()) return anchors.back().node;
    if (at == anchors.begin()) return at->node;
    return coordinate_between(*(at - 1), *at, value);
}

// A piece of a segment, for one look-up.
struct LookUpPiece {
    double from, to;  // node coordinates, ascending
    double width;     // in scalars
};

// Splits [lo, hi] at the first and the last anchor strictly inside; unneeded pieces have width 0.
std::array<LookUpPiece, 3> split(const KnotTable& table, double lo, double hi) {
    const auto& anchors = table.anchors;
    const double first = table.coordinate(lo);
    const double last = lo < hi ? left_coordinate(table, hi) : first;
    const auto above = std::ranges::upper_bound(anchors, lo, {}, &KnotTable::Anchor::value);
    const auto not_below = std::ranges::lower_bound(anchors, hi, {}, &KnotTable::Anchor::value);
    if (above >= not_below)
        return {LookUpPiece{first, last, hi - lo}, LookUpPiece{}, LookUpPiece{}};
    const auto below = not_below - 1;
    const double inner = below->value - above->value;
    // If the inner piece ends at a step, it takes the node on its own side.
    return {
        LookUpPiece{first, double(above->node), above->value - lo},
        LookUpPiece{table.coordinate(above->value), left_coordinate(table, below->value), inner},
        LookUpPiece{double(below->node), last, hi - below->value}};
}

}  // namespace

double KnotTable::coordinate(double value) const {
    if (value >= anchors.back().value) return anchors.back().node;
    const auto above = std::ranges::upper_bound(anchors, value, {}, &Anchor::value);
    if (above == anchors.begin()) return 0;
    return coordinate_between(*(above - 1), *above, value);
}

LitIntegral KnotTable::lookup_lit(double front, double back, double length) const {
    std::array<LookUpPiece, 3> pieces = split(*this, std::min(front, back), std::max(front, back));
    if (front > back) {
        std::ranges::reverse(pieces);
        for (LookUpPiece& piece : pieces) std::swap(piece.from, piece.to);
    }
    if (front == back) return sample(*this, pieces[0].from, pieces[0].to, length);
    LitIntegral result;
    SegmentIntegral& whole = result.whole;
    double left = 1;  // share of the segment's length that is behind the piece
    for (const LookUpPiece& piece : pieces) {
        if (piece.width == 0) continue;
        const double share = piece.width / std::abs(back - front);
        left = std::max(left - share, 0.0);
        const LitIntegral next = sample(*this, piece.from, piece.to, length * share);
        const double transmittance = std::exp(-whole.optical_depth);
        result.front.color += transmittance * (left * next.whole.color + share * next.front.color);
        result.front.alpha += transmittance * (left * next.whole.alpha + share * next.front.alpha);
        whole.color += transmittance * next.whole.color;
        whole.optical_depth += next.whole.optical_depth;
    }
    whole.alpha = opacity_from_depth(whole.optical_depth);
    return result;
}

}  // namespace lamina
