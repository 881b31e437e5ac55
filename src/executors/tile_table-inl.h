// SPDX-License-Identifier: Apache-2.0
// Look-ups in the pre-integration table: vector form of shaders/optics/preintegration.glsl.
#if defined(LAMINA_EXECUTORS_TILE_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_TABLE_INL_H_
#undef LAMINA_EXECUTORS_TILE_TABLE_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_TABLE_INL_H_
#endif

#include <bit>

#include "executors/tile_optics-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN

// A cell of the table and the position in it.
struct TableCell {
    Int corner;  // front node + nodes * back node
    Float front, back;
};

LAMINA_INLINE TableCell table_cell(std::int32_t nodes, Float front, Float back) {
    const Int column = min(to_int(front), nodes - 2);
    const Int row = min(to_int(back), nodes - 2);
    return {column + row * nodes, front - to_float(column), back - to_float(row)};
}

// An entry of the table: mean extinction and, in coloured tables, emission.
struct TableEntry {
    Float emission[3];
    Float extinction;
};
// Of a lit table, with front parts of both.
struct LitEntry : TableEntry {
    Float front_emission[3];
    Float front_extinction;
};
template <bool lit>
using EntryOf = std::conditional_t<lit, LitEntry, TableEntry>;

// Interpolates bilinearly between the four nodes of a cell.
LAMINA_INLINE Float table_extinction(const PreintegrationTable& table, const TableCell& cell) {
    const auto nodes = static_cast<std::int32_t>(table.nodes.size());
    const float* const entries = table.mean_extinction.data();
    const auto texel = [&](std::int32_t step)
                           LAMINA_LAMBDA { return gather(entries + step, cell.corner); };
    const Float front = mix(texel(0), texel(1), cell.front);
    const Float back = mix(texel(nodes), texel(nodes + 1), cell.front);
    return mix(front, back, cell.back);
}

template <class V>
LAMINA_INLINE V mixed_nodes(const float* texels, std::ptrdiff_t right, std::ptrdiff_t below,
                            float front, float back) {
    const auto at = [&](std::ptrdiff_t step)
                        LAMINA_LAMBDA { return load_unaligned<V>(texels + step); };
    const V near = mix(at(0), at(right), V(front));
    const V far = mix(at(below), at(below + right), V(front));
    return mix(near, far, V(back));
}

// Interpolates between two layers of length. Their texels lie side by side, so that both are
// interpolated at once if vectors are long enough.
template <class V8>
LAMINA_INLINE void mix_layers(const float* texels, std::ptrdiff_t right, std::ptrdiff_t below,
                              float front, float back, float layer, float* entry) {
    if constexpr (V8::lanes == 8) {
        const V8 both = mixed_nodes<V8>(texels, right, below, front, back);
        store(mix(lower_half(both), upper_half(both), Float4(layer)), entry);
    } else {
        const Float4 one = mixed_nodes<Float4>(texels, right, below, front, back);
        const Float4 next = mixed_nodes<Float4>(texels + 4, right, below, front, back);
        store(mix(one, next, Float4(layer)), entry);
    }
}

// The positions at which the lanes of a vector look up entries.
struct EntryPlaces {
    // Number of the entry at the cell's corner and lower layer.
    alignas(64) std::int32_t first[most_lanes];
    alignas(64) float front[most_lanes], back[most_lanes], layer[most_lanes];
};

LAMINA_INLINE void set_places(const TileTransfer& transfer, const TableCell& cell, Float length,
                              EntryPlaces& places) {
    const auto layers = static_cast<std::int32_t>(transfer.table->lengths.size());
    const Float layer = min(length * transfer.layers_per_length, static_cast<float>(layers - 1));
    const Int lower = min(to_int(layer), std::max(layers - 2, 0));
    store(cell.corner * layers + lower, places.first);
    store(cell.front, places.front);
    store(cell.back, places.back);
    store(layer - to_float(lower), places.layer);
}

// Entries as they are looked up: four numbers a lane, and four more of lit tables.
template <bool lit>
struct EntryNumbers {
    alignas(64) float whole[4 * most_lanes];
    alignas(64) float front[lit ? 4 * most_lanes : 1];
};

// Calls entry_at(lane) for the lanes that are `wanted`; the entries of other lanes become 0. It
// goes lane by lane, because the numbers of an entry lie side by side: this is several times as
// fast as gathers of one number each.
template <bool lit, class EntryAt>
LAMINA_INLINE void set_entries(FloatMask wanted, EntryNumbers<lit>& entries,
                               const EntryAt& entry_at) {
    if (all_of(wanted)) {
        for (std::size_t lane = 0; lane < Float::lanes; ++lane) entry_at(lane);
        return;
    }
    for (std::size_t i = 0; i < 4; ++i) {
        store(Float(0), entries.whole + i * Float::lanes);
        if constexpr (lit) store(Float(0), entries.front + i * Float::lanes);
    }
    for_each_lane(bits_of(wanted), entry_at);
}

template <bool lit>
LAMINA_INLINE void look_up_entries(const TileTransfer& transfer, const EntryPlaces& places,
                                   FloatMask wanted, EntryNumbers<lit>& entries) {
    constexpr std::ptrdiff_t size = lit ? 8 : 4;
    const auto nodes = static_cast<std::ptrdiff_t>(transfer.table->nodes.size());
    const auto layers = static_cast<std::ptrdiff_t>(transfer.table->lengths.size());
    const std::ptrdiff_t right = size * layers, below = right * nodes;
    const float* const texels = transfer.texels.data();
    const auto texels_at = [&](std::size_t lane) LAMINA_LAMBDA {
        return texels + size * static_cast<std::ptrdiff_t>(places.first[lane]);
    };
    const auto nodes_at = [&](std::size_t lane, std::ptrdiff_t step) LAMINA_LAMBDA {
        return mixed_nodes<Float4>(texels_at(lane) + step, right, below, places.front[lane],
                                   places.back[lane]);
    };
    if (layers == 1) {
        set_entries(wanted, entries, [&](std::size_t lane) LAMINA_LAMBDA {
            store(nodes_at(lane, 0), entries.whole + 4 * lane);
            if constexpr (lit) store(nodes_at(lane, 4), entries.front + 4 * lane);
        });
    } else if constexpr (lit) {
        set_entries(wanted, entries, [&](std::size_t lane) LAMINA_LAMBDA {
            const Float4 share(places.layer[lane]);
            store(mix(nodes_at(lane, 0), nodes_at(lane, 8), share), entries.whole + 4 * lane);
            store(mix(nodes_at(lane, 4), nodes_at(lane, 12), share), entries.front + 4 * lane);
        });
    } else {
        set_entries(wanted, entries, [&](std::size_t lane) LAMINA_LAMBDA {
            mix_layers<Float8>(texels_at(lane), right, below, places.front[lane], places.back[lane],
                               places.layer[lane], entries.whole + 4 * lane);
        });
    }
}

template <bool lit>
LAMINA_INLINE EntryOf<lit> load_entry(const EntryNumbers<lit>& entries) {
    EntryOf<lit> entry;
    load_interleaved(entries.whole, entry.emission[0], entry.emission[1], entry.emission[2],
                     entry.extinction);
    if constexpr (lit) {
        load_interleaved(entries.front, entry.front_emission[0], entry.front_emission[1],
                         entry.front_emission[2], entry.front_extinction);
    }
    return entry;
}

template <bool lit>
LAMINA_INLINE EntryOf<lit> table_entry(const TileTransfer& transfer, const TableCell& cell,
                                       Float length, FloatMask wanted) {
    EntryPlaces places;
    EntryNumbers<lit> entries;
    set_places(transfer, cell, length, places);
    look_up_entries(transfer, places, wanted, entries);
    return load_entry(entries);
}

LAMINA_SIMD_END

#endif
