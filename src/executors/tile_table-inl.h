// SPDX-License-Identifier: Apache-2.0
// Look-ups in the pre-integration table: vector form of shaders/optics/preintegration.glsl.
#if defined(LAMINA_EXECUTORS_TILE_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_TABLE_INL_H_
#undef LAMINA_EXECUTORS_TILE_TABLE_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_TABLE_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "executors/tile_optics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// A cell of the table and the position in it.
struct TableCell {
    Ints corner;  // front node + nodes * back node
    Floats front, back;
};

HWY_INLINE TableCell table_cell(std::int32_t nodes, Floats front, Floats back) {
    const FloatTag d;
    const IntTag di;
    const Ints last = hn::Set(di, nodes - 2);
    const Ints column = hn::Min(hn::ConvertTo(di, front), last);
    const Ints row = hn::Min(hn::ConvertTo(di, back), last);
    return {hn::Add(column, hn::Mul(row, hn::Set(di, nodes))),
            hn::Sub(front, hn::ConvertTo(d, column)), hn::Sub(back, hn::ConvertTo(d, row))};
}

// An entry of the table: mean extinction and, in coloured tables, emission.
struct TableEntry {
    Floats emission[3];
    Floats extinction;
};
// Of a lit table, with front parts of both.
struct LitEntry : TableEntry {
    Floats front_emission[3];
    Floats front_extinction;
};
template <bool lit>
using EntryOf = std::conditional_t<lit, LitEntry, TableEntry>;

// Interpolates bilinearly between the four nodes of a cell.
HWY_INLINE Floats table_extinction(const PreintegrationTable& table, const TableCell& cell) {
    const FloatTag d;
    const auto nodes = static_cast<std::int32_t>(table.nodes.size());
    const float* const entries = table.mean_extinction.data();
    const auto texel = [&](std::int32_t step)
                           HWY_ATTR { return hn::GatherIndex(d, entries + step, cell.corner); };
    const Floats front = mix(texel(0), texel(1), cell.front);
    const Floats back = mix(texel(nodes), texel(nodes + 1), cell.front);
    return mix(front, back, cell.back);
}

template <class D>
HWY_INLINE hn::Vec<D> mixed_nodes(D d, const float* texels, std::ptrdiff_t right,
                                  std::ptrdiff_t below, float front, float back) {
    const auto share = hn::Set(d, front);
    const auto near = mix(hn::LoadU(d, texels), hn::LoadU(d, texels + right), share);
    const auto far = mix(hn::LoadU(d, texels + below), hn::LoadU(d, texels + below + right), share);
    return mix(near, far, hn::Set(d, back));
}

// Interpolates between two layers of length. Their texels lie side by side, so that both are
// interpolated at once where vectors are long enough.
template <class D8>
HWY_INLINE void mix_layers(D8 d8, const float* texels, std::ptrdiff_t right, std::ptrdiff_t below,
                           float front, float back, float layer, float* entry) {
    const hn::FixedTag<float, 4> d4;
    const auto share = hn::Set(d4, layer);
    if constexpr (hn::MaxLanes(d8) == 8) {
        const auto both = mixed_nodes(d8, texels, right, below, front, back);
        hn::Store(mix(hn::LowerHalf(d4, both), hn::UpperHalf(d4, both), share), d4, entry);
    } else {
        const auto one = mixed_nodes(d4, texels, right, below, front, back);
        const auto next = mixed_nodes(d4, texels + 4, right, below, front, back);
        hn::Store(mix(one, next, share), d4, entry);
    }
}

// Calls body(lane) for the lanes of a mask.
template <class Body>
HWY_INLINE void for_each_lane(FloatMask mask, const Body& body) {
    alignas(8) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(FloatTag(), mask, bytes);
    for (std::uint32_t bits = bytes[0] | std::uint32_t{bytes[1]} << 8; bits != 0; bits &= bits - 1)
        body(static_cast<std::size_t>(std::countr_zero(bits)));
}

// The positions at which the lanes of a vector look up entries.
struct EntryPlaces {
    // Number of the entry at the cell's corner and lower layer.
    alignas(64) std::int32_t first[most_lanes];
    alignas(64) float front[most_lanes], back[most_lanes], layer[most_lanes];
};

HWY_INLINE void set_places(const TileTransfer& transfer, const TableCell& cell, Floats length,
                           EntryPlaces& places) {
    const FloatTag d;
    const IntTag di;
    const auto layers = static_cast<std::int32_t>(transfer.table->lengths.size());
    const Floats layer = hn::Min(hn::Mul(length, hn::Set(d, transfer.layers_per_length)),
                                 hn::Set(d, static_cast<float>(layers - 1)));
    const Ints lower = hn::Min(hn::ConvertTo(di, layer), hn::Set(di, std::max(layers - 2, 0)));
    hn::Store(hn::Add(hn::Mul(cell.corner, hn::Set(di, layers)), lower), di, places.first);
    hn::Store(cell.front, d, places.front);
    hn::Store(cell.back, d, places.back);
    hn::Store(hn::Sub(layer, hn::ConvertTo(d, lower)), d, places.layer);
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
HWY_INLINE void set_entries(FloatMask wanted, EntryNumbers<lit>& entries, const EntryAt& entry_at) {
    const FloatTag d;
    if (hn::AllTrue(d, wanted)) {
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) entry_at(lane);
        return;
    }
    for (std::size_t i = 0; i < 4; ++i) {
        hn::Store(hn::Zero(d), d, entries.whole + i * hn::Lanes(d));
        if constexpr (lit) hn::Store(hn::Zero(d), d, entries.front + i * hn::Lanes(d));
    }
    for_each_lane(wanted, entry_at);
}

template <bool lit>
HWY_INLINE void look_up_entries(const TileTransfer& transfer, const EntryPlaces& places,
                                FloatMask wanted, EntryNumbers<lit>& entries) {
    constexpr std::ptrdiff_t size = lit ? 8 : 4;
    const auto nodes = static_cast<std::ptrdiff_t>(transfer.table->nodes.size());
    const auto layers = static_cast<std::ptrdiff_t>(transfer.table->lengths.size());
    const std::ptrdiff_t right = size * layers, below = right * nodes;
    const float* const texels = transfer.texels.data();
    const auto texels_at = [&](std::size_t lane) HWY_ATTR {
        return texels + size * static_cast<std::ptrdiff_t>(places.first[lane]);
    };
    const hn::FixedTag<float, 4> d4;
    const auto nodes_at = [&](std::size_t lane, std::ptrdiff_t step) HWY_ATTR {
        return mixed_nodes(d4, texels_at(lane) + step, right, below, places.front[lane],
                           places.back[lane]);
    };
    if (layers == 1) {
        set_entries(wanted, entries, [&](std::size_t lane) HWY_ATTR {
            hn::Store(nodes_at(lane, 0), d4, entries.whole + 4 * lane);
            if constexpr (lit) hn::Store(nodes_at(lane, 4), d4, entries.front + 4 * lane);
        });
    } else if constexpr (lit) {
        set_entries(wanted, entries, [&](std::size_t lane) HWY_ATTR {
            const auto share = hn::Set(d4, places.layer[lane]);
            hn::Store(mix(nodes_at(lane, 0), nodes_at(lane, 8), share), d4,
                      entries.whole + 4 * lane);
            hn::Store(mix(nodes_at(lane, 4), nodes_at(lane, 12), share), d4,
                      entries.front + 4 * lane);
        });
    } else {
        set_entries(wanted, entries, [&](std::size_t lane) HWY_ATTR {
            mix_layers(hn::CappedTag<float, 8>(), texels_at(lane), right, below, places.front[lane],
                       places.back[lane], places.layer[lane], entries.whole + 4 * lane);
        });
    }
}

template <bool lit>
HWY_INLINE EntryOf<lit> load_entry(const EntryNumbers<lit>& entries) {
    const FloatTag d;
    EntryOf<lit> entry;
    hn::LoadInterleaved4(d, entries.whole, entry.emission[0], entry.emission[1], entry.emission[2],
                         entry.extinction);
    if constexpr (lit) {
        hn::LoadInterleaved4(d, entries.front, entry.front_emission[0], entry.front_emission[1],
                             entry.front_emission[2], entry.front_extinction);
    }
    return entry;
}

template <bool lit>
HWY_INLINE EntryOf<lit> table_entry(const TileTransfer& transfer, const TableCell& cell,
                                    Floats length, FloatMask wanted) {
    EntryPlaces places;
    EntryNumbers<lit> entries;
    set_places(transfer, cell, length, places);
    look_up_entries(transfer, places, wanted, entries);
    return load_entry(entries);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
