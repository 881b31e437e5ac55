// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "base/parallel.h"
#include "base/progress.h"
#include "optics/linear_pieces.h"
#include "optics/opacity.h"
#include "optics/segment_table_slices.h"

namespace lamina {

namespace {

// The rest of a segment that is seen through less than this is left out: it is far below a float's
// precision.
constexpr double least_transmittance = 1e-12;

// Integrals over the scalars.
struct Sums {
    double extinction = 0;
    glm::dvec3 emission{0};  // extinction times colour

    void add(const LinearPiece& piece) {
        const double width = std::abs(piece.to - piece.from);
        const double p = piece.at_from.extinction, q = piece.at_to.extinction;
        extinction += width * (p / 2 + q / 2);
        emission +=
            width * (piece.at_from.color * (p / 3 + q / 6) + piece.at_to.color * (p / 6 + q / 3));
    }
};

// The straight run between two nodes.
struct Run {
    std::span<const LinearPiece> pieces;
    double width = 0;  // in scalars; 0: homogeneous
    double extinction = 0;
    glm::dvec3 emission{0};  // both: means over the scalars
};

glm::dvec3 associated_color(const Run& run, double length) {
    glm::dvec3 sum(0);
    double transmittance = 1;
    for (const LinearPiece& piece : run.pieces) {
        const double part = length * (std::abs(piece.to - piece.from) / run.width);
        const double p = part * piece.at_from.extinction, q = part * piece.at_to.extinction;
        if (p == 0 && q == 0) continue;
        const double alpha = opacity_from_depth(p / 2 + q / 2);
        if (piece.at_from.color == piece.at_to.color) {
            sum += transmittance * alpha * piece.at_from.color;
        } else {
            const PieceWeights weights = piece_weights(p, q);
            sum += transmittance *
                   (weights.front * piece.at_from.color + weights.back * piece.at_to.color);
        }
        transmittance *= 1 - alpha;
        if (transmittance < least_transmittance) break;
    }
    return sum;
}

float as_float(double x) {
    return static_cast<float>(std::min<double>(x, std::numeric_limits<float>::max()));
}

class ExactLayers {
  public:
    ExactLayers(SegmentTable& table, const TransferFunction& transfer_function, int layer_count)
        : table_(table),
          transfer_function_(transfer_function),
          layer_count_(layer_count),
          nodes_(table_nodes(table.request)) {}

    void fill_column(int front) {
        store_homogeneous(front, front);
        fill_side(front, +1);
        fill_side(front, -1);
    }

  private:
    // Fills in all nodes on one side of `front`, with running sums over the pieces between.
    void fill_side(int front, int direction) {
        const int count = table_.request.scalar_nodes;
        const double start = nodes_[front], end = direction > 0 ? nodes_.back() : nodes_.front();
        std::vector<LinearPiece> pieces;
        for_each_linear_piece(transfer_function_.knots(), start, end,
                              [&](const LinearPiece& piece) { pieces.push_back(piece); });
        std::size_t whole = 0;
        Sums sums;
        for (int back = front + direction; back >= 0 && back < count; back += direction) {
            const double value = nodes_[back];
            if (value == start) {
                store_homogeneous(front, back);
                continue;
            }
            const auto before = [&](double scalar) { return direction * (value - scalar) > 0; };
            while (whole < pieces.size() && !(direction * (pieces[whole].to - value) > 0)) {
                sums.add(pieces[whole++]);
            }
            Sums total = sums;
            std::span<const LinearPiece> run(pieces.data(), whole);
            LinearPiece uncut;
            if (whole < pieces.size() && before(pieces[whole].from)) {
                uncut = pieces[whole];
                LinearPiece& last = pieces[whole];
                last.to = value;
                last.at_to =
                    interpolate({uncut.from, uncut.at_from}, {uncut.to, uncut.at_to}, value);
                total.add(last);
                run = {pieces.data(), whole + 1};
            }
            const double width = std::abs(value - start);
            store(front, back, {run, width, total.extinction / width, total.emission / width});
            if (run.size() > whole) pieces[whole] = uncut;
        }
    }

    void store_homogeneous(int front, int back) {
        const OpticalProperties optics = transfer_function_.at(nodes_[front]);
        store(front, back, {{}, 0, optics.extinction, optics.extinction * optics.color});
    }

    void store(int front, int back, const Run& run) {
        for (int layer = 0; layer < layer_count_; ++layer) {
            const double length = table_.length_of(layer);
            const double alpha = opacity_from_depth(run.extinction * length);
            // The limit is taken where the run is homogeneous, has length 0, or has a depth that
            // underflows.
            const bool at_limit = run.width == 0 || !(alpha > std::numeric_limits<double>::min());
            const std::size_t nodes = nodes_.size();
            float* texel =
                &table_.texels[((layer * nodes + back) * nodes + front) * table_.channels];
            const bool opacity = table_.request.store == TableStore::opacity;
            if (table_.request.colored) {
                const double per_emission =
                    run.extinction > 0 ? alpha / run.extinction : 0;  // associated colour
                const glm::dvec3 color =
                    at_limit ? run.emission * per_emission : associated_color(run, length);
                const glm::dvec3 stored =
                    opacity ? color : (at_limit ? run.emission : color / per_emission);
                for (int c = 0; c < 3; ++c) *texel++ = as_float(stored[c]);
            }
            *texel = as_float(opacity ? alpha : run.extinction);
        }
    }

    SegmentTable& table_;
    const TransferFunction& transfer_function_;
    int layer_count_;
    std::vector<double> nodes_;
};

}  // namespace

std::vector<double> table_nodes(const SegmentTableRequest& request) {
    const int last = request.scalar_nodes - 1;
    std::vector<double> nodes;
    for (int i = 0; i <= last; ++i) {
        const double share = static_cast<double>(i) / last;
        nodes.push_back(i == last ? request.hi : request.lo + (request.hi - request.lo) * share);
    }
    return nodes;
}

void fill_exact(SegmentTable& table, const TransferFunction& transfer_function, int layer_count) {
    ExactLayers layers(table, transfer_function, layer_count);
    const std::int64_t count = table.request.scalar_nodes;
    Progress progress("pre-integrating", count);
    parallel_for(count, 4, [&](std::int64_t front) {
        layers.fill_column(static_cast<int>(front));
        progress.advance();
    });
}

}  // namespace lamina
