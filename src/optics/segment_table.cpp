// SPDX-License-Identifier: Apache-2.0
#include "optics/segment_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "optics/linear_pieces.h"
#include "optics/opacity.h"
#include "optics/segment_table_slices.h"

namespace lamina {

namespace {

constexpr std::int64_t most_bytes = std::int64_t{1} << 30;
constexpr double largest_depth = 1e30;

std::int64_t bytes_per_component(TableFormat format) {
    switch (format) {
        case TableFormat::fixed8:
            return 1;
        case TableFormat::fixed16:
        case TableFormat::float16:
            return 2;
        case TableFormat::float32:
            break;
    }
    return 4;
}

TransferFunction with_finite_depths(const TransferFunction& transfer_function, double max_length) {
    const double largest = largest_depth / std::max(1.0, max_length);
    std::vector<TransferKnot> knots(transfer_function.knots().begin(),
                                    transfer_function.knots().end());
    for (TransferKnot& knot : knots) {
        knot.optics.extinction = std::min(knot.optics.extinction, largest);
    }
    return TransferFunction::linear(std::move(knots));
}

// Rounds to the nearest number with 11 significant bits, or multiple of 2^-24.
float round_to_half(float x) {
    int exponent = 0;
    std::frexp(x, &exponent);
    const int last_bit = std::max(exponent, -13) - 11;
    return std::ldexp(std::nearbyint(std::ldexp(x, -last_bit)), last_bit);
}

void round_to_format(SegmentTable& table) {
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

struct Cell {
    std::size_t first, second;
    double weight;  // of the second
};

Cell cell_of(double coordinate, int count) {
    const auto first = static_cast<std::size_t>(coordinate);
    return {first, std::min(first + 1, static_cast<std::size_t>(count) - 1),
            coordinate - static_cast<double>(first)};
}

double node_of(const SegmentTableRequest& request, double value) {
    const double width = request.hi - request.lo;
    const double share = width > 0 ? std::clamp((value - request.lo) / width, 0.0, 1.0) : 0;
    return share * (request.scalar_nodes - 1);
}

// Interpolates trilinearly between texels and multiplies by the scale. Absent channels are 0.
std::array<double, 4> interpolate_texels(const SegmentTable& table, double front, double back,
                                         double length) {
    const int nodes = table.request.scalar_nodes;
    const Cell f = cell_of(node_of(table.request, front), nodes);
    const Cell b = cell_of(node_of(table.request, back), nodes);
    const Cell l = cell_of(table.layer_of(length), table.layers);
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

std::int64_t SegmentTable::byte_count() const {
    return static_cast<std::int64_t>(texels.size()) * bytes_per_component(request.format);
}

double SegmentTable::length_of(int layer) const {
    if (request.store == TableStore::opacity && layers == 1) return request.max_length;
    if (layer == 0) return 0;
    if (request.mapping == LengthMapping::linear) {
        return request.max_length * layer / (layers - 1);
    }
    return std::ldexp(request.max_length, layer - (layers - 1));
}

double SegmentTable::inverse_first_length() const {
    if (layers == 1 || !(length_of(1) > 0)) return 0;
    return std::min<double>(1 / length_of(1), std::numeric_limits<float>::max());
}

double SegmentTable::layer_of(double length) const {
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

SegmentIntegral SegmentTable::lookup(double front, double back, double length) const {
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

SegmentTable build_segment_table(const TransferFunction& transfer_function,
                                 const SegmentTableRequest& request) {
    const Stopwatch watch;
    SegmentTable table;
    table.request = request;
    table.channels = request.colored ? 4 : 1;
    const bool has_length = request.colored || request.store == TableStore::opacity;
    table.layers = has_length ? request.length_layers : 1;
    const std::int64_t nodes = request.scalar_nodes;
    const std::int64_t count = nodes * nodes * table.layers * table.channels;
    if (count * static_cast<std::int64_t>(sizeof(float)) > most_bytes) {
        fail(
            "a pre-integration table of {} x {} scalars x {} lengths takes {} MiB of memory, "
            "expected at most {} MiB: fewer scalars or fewer lengths",
            nodes, nodes, table.layers, (count * sizeof(float)) >> 20, most_bytes >> 20);
    }
    table.texels.resize(static_cast<std::size_t>(count));
    const TransferFunction finite = with_finite_depths(transfer_function, request.max_length);
    if (!request.colored) table.single_color = first_color(finite, request.lo, request.hi);

    // The first two layers are those of length 0 and of the shortest segments.
    const bool incremental =
        request.construction == TableConstruction::incremental && request.max_length > 0;
    const int exact_layers = incremental ? std::min(table.layers, 2) : table.layers;
    fill_exact(table, finite, exact_layers);
    if (exact_layers < table.layers) fill_incremental(table, exact_layers);
    round_to_format(table);
    table.build_ms = watch.milliseconds();
    return table;
}

}  // namespace lamina
