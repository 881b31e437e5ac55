// SPDX-License-Identifier: Apache-2.0
// Builds and looks up tables with equally spaced scalars (Kraus, Qiao, Ebert 2004):
//   1. Integrate segments of each pair of scalars and each length (incremental: the first two).
//   2. If incremental: composite longer segments from two shorter ones, layer by layer.
//   3. Round the texels to the format.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

constexpr double largest_depth = 1e30;  // optical depth: opaque, with finite products in float

TransferFunction with_finite_depths(const TransferFunction& transfer_function, double max_length) {
    const double largest = largest_depth / std::max(1.0, max_length);
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    for (TransferKnot& knot : knots) {
        knot.optics.extinction = std::min(knot.optics.extinction, largest);
    }
    return TransferFunction::linear(std::move(knots));
}

// Rounds to the nearest half float: 11 significant bits, or a multiple of 2^-24.
float round_to_half(float x) {
    int exponent = 0;
    std::frexp(x, &exponent);
    const int last_bit = std::max(exponent, -13) - 11;
    return std::ldexp(std::nearbyint(std::ldexp(x, -last_bit)), last_bit);
}

void round_to_format(UniformTable& table) {
    const TableFormat format = table.request.format;
    if (format == TableFormat::float32) return;
    const float largest = *std::ranges::max_element(table.texels);
    if (largest == 0) return;
    if (format == TableFormat::float16) {
        int exponent = 0;
        std::frexp(largest, &exponent);
        table.scale = std::ldexp(1.0f, std::max(exponent - 15, -126));
    } else {
        table.scale = largest;
    }
    const double codes = format == TableFormat::fixed16 ? 65535 : 255;
    const double scale = table.scale;
    const auto count = static_cast<std::int64_t>(table.texels.size());
    parallel_for(count, 1 << 14, [&](std::int64_t i) {
        float& texel = table.texels[static_cast<std::size_t>(i)];
        texel = format == TableFormat::float16
                    ? round_to_half(static_cast<float>(texel / scale))
                    : static_cast<float>(std::round(texel / scale * codes) / codes);
    });
}

std::vector<double> nodes_of(const TableRequest& request) {
    const int last = request.scalar_nodes - 1;
    std::vector<double> nodes;
    for (int i = 0; i <= last; ++i) {
        const double share = static_cast<double>(i) / last;
        nodes.push_back(i == last ? request.hi : request.lo + (request.hi - request.lo) * share);
    }
    return nodes;
}

// Integrals of a segment's linear pieces over the scalar.
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

// A segment between two nodes, with its linear pieces.
struct TableSegment {
    std::span<const LinearPiece> pieces;
    double width = 0;        // in scalars; 0: homogeneous
    double extinction = 0;   // mean over the scalars
    glm::dvec3 emission{0};  // mean over the scalars
};

glm::dvec3 associated_color(const TableSegment& segment, double length) {
    glm::dvec3 sum(0);
    double transmittance = 1;
    for (const LinearPiece& piece : segment.pieces) {
        const double part = length * (std::abs(piece.to - piece.from) / segment.width);
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

// Computes layers by integrating every pair of nodes.
struct ExactLayers {
    UniformTable& table;
    const TransferFunction& transfer_function;
    int layer_count;
    std::vector<double> nodes;

    void fill_column(int front) {
        store_homogeneous(front, front);
        fill_side(front, +1);
        fill_side(front, -1);
    }

    // Fills in the entries of `front` and all nodes on one side, with running sums over pieces.
    void fill_side(int front, int direction) {
        const int count = table.request.scalar_nodes;
        const double start = nodes[front], end = direction > 0 ? nodes.back() : nodes.front();
        std::vector<LinearPiece> pieces;
        for_each_linear_piece(transfer_function.knots(), start, end,
                              [&](const LinearPiece& piece) { pieces.push_back(piece); });
        std::size_t whole = 0;
        Sums sums;
        for (int back = front + direction; back >= 0 && back < count; back += direction) {
            const double value = nodes[back];
            if (value == start) {
                store_homogeneous(front, back);
                continue;
            }
            const auto before = [&](double scalar) { return direction * (value - scalar) > 0; };
            while (whole < pieces.size() && !(direction * (pieces[whole].to - value) > 0)) {
                sums.add(pieces[whole++]);
            }
            Sums total = sums;
            std::span<const LinearPiece> segment(pieces.data(), whole);
            LinearPiece uncut;
            if (whole < pieces.size() && before(pieces[whole].from)) {
                uncut = pieces[whole];
                LinearPiece& last = pieces[whole];
                last.to = value;
                last.at_to =
                    interpolate({uncut.from, uncut.at_from}, {uncut.to, uncut.at_to}, value);
                total.add(last);
                segment = {pieces.data(), whole + 1};
            }
            const double width = std::abs(value - start);
            store(front, back, {segment, width, total.extinction / width, total.emission / width});
            if (segment.size() > whole) pieces[whole] = uncut;
        }
    }

    void store_homogeneous(int front, int back) {
        const OpticalProperties optics = transfer_function.at(nodes[front]);
        store(front, back, {{}, 0, optics.extinction, optics.extinction * optics.color});
    }

    void store(int front, int back, const TableSegment& segment) {
        for (int layer = 0; layer < layer_count; ++layer) {
            const double length = table.length_of(layer);
            const double alpha = opacity_from_depth(segment.extinction * length);
            // The limit of length 0 serves one scalar, length 0, and depths that underflow.
            const bool at_limit =
                segment.width == 0 || !(alpha > std::numeric_limits<double>::min());
            const std::size_t count = nodes.size();
            float* texel = &table.texels[((layer * count + back) * count + front) * table.channels];
            const bool opacity = table.request.store == TableStore::opacity;
            if (table.request.colored) {
                const double per_emission =
                    segment.extinction > 0 ? alpha / segment.extinction : 0;  // associated colour
                const glm::dvec3 color =
                    at_limit ? segment.emission * per_emission : associated_color(segment, length);
                const glm::dvec3 stored =
                    opacity ? color : (at_limit ? segment.emission : color / per_emission);
                for (int c = 0; c < 3; ++c) *texel++ = as_float(stored[c]);
            }
            *texel = as_float(opacity ? alpha : segment.extinction);
        }
    }
};

// One of two pieces of a segment, from interpolated texels. Without colour, color and emission are
// unused; with TableStore::opacity, extinction and emission are.
struct SplitPiece {
    std::array<double, 3> color{}, emission{};
    double alpha = 0, extinction = 0;
};

// Computes layers from layers of shorter segments.
struct IncrementalLayers {
    UniformTable& table;
    std::size_t nodes;

    // Fills in a row after Weiler, Kraus, Merz, Ertl 2003, adapted by Kraus 2004, section 3:
    // composites segments of length 2 l from halves or, with LengthMapping::linear, of n l from l
    // and (n - 1) l. Texels are interpolated at the scalar between the two pieces.
    void fill_row(int layer, std::size_t back) {
        const bool doubling = table.request.mapping != LengthMapping::linear;
        const double share = doubling ? 0.5 : 1.0 / layer;
        const int front_layer = doubling ? layer - 1 : 1;
        for (std::size_t front = 0; front < nodes; ++front) {
            const double middle =
                static_cast<double>(front) * (1 - share) + static_cast<double>(back) * share;
            const std::size_t below = std::min(static_cast<std::size_t>(middle), nodes - 2);
            const double weight = std::clamp(middle - static_cast<double>(below), 0.0, 1.0);
            const SplitPiece first =
                mix(texel(front_layer, below, front), texel(front_layer, below + 1, front), weight,
                    table.length_of(front_layer));
            const SplitPiece second =
                mix(texel(layer - 1, back, below), texel(layer - 1, back, below + 1), weight,
                    table.length_of(layer - 1));
            if (table.request.store == TableStore::opacity) {
                store_opacity(first, second, texel(layer, back, front));
            } else {
                store_emission(first, second, share, table.length_of(layer),
                               texel(layer, back, front));
            }
        }
    }

    float* texel(int layer, std::size_t back, std::size_t front) {
        return &table.texels[((layer * nodes + back) * nodes + front) * table.channels];
    }

    SplitPiece mix(const float* a, const float* b, double weight, double length) const {
        const auto channel = [&](int c) { return a[c] * (1 - weight) + b[c] * weight; };
        const int last = table.channels - 1;
        SplitPiece piece;
        if (table.request.store == TableStore::opacity) {
            piece.alpha = channel(last);
            for (int c = 0; c < last; ++c) piece.color[c] = channel(c);
            return piece;
        }
        piece.extinction = channel(last);
        piece.alpha = opacity_from_depth(piece.extinction * length);
        for (int c = 0; c < last; ++c) {
            piece.emission[c] = channel(c);
            if (piece.alpha > 0) piece.color[c] = channel(c) * (piece.alpha / piece.extinction);
        }
        return piece;
    }

    void store_opacity(const SplitPiece& first, const SplitPiece& second, float* texel) const {
        for (int c = 0; c < table.channels - 1; ++c) {
            texel[c] = static_cast<float>(first.color[c] + (1 - first.alpha) * second.color[c]);
        }
        texel[table.channels - 1] =
            static_cast<float>(first.alpha + (1 - first.alpha) * second.alpha);
    }

    // `share`: the first piece's share of `length`.
    void store_emission(const SplitPiece& first, const SplitPiece& second, double share,
                        double length, float* texel) const {
        const auto mean = [&](double a, double b) { return a * share + b * (1 - share); };
        const double extinction = mean(first.extinction, second.extinction);
        const double alpha = opacity_from_depth(extinction * length);
        for (int c = 0; c < table.channels - 1; ++c) {
            const double color = first.color[c] + (1 - first.alpha) * second.color[c];
            const bool at_limit = !(alpha > std::numeric_limits<double>::min());
            texel[c] = static_cast<float>(at_limit ? mean(first.emission[c], second.emission[c])
                                                   : color / alpha * extinction);
        }
        texel[table.channels - 1] = static_cast<float>(extinction);
    }
};

}  // namespace

UniformTable::UniformTable(const TransferFunction& transfer_function, const TableRequest& asked)
    : PreintegrationTable(asked) {
    assert(request.kind == TableKind::uniform);
    channels = request.colored ? 4 : 1;
    const bool has_length = request.colored || request.store == TableStore::opacity;
    layers = has_length ? request.length_layers : 1;
    const std::int64_t nodes = request.scalar_nodes;
    const std::int64_t count = nodes * nodes * layers * channels;
    if (count * sizeof(float) > most_table_bytes) {
        fail(
            "a pre-integration table of {} x {} scalars x {} lengths takes {} MiB of memory, "
            "expected at most {} MiB: fewer scalars or fewer lengths",
            nodes, nodes, layers, (count * sizeof(float)) >> 20, most_table_bytes >> 20);
    }
    texels.resize(static_cast<std::size_t>(count));
    const TransferFunction finite = with_finite_depths(transfer_function, request.max_length);
    if (!request.colored) single_color = first_color(finite, request.lo, request.hi);

    // The first two layers are those of length 0 and of the shortest segments.
    const bool incremental =
        request.construction == TableConstruction::incremental && request.max_length > 0;
    const int exact_layers = incremental ? std::min(layers, 2) : layers;
    ExactLayers exact{*this, finite, exact_layers, nodes_of(request)};
    {
        Progress progress("pre-integrating", nodes);
        parallel_for(nodes, 4, [&](std::int64_t front) {
            exact.fill_column(static_cast<int>(front));
            progress.advance();
        });
    }
    IncrementalLayers others{*this, static_cast<std::size_t>(nodes)};
    for (int layer = exact_layers; layer < layers; ++layer) {
        parallel_for(nodes, 4, [&](std::int64_t back) {
            others.fill_row(layer, static_cast<std::size_t>(back));
        });
    }
    round_to_format(*this);
}

std::int64_t UniformTable::byte_count() const {
    return static_cast<std::int64_t>(texels.size() * sizeof(float));
}

double UniformTable::length_of(int layer) const {
    if (request.store == TableStore::opacity && layers == 1) return request.max_length;
    if (layer == 0) return 0;
    if (request.mapping == LengthMapping::linear) {
        return request.max_length * layer / (layers - 1);
    }
    return std::ldexp(request.max_length, layer - (layers - 1));
}

double UniformTable::inverse_first_length() const {
    if (layers == 1 || !(length_of(1) > 0)) return 0;
    return std::min<double>(1 / length_of(1), std::numeric_limits<float>::max());
}

double UniformTable::layer_of(double length) const {
    const double v = length * inverse_first_length();
    double layer = v;
    if (v > 1 && request.mapping == LengthMapping::log2) {
        layer = std::log2(v) + 1;  // Kraus 2004, Equation 1
    } else if (v > 1 && request.mapping == LengthMapping::octave) {
        const int octave = std::ilogb(v);
        layer = octave + std::ldexp(v, -octave);
    }
    return std::clamp(layer, 0.0, layers - 1.0);
}

namespace {

double node_of(const TableRequest& request, double value) {
    const double width = request.hi - request.lo;
    const double share = width > 0 ? std::clamp((value - request.lo) / width, 0.0, 1.0) : 0;
    return share * (request.scalar_nodes - 1);
}

// Interpolates trilinearly between texels and multiplies by the scale. Absent channels are 0.
std::array<double, 4> interpolate_texels(const UniformTable& table, double front, double back,
                                         double length) {
    const int nodes = table.request.scalar_nodes;
    const TableNeighbors f = neighbors_of(node_of(table.request, front), nodes);
    const TableNeighbors b = neighbors_of(node_of(table.request, back), nodes);
    const TableNeighbors l = neighbors_of(table.layer_of(length), table.layers);
    std::array<double, 4> sum{};
    for (int corner = 0; corner < 8; ++corner) {
        const bool second_front = corner & 1, second_back = corner & 2, second_layer = corner & 4;
        const double weight = (second_front ? f.weight : 1 - f.weight) *
                              (second_back ? b.weight : 1 - b.weight) *
                              (second_layer ? l.weight : 1 - l.weight) * table.scale;
        if (weight == 0) continue;
        const std::size_t layer = second_layer ? l.second : l.first;
        const std::size_t row = layer * nodes + (second_back ? b.second : b.first);
        const std::size_t texel = row * nodes + (second_front ? f.second : f.first);
        for (int c = 0; c < table.channels; ++c) {
            sum[c] += weight * table.texels[texel * table.channels + c];
        }
    }
    return sum;
}

}  // namespace

SegmentIntegral UniformTable::lookup(double front, double back, double length) const {
    const std::array<double, 4> texel = interpolate_texels(*this, front, back, length);
    const double last = texel[channels - 1];
    const glm::dvec3 rgb(texel[0], texel[1], texel[2]);
    SegmentIntegral result;
    if (request.store == TableStore::opacity) {
        result.alpha = std::min(last, 1.0);
        result.optical_depth = -std::log1p(-result.alpha);
        result.color = request.colored ? rgb : result.alpha * single_color;
        return result;
    }
    result.optical_depth = last * length;
    result.alpha = opacity_from_depth(result.optical_depth);
    if (!request.colored) {
        result.color = result.alpha * single_color;
    } else if (last > 0) {
        result.color = rgb * (result.alpha / last);
    }
    return result;
}

}  // namespace lamina
