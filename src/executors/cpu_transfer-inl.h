// SPDX-License-Identifier: Apache-2.0
// Looks up the transfer function, and integrates segments by the pre-integration table:
//   1. Find the intervals of the scalars at both ends, and their coordinates in the table.
//   2. If the intervals differ, cut the segment at the first and the last interval end it crosses.
//   3. Look up each piece's mean extinction and emission: bilinear in scalars, linear in length.
//   4. Composite the pieces front to back.
// These are vector forms of intervals.glsl, transfer_function.glsl and knot_table.glsl in shaders/.
#if defined(LAMINA_EXECUTORS_CPU_TRANSFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_CPU_TRANSFER_INL_H_
#undef LAMINA_EXECUTORS_CPU_TRANSFER_INL_H_
#else
#define LAMINA_EXECUTORS_CPU_TRANSFER_INL_H_
#endif

#include "executors/transfer_tables.h"
#include "simd/members-inl.h"
#include "simd/vectors-inl.h"
#include "tiles/segment_optics-inl.h"

LAMINA_SIMD_BEGIN

// How numbers of an interval are looked up. one: there is a single interval; permute: a vector that
// holds the numbers of all intervals is permuted; gather: numbers are gathered from memory.
enum class Lookup { one, permute, gather };

template <class Body>
LAMINA_INLINE void with_lookup(const CpuTransfer& transfer, const Body& body) {
    if (transfer.intervals == 1) {
        body(std::integral_constant<Lookup, Lookup::one>());
    } else if (transfer.intervals <= static_cast<int>(Float::lanes)) {
        body(std::integral_constant<Lookup, Lookup::permute>());
    } else {
        body(std::integral_constant<Lookup, Lookup::gather>());
    }
}

template <Lookup kind>
LAMINA_INLINE Float look_up(const std::vector<float>& values, Int interval) {
    if constexpr (kind == Lookup::one) {
        return Float(values[0]);
    } else if constexpr (kind == Lookup::permute) {
        return permute(load_unaligned<Float>(values.data()), interval);
    } else {
        return gather(values.data(), interval);
    }
}

// Returns the interval that holds a scalar in [0, 1]. At the value of a step it is the upper one.
template <Lookup kind>
LAMINA_INLINE Int find_interval(const CpuTransfer& transfer, Float scalar) {
    Int interval(0);
    if constexpr (kind == Lookup::one) return interval;
    if (kind == Lookup::permute || transfer.intervals <= CpuTransfer::few) {
        for (int i = 1; i < transfer.intervals; ++i) {
            const FloatMask beyond = scalar >= transfer.left_end[static_cast<std::size_t>(i)];
            interval += zero_unless(beyond, Int(1));
        }
        return interval;
    }
    const Int cell = min(to_int(scalar * 1024.0f), 1023);
    interval = gather(transfer.starts.data(), cell);
    const Int last(transfer.intervals - 1);
    while (true) {
        const Float next = gather(transfer.left_end.data() + 1, interval);
        const FloatMask beyond = (scalar >= next) & (interval < last);
        if (none_of(beyond)) return interval;
        interval += zero_unless(beyond, Int(1));
    }
}

// Returns the place of a scalar in its interval, 0 to 1.
template <Lookup kind>
LAMINA_INLINE Float share_of_interval(const CpuTransfer& transfer, Int interval, Float scalar) {
    const Float end = look_up<kind>(transfer.left_end, interval);
    return clamp01((scalar - end) * look_up<kind>(transfer.inverse_width, interval));
}

// Returns a channel of the colour (0 to 2), or the extinction (3).
template <Lookup kind>
LAMINA_INLINE Float optics_at(const CpuTransfer& transfer, std::size_t channel, Int interval,
                              Float share) {
    return share * look_up<kind>(transfer.change[channel], interval) +
           look_up<kind>(transfer.left[channel], interval);
}

// Tells whether extinction is > 0 anywhere between a scalar in interval `first` and `largest`. The
// interval of `largest` does not count if that is its left end and the extinction there is 0.
template <Lookup kind>
LAMINA_INLINE FloatMask shows_something(const CpuTransfer& transfer, Int first, Float largest) {
    const Int last = find_interval<kind>(transfer, largest);
    const FloatMask before =
        look_up<kind>(transfer.shown_before, last) > look_up<kind>(transfer.shown_before, first);
    return before | (largest > look_up<kind>(transfer.shown_beyond, last));
}

template <Lookup kind>
LAMINA_INLINE Float64 precise_extinction_at(const CpuTransfer& transfer, Int interval,
                                            Float share) {
    const auto sum = [&](const std::vector<float>& value,
                         const std::vector<float>& rest) LAMINA_LAMBDA {
        return Float64(look_up<kind>(value, interval)) + Float64(look_up<kind>(rest, interval));
    };
    const Float64 left = sum(transfer.left[3], transfer.left_rest);
    const Float64 right = sum(transfer.right_extinction, transfer.right_rest);
    return left + Float64(share) * (right - left);
}

// A cell of the table between neighbouring nodes, and the place in it.
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
// An entry of a lit table, with the front parts of both (optics/segment_integral.h).
struct LitEntry : TableEntry {
    Float front_emission[3];
    Float front_extinction;
};
template <bool lit>
using EntryOf = std::conditional_t<lit, LitEntry, TableEntry>;

LAMINA_INLINE Float table_extinction(const KnotTable& table, const TableCell& cell) {
    const auto nodes = static_cast<std::int32_t>(table.nodes.size());
    const float* const entries = table.mean_extinction.data();
    const auto texel = [&](std::int32_t step)
                           LAMINA_LAMBDA { return gather(entries + step, cell.corner); };
    const Float front = mix(texel(0), texel(1), cell.front);
    const Float back = mix(texel(nodes), texel(nodes + 1), cell.front);
    return mix(front, back, cell.back);
}

// Interpolates between a cell's nodes. `right`, `below`: floats to the next front and back node.
template <class V>
LAMINA_INLINE V mixed_nodes(const float* texels, std::ptrdiff_t right, std::ptrdiff_t below,
                            float front, float back) {
    const auto at = [&](std::ptrdiff_t step)
                        LAMINA_LAMBDA { return load_unaligned<V>(texels + step); };
    const V near = mix(at(0), at(right), V(front));
    const V far = mix(at(below), at(below + right), V(front));
    return mix(near, far, V(back));
}

// Interpolates between the four nodes of a cell and two layers of length. The layers' texels lie
// side by side, so that both are interpolated at once if vectors are long enough.
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

// The places at which the lanes of a vector look up entries.
struct EntryPlaces {
    // Number of the entry at the cell's corner and lower layer.
    alignas(64) std::int32_t first[most_lanes];
    alignas(64) float front[most_lanes], back[most_lanes], layer[most_lanes];
};

LAMINA_INLINE void set_places(const CpuTransfer& transfer, const TableCell& cell, Float length,
                              EntryPlaces& places) {
    const auto layers = static_cast<std::int32_t>(transfer.table->lengths.size());
    const Float layer = min(length * transfer.layers_per_length, static_cast<float>(layers - 1));
    const Int lower = min(to_int(layer), std::max(layers - 2, 0));
    store(cell.corner * layers + lower, places.first);
    store(cell.front, places.front);
    store(cell.back, places.back);
    store(layer - to_float(lower), places.layer);
}

// Entries as they are looked up: four numbers for each lane and, for lit tables, four front parts.
template <bool lit>
struct EntryNumbers {
    alignas(64) float whole[4 * most_lanes];
    alignas(64) float front[lit ? 4 * most_lanes : 1];
};

// Calls entry_at(lane) for `wanted` lanes; entries of others become 0. Reading lanes one by one is
// several times as fast as gathers, because the numbers of an entry lie side by side.
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
LAMINA_INLINE void look_up_entries(const CpuTransfer& transfer, const EntryPlaces& places,
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
LAMINA_INLINE EntryOf<lit> table_entry(const CpuTransfer& transfer, const TableCell& cell,
                                       Float length, FloatMask wanted) {
    EntryPlaces places;
    EntryNumbers<lit> entries;
    set_places(transfer, cell, length, places);
    look_up_entries(transfer, places, wanted, entries);
    return load_entry(entries);
}

// A scalar's interval, and its coordinate along an axis of the table, in nodes.
struct TablePlace {
    Int interval;
    Float node;
};

template <Lookup kind>
LAMINA_INLINE TablePlace table_place(const CpuTransfer& transfer, Float scalar) {
    const Int interval = find_interval<kind>(transfer, scalar);
    const Float share = share_of_interval<kind>(transfer, interval, scalar);
    return {interval, share * look_up<kind>(transfer.nodes, interval) +
                          look_up<kind>(transfer.first_node, interval)};
}

// Colour and optical depth of the first pieces of a segment, with associated colour, or of a whole
// segment as integrate_segment() returns it, with colour that is not associated.
struct RunSum {
    Float color[3];
    Float depth;
};
// A sum with front parts (optics/segment_integral.h), which are associated if the colour is.
struct LitSum : RunSum {
    Float front_color[3];
    Float front_share;
};
template <bool lit>
using SumOf = std::conditional_t<lit, LitSum, RunSum>;

template <bool lit>
LAMINA_INLINE SumOf<lit> no_sum() {
    const Float zero(0);
    if constexpr (lit)
        return {{{zero, zero, zero}, zero}, {zero, zero, zero}, zero};
    else
        return {{zero, zero, zero}, zero};
}

// Shares of a lit segment's length: that of a piece, and that of all behind the piece (`left`).
struct PieceShares {
    Float share, left;
};
// Composites a piece with a table entry behind `sum`.
template <bool lit>
LAMINA_INLINE void add_entry(const EntryOf<lit>& entry, Float length, const PieceShares& shares,
                             SumOf<lit>& sum) {
    const Float depth = entry.extinction * length;
    const FloatMask seen = depth > 0;
    const Float transmitted = exp_of(-sum.depth);
    const Float weight =
        zero_unless(seen, transmitted * opacity_from_depth(depth) / entry.extinction);
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] += weight * entry.emission[channel];
    if constexpr (lit) {
        const auto add = [&](Float whole, Float front, Float& to) LAMINA_LAMBDA {
            const Float seen_part = shares.left * whole + shares.share * front;
            to += weight * seen_part;
        };
        for (int channel = 0; channel < 3; ++channel)
            add(entry.emission[channel], entry.front_emission[channel], sum.front_color[channel]);
        add(entry.extinction, entry.front_extinction, sum.front_share);
    }
    sum.depth += depth;
}

struct SegmentEnds {
    Float front, back, length;
    TablePlace front_place, back_place;
};

// A piece of a segment that one look-up integrates: its cell in the table, and its length.
struct TablePiece {
    TableCell cell;
    Float length;
};

// A segment before its look-ups. It is cut at the first and the last end of an interval that it
// crosses: `first` is the piece before the first cut, or all; `between` lies between the cuts;
// `last` is the rest. Most cut segments cross one end only and have nothing between.
struct Segment {
    TablePiece first, between, last;
    Float length;
    FloatMask seen, cut, parted;  // lanes that are visible, that are cut, that have `between`
    bool some_cut;
};

LAMINA_INLINE std::int32_t table_nodes(const CpuTransfer& transfer) {
    return static_cast<std::int32_t>(transfer.table->nodes.size());
}

// Sets `first`, `between` and `last` in lanes that are cut.
template <Lookup kind>
LAMINA_INLINE void cut_segment(const CpuTransfer& transfer, const SegmentEnds& ends,
                               Segment& segment) {
    const std::int32_t nodes = table_nodes(transfer);
    const FloatMask rising = ends.front < ends.back;
    const Int front_interval = ends.front_place.interval, back_interval = ends.back_place.interval;
    const Int first = select(rising, front_interval + 1, front_interval);
    const Int last = select(rising, back_interval, back_interval + 1);
    const Float first_end = look_up<kind>(transfer.left_end, first);
    const Float last_end = look_up<kind>(transfer.left_end, last);
    const auto right_node = [&](Int interval) {
        return look_up<kind>(transfer.first_node, interval) +
               look_up<kind>(transfer.nodes, interval);
    };
    const Float back_end = select(rising, look_up<kind>(transfer.first_node, back_interval),
                                  right_node(back_interval));
    const Float front_end = select(rising, right_node(front_interval),
                                   look_up<kind>(transfer.first_node, front_interval));
    const Float per_scalar = ends.length / (ends.back - ends.front);
    const auto length = [&](Float from, Float to)
                            LAMINA_LAMBDA { return (to - from) * per_scalar; };
    const FloatMask cut = segment.cut;
    segment.parted = cut & (first_end != last_end);
    segment.first = {
        table_cell(nodes, ends.front_place.node, select(cut, front_end, ends.back_place.node)),
        select(cut, length(ends.front, first_end), segment.first.length)};
    segment.between = {table_cell(nodes, look_up<kind>(transfer.first_node, first), back_end),
                       length(first_end, last_end)};
    segment.last = {table_cell(nodes, back_end, ends.back_place.node), length(last_end, ends.back)};
}

// Returns the ends of segments, with valid numbers in lanes that are not cut, so that cut_segment()
// does not read beyond the last interval there.
LAMINA_INLINE SegmentEnds ends_of_cut(const SegmentEnds& whole, FloatMask cut) {
    SegmentEnds ends = whole;
    ends.front_place.interval = zero_unless(cut, ends.front_place.interval);
    ends.back_place.interval = zero_unless(cut, ends.back_place.interval);
    ends.length = zero_unless(cut, ends.length);
    ends.back = select(cut, ends.back, ends.front + 1.0f);
    return ends;
}

// Prepares segments for their look-ups. `seen`: lanes that are visible.
template <Lookup kind>
LAMINA_INLINE Segment segment_of(const CpuTransfer& transfer, Float front, Float back, Float length,
                                 FloatMask seen) {
    const SegmentEnds ends{front, back, length, table_place<kind>(transfer, front),
                           table_place<kind>(transfer, back)};
    Segment segment;
    segment.length = segment.first.length = length;
    segment.seen = seen;
    segment.cut = (ends.front_place.interval != ends.back_place.interval) & seen;
    segment.some_cut = kind != Lookup::one && any_of(segment.cut);
    if (segment.some_cut) {
        cut_segment<kind>(transfer, ends_of_cut(ends, segment.cut), segment);
    } else {
        segment.first.cell =
            table_cell(table_nodes(transfer), ends.front_place.node, ends.back_place.node);
    }
    return segment;
}

template <bool lit>
struct SegmentEntries {
    EntryOf<lit> first, last;
};

// Composites the pieces of cut segments: associated colour and depth. Other lanes are undefined.
template <bool lit>
LAMINA_INLINE SumOf<lit> sum_of_pieces(const CpuTransfer& transfer, const Segment& segment,
                                       const SegmentEntries<lit>& entries) {
    SumOf<lit> sum = no_sum<lit>();
    PieceShares first, between, last;
    if constexpr (lit) {
        const Float inverse = 1.0f / segment.length;
        first.share = segment.first.length * inverse;
        last.share = segment.last.length * inverse;
        last.left = Float(0);
        between.share = segment.between.length * inverse;
        between.left = last.share;
        first.left = between.share + last.share;
    }
    add_entry<lit>(entries.first, segment.first.length, first, sum);
    if (any_of(segment.parted)) {
        const TablePiece& piece = segment.between;
        add_entry<lit>(table_entry<lit>(transfer, piece.cell, piece.length, segment.parted),
                       piece.length, between, sum);
    }
    add_entry<lit>(entries.last, segment.last.length, last, sum);
    return sum;
}

template <bool lit>
LAMINA_INLINE SumOf<lit> integrate_colors(const CpuTransfer& transfer, const Segment& segment,
                                          const SegmentEntries<lit>& entries) {
    const EntryOf<lit>& entry = entries.first;
    SumOf<lit> sum;
    sum.depth = entry.extinction * segment.first.length;
    // The inverse of a smaller extinction is infinite: nothing of such depths can be seen.
    const Float inverse = 1.0f / max(entry.extinction, std::numeric_limits<float>::min());
    for (int channel = 0; channel < 3; ++channel)
        sum.color[channel] = entry.emission[channel] * inverse;
    if constexpr (lit) {
        for (int channel = 0; channel < 3; ++channel)
            sum.front_color[channel] = entry.front_emission[channel] * inverse;
        sum.front_share = entry.front_extinction * inverse;
    }
    if (!segment.some_cut) return sum;
    const SumOf<lit> pieces = sum_of_pieces<lit>(transfer, segment, entries);
    sum.depth = select(segment.cut, pieces.depth, sum.depth);
    const Float opacity = opacity_from_depth(pieces.depth);
    const FloatMask some = pieces.depth > 0;
    const auto put = [&](Float of_pieces, Float& whole) LAMINA_LAMBDA {
        const Float color = zero_unless(some, of_pieces / opacity);
        whole = select(segment.cut, color, whole);
    };
    for (int channel = 0; channel < 3; ++channel) {
        put(pieces.color[channel], sum.color[channel]);
        if constexpr (lit) put(pieces.front_color[channel], sum.front_color[channel]);
    }
    if constexpr (lit) put(pieces.front_share, sum.front_share);
    return sum;
}

// Returns the segments' optical depth alone, from a table without colour.
LAMINA_INLINE Float integrate_depth(const CpuTransfer& transfer, const Segment& segment) {
    const auto depth_of = [&](const TablePiece& piece) LAMINA_LAMBDA {
        return table_extinction(*transfer.table, piece.cell) * piece.length;
    };
    const Float whole = depth_of(segment.first);
    if (!segment.some_cut) return whole;
    Float pieces(0);
    pieces += whole;
    if (any_of(segment.parted)) pieces += depth_of(segment.between);
    pieces += depth_of(segment.last);
    return select(segment.cut, pieces, whole);
}

// Returns the segments' colour, not associated, and optical depth. `entries`: needed if `colored`.
template <bool lit>
LAMINA_INLINE SumOf<lit> integrate_segment(const CpuTransfer& transfer, bool colored,
                                           const Segment& segment,
                                           const SegmentEntries<lit>& entries) {
    SumOf<lit> sum;
    if (colored) {
        sum = integrate_colors<lit>(transfer, segment, entries);
    } else {
        sum.depth = integrate_depth(transfer, segment);
    }
    sum.depth = zero_unless(segment.seen, sum.depth);
    return sum;
}

// Looks up and integrates segments on which the scalar is linear from `front` to `back`.
template <Lookup kind>
LAMINA_INLINE RunSum integrate_run(const CpuTransfer& transfer, bool colored, Float front,
                                   Float back, Float length, FloatMask seen) {
    const Segment segment = segment_of<kind>(transfer, front, back, length, seen);
    SegmentEntries<false> entries;
    const auto entry = [&](const TablePiece& piece, FloatMask wanted) LAMINA_LAMBDA {
        return table_entry<false>(transfer, piece.cell, piece.length, wanted);
    };
    if (colored) entries.first = entry(segment.first, seen);
    if (colored && segment.some_cut) entries.last = entry(segment.last, segment.cut);
    return integrate_segment<false>(transfer, colored, segment, entries);
}

LAMINA_SIMD_END

#endif
