// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/parallel.h"
#include "optics/opacity.h"
#include "optics/segment_table_slices.h"

namespace lamina {

namespace {

// A part of a segment, from interpolated texels. Without colour, the first three are unused; with
// TableStore::opacity, extinction and emission are.
struct Part {
    std::array<double, 3> color{}, emission{};
    double alpha = 0, extinction = 0;
};

class IncrementalLayers {
  public:
    explicit IncrementalLayers(SegmentTable& table)
        : table_(table), nodes_(static_cast<std::size_t>(table.request.scalar_nodes)) {}

    // Weiler, Kraus, Merz, Ertl 2003, as Kraus 2004, section 3, adapts it: a segment of length 2 l
    // from its two halves of length l, with `linear` one of length (n + 1) l from its first share l
    // and the rest. Where they meet, the scalar lies between two nodes.
    void fill_row(int layer, std::size_t back) {
        const bool doubling = table_.request.mapping != LengthMapping::linear;
        const double share = doubling ? 0.5 : 1.0 / layer;
        const int front_layer = doubling ? layer - 1 : 1;
        for (std::size_t front = 0; front < nodes_; ++front) {
            const double middle =
                static_cast<double>(front) * (1 - share) + static_cast<double>(back) * share;
            const std::size_t below = std::min(static_cast<std::size_t>(middle), nodes_ - 2);
            const double weight = std::clamp(middle - static_cast<double>(below), 0.0, 1.0);
            const Part first =
                mix(texel(front_layer, below, front), texel(front_layer, below + 1, front), weight,
                    table_.length_of(front_layer));
            const Part second =
                mix(texel(layer - 1, back, below), texel(layer - 1, back, below + 1), weight,
                    table_.length_of(layer - 1));
            if (table_.request.store == TableStore::opacity) {
                store_opacity(first, second, texel(layer, back, front));
            } else {
                store_emission(first, second, share, table_.length_of(layer),
                               texel(layer, back, front));
            }
        }
    }

  private:
    float* texel(int layer, std::size_t back, std::size_t front) {
        return &table_.texels[((layer * nodes_ + back) * nodes_ + front) * table_.channels];
    }

    Part mix(const float* a, const float* b, double weight, double length) const {
        const auto channel = [&](int c) { return a[c] * (1 - weight) + b[c] * weight; };
        const int last = table_.channels - 1;
        Part part;
        if (table_.request.store == TableStore::opacity) {
            part.alpha = channel(last);
            for (int c = 0; c < last; ++c) part.color[c] = channel(c);
            return part;
        }
        part.extinction = channel(last);
        part.alpha = opacity_from_depth(part.extinction * length);
        for (int c = 0; c < last; ++c) {
            part.emission[c] = channel(c);
            if (part.alpha > 0) part.color[c] = channel(c) * (part.alpha / part.extinction);
        }
        return part;
    }

    void store_opacity(const Part& first, const Part& second, float* texel) const {
        for (int c = 0; c < table_.channels - 1; ++c) {
            texel[c] = static_cast<float>(first.color[c] + (1 - first.alpha) * second.color[c]);
        }
        texel[table_.channels - 1] =
            static_cast<float>(first.alpha + (1 - first.alpha) * second.alpha);
    }

    // `share` is the first part's share of `length`.
    void store_emission(const Part& first, const Part& second, double share, double length,
                        float* texel) const {
        const auto mean = [&](double a, double b) { return a * share + b * (1 - share); };
        const double extinction = mean(first.extinction, second.extinction);
        const double alpha = opacity_from_depth(extinction * length);
        for (int c = 0; c < table_.channels - 1; ++c) {
            const double color = first.color[c] + (1 - first.alpha) * second.color[c];
            const bool at_limit = !(alpha > std::numeric_limits<double>::min());
            texel[c] = static_cast<float>(at_limit ? mean(first.emission[c], second.emission[c])
                                                   : color / alpha * extinction);
        }
        texel[table_.channels - 1] = static_cast<float>(extinction);
    }

    SegmentTable& table_;
    std::size_t nodes_;
};

}  // namespace

void fill_incremental(SegmentTable& table, int first_layer) {
    IncrementalLayers layers(table);
    for (int layer = first_layer; layer < table.layers; ++layer) {
        parallel_for(table.request.scalar_nodes, 4, [&](std::int64_t back) {
            layers.fill_row(layer, static_cast<std::size_t>(back));
        });
    }
}

}  // namespace lamina
