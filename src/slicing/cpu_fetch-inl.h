// SPDX-License-Identifier: Apache-2.0
// Fetches the eight samples at the corners of a cell and interpolates the scalar between them. Each
// lane of a vector has a point and a cell of its own.
//
//   for each point:
//       cell, weights = the cell that holds the point, and the point's position in it     cell_at()
//       index = place of the cell's lowest corner in memory, or in a page            cell_index()
//       pairs = the four pairs of samples that are neighbours along x                fetch_pairs()
//       corners = the pairs as floats                                               unpack_pairs()
//       scalar = trilinear mix of the corners by the weights                         interpolate()
//
// Codes are samples as stored, integers; CpuBrick says how they become normalised scalars.
#if defined(LAMINA_SLICING_CPU_FETCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SLICING_CPU_FETCH_INL_H_
#undef LAMINA_SLICING_CPU_FETCH_INL_H_
#else
#define LAMINA_SLICING_CPU_FETCH_INL_H_
#endif

#include <cstring>

#include "slicing/cpu_rays-inl.h"
#include "slicing/cpu_volume.h"

LAMINA_SIMD_BEGIN

// Returns a cell's index if the volume is in pages: the page's number among those of the brick in
// the high bits, the cell's x, y and z in the page in the low bits (CpuPages).
LAMINA_INLINE Int page_index(const CpuPages& pages, Int x, Int y, Int z) {
    constexpr int bits = CpuPages::place_bits;
    const Int mask(CpuPages::places);
    x += pages.offset[0];
    y += pages.offset[1];
    z += pages.offset[2];
    const Int page = shift_right<bits>(x) +
                     (shift_right<bits>(y) * pages.row + shift_right<bits>(z) * pages.slice);
    const Int in_page = (x & mask) | (shift_left<bits>(y & mask) | shift_left<2 * bits>(z & mask));
    return shift_left<CpuPages::page_bits>(page) | in_page;
}

// Returns the index by which a cell's samples are fetched. x, y, z: the cell's lowest corner, in
// samples from the brick's first one.
LAMINA_INLINE Int cell_index(const CpuBrick& brick, Int x, Int y, Int z) {
    if (brick.pages != nullptr) [[unlikely]]
        return page_index(*brick.pages, x, y, z);
    return x + (y * brick.row + z * brick.slice);
}

// Calls visit(i, page, offset) for each of `count` cells, after reading pages that are not in
// memory. `page`: first byte of the cell's page; `offset`: samples from there to the cell's lowest
// corner.
template <class Visit>
LAMINA_INLINE void visit_pages(const CpuPages& pages, const std::int32_t* indices,
                               std::size_t count, const Visit& visit) {
    for (std::size_t from = 0; from < count; from += BrickCache::most_held) {
        const std::size_t end = std::min(count, from + BrickCache::most_held);
        const auto held = pages.cache->hold(
            end - from, [&](std::size_t i) { return pages.number_of(indices[from + i]); });
        for (std::size_t i = from; i < end; ++i)
            visit(i, pages.cache->at(pages.number_of(indices[i])), CpuPages::place_of(indices[i]));
    }
}

// Copies the four pairs of neighbours along x of one cell to pairs[0 .. 3][i]. `from`: the cell's
// lowest corner; `row`, `slice`: bytes from a sample to the next one along y and z.
template <class Pair, std::size_t size>
LAMINA_INLINE void copy_pairs(const std::byte* from, std::size_t row, std::size_t slice,
                              std::size_t i, Pair (&pairs)[4][size]) {
    std::memcpy(&pairs[0][i], from, sizeof(Pair));
    std::memcpy(&pairs[1][i], from + row, sizeof(Pair));
    std::memcpy(&pairs[2][i], from + slice, sizeof(Pair));
    std::memcpy(&pairs[3][i], from + slice + row, sizeof(Pair));
}

template <class Pair, std::size_t size>
inline LAMINA_NOINLINE void fetch_paged_pairs(const CpuPages& pages, const std::int32_t* indices,
                                              std::size_t count, Pair (&pairs)[4][size]) {
    constexpr std::size_t bytes = sizeof(Pair) / 2;
    constexpr std::size_t row = bytes * static_cast<std::size_t>(BrickCache::row);
    constexpr std::size_t slice = bytes * static_cast<std::size_t>(BrickCache::slice);
    visit_pages(pages, indices, count,
                [&](std::size_t i, const std::byte* page, std::size_t offset) {
                    copy_pairs(page + bytes * offset, row, slice, i, pairs);
                });
}

// One point in each lane, in samples from the brick's first sample.
struct Points {
    Float at[3];  // x, y, z
};

// The samples at a cell's eight corners. The elements of both arrays are the corners at (y, z),
// (y + 1, z), (y, z + 1) and (y + 1, z + 1).
struct Corners {
    Float lower[4], upper[4];  // at x and at x + 1
};

LAMINA_INLINE Float low_byte(Word v) {
    return to_float(bits_as<Int>(v & 0xffu));
}

// Converts words below 2^31.
LAMINA_INLINE Float to_float(Word v) {
    return to_float(bits_as<Int>(v));
}

// Fetches the corners of the cells with gather instructions. Unlike fetch_pairs(), it works if the
// volume has one sample along x: that sample is then both neighbours.
template <CpuLayout layout>
LAMINA_INLINE Corners fetch_corners(const CpuBrick& brick, Int index) {
    Corners corners;
    const std::int32_t steps[4] = {0, brick.row, brick.slice, brick.row + brick.slice};
    if constexpr (layout == CpuLayout::floats) {
        const std::int32_t next = brick.last_sample[0] > 0 ? 1 : 0;
        for (int i = 0; i < 4; ++i) {
            const float* const from = static_cast<const float*>(brick.samples) + steps[i];
            corners.lower[i] = gather(from, index);
            corners.upper[i] = gather(from + next, index);
        }
    } else {
        // Reads 32 bits, which hold a sample and the next one along x. If they would reach beyond
        // the end of the samples, reads the last 32 bits instead and shifts the sample down.
        constexpr int size = layout == CpuLayout::bytes ? 1 : 2;
        const auto* const words = static_cast<const std::uint32_t*>(brick.samples);
        for (int i = 0; i < 4; ++i) {
            Int offset = index + steps[i];
            if constexpr (size == 2) offset = shift_left<1>(offset);
            const Int inside = min(offset, brick.last_word);
            const Word shift = bits_as<Word>(shift_left<3>(offset - inside));
            Word pair = shift_right(gather_at_bytes(words, inside), shift);
            if constexpr (size == 1) {
                corners.lower[i] = low_byte(pair);
                corners.upper[i] = low_byte(shift_right<8>(pair));
            } else {
                pair = pair ^ brick.flip;
                corners.lower[i] = to_float(pair & 0xffffu);
                corners.upper[i] = to_float(shift_right<16>(pair));
            }
        }
    }
    return corners;
}

// An integer as large as two samples: a sample and its next neighbour along x.
template <CpuLayout layout>
using PairOf = std::conditional_t<
    layout == CpuLayout::bytes, std::uint16_t,
    std::conditional_t<layout == CpuLayout::words, std::uint32_t, std::uint64_t>>;

// Calls body() with the layout as a compile-time constant.
template <class Body>
LAMINA_INLINE void with_layout(CpuLayout layout, const Body& body) {
    switch (layout) {
        case CpuLayout::bytes:
            return body(std::integral_constant<CpuLayout, CpuLayout::bytes>());
        case CpuLayout::words:
            return body(std::integral_constant<CpuLayout, CpuLayout::words>());
        case CpuLayout::floats:
            return body(std::integral_constant<CpuLayout, CpuLayout::floats>());
    }
    unreachable_enum();
}

// Fetches the four pairs of neighbours along x of `count` cells, in the order of Corners. Scalar
// code, one cell after the other, is faster here than gather instructions. The volume must have at
// least two samples along x.
template <class Pair, std::size_t size>
inline LAMINA_NOINLINE void fetch_pairs(const CpuBrick& brick, const std::int32_t* indices,
                                        std::size_t count, Pair (&pairs)[4][size]) {
    if (brick.pages != nullptr) return fetch_paged_pairs(*brick.pages, indices, count, pairs);
    const auto* const samples = static_cast<const std::byte*>(brick.samples);
    constexpr std::size_t bytes = sizeof(Pair) / 2;
    const std::size_t row = bytes * static_cast<std::size_t>(brick.row);
    const std::size_t slice = bytes * static_cast<std::size_t>(brick.slice);
    for (std::size_t i = 0; i < count; ++i) {
        copy_pairs(samples + bytes * static_cast<std::size_t>(indices[i]), row, slice, i, pairs);
    }
}

// Converts the pairs of cells i, i + 1, ... to corners, one cell in each lane.
template <CpuLayout layout, class Pair, std::size_t size>
LAMINA_INLINE Corners unpack_pairs(const CpuBrick& brick, const Pair (&pairs)[4][size],
                                   std::size_t i) {
    Corners corners;
    for (int corner = 0; corner < 4; ++corner) {
        const Pair* const from = pairs[corner] + i;
        if constexpr (layout == CpuLayout::floats) {
            load_interleaved(reinterpret_cast<const float*>(from), corners.lower[corner],
                             corners.upper[corner]);
        } else if constexpr (layout == CpuLayout::words) {
            const Word pair = load_unaligned<Word>(from) ^ brick.flip;
            corners.lower[corner] = to_float(pair & 0xffffu);
            corners.upper[corner] = to_float(shift_right<16>(pair));
        } else {
            const Word pair = load_halves(from);
            corners.lower[corner] = low_byte(pair);
            corners.upper[corner] = to_float(shift_right<8>(pair));
        }
    }
    return corners;
}

// Rounds an interpolation weight to 8 bits, as texture units do (docs/numerics.md, section 2).
LAMINA_INLINE Float hardware_weight(Float weight) {
    return round(weight * 256.0f) * (1.0f / 256);
}

// Interpolates trilinearly; x, y, z: weights of the upper corners, 0 to 1.
LAMINA_INLINE Float interpolate(const Corners& corners, Float x, Float y, Float z) {
    Float along_x[4];
    for (int i = 0; i < 4; ++i) along_x[i] = mix(corners.lower[i], corners.upper[i], x);
    return mix(mix(along_x[0], along_x[1], y), mix(along_x[2], along_x[3], y), z);
}

// How sample_points() treats points.
enum class PointKind {
    inside,    // used as they are: the caller knows that they lie in the brick
    anywhere,  // clamped to the brick, from its first to its last sample
    exact      // clamped; and codes are scaled as textures scale them, before interpolation and not
               // after it, so that scalars equal those of OpenGL's shaders bit for bit
};

// The cell that holds a point, and the point's position in it: the weights of interpolation.
struct Cell {
    Int index;        // cell_index()
    Float weight[3];  // along x, y, z: 0 at the cell's lower face, 1 at its upper face
};

// Finds the cell of each point. At the brick's upper face it is the last cell, with weight 1.
template <PointKind kind>
LAMINA_INLINE Cell cell_at(const CpuBrick& brick, const Points& points) {
    Cell cell;
    const auto lower_along = [&](std::size_t axis, Float p) LAMINA_LAMBDA {
        Float least = p;
        if constexpr (kind != PointKind::inside) {
            const float last = brick.last_sample[axis];
            p = clamp(p, 0, last);
            least = min(p, std::max(last - 1.0f, 0.0f));
        }
        const Int lower = to_int(least);
        cell.weight[axis] = p - to_float(lower);
        return lower;
    };
    const Int x = lower_along(0, points.at[0]), y = lower_along(1, points.at[1]),
              z = lower_along(2, points.at[2]);
    cell.index = cell_index(brick, x, y, z);
    return cell;
}

// Returns the normalised scalar at a point of a cell. `weight`: as in Cell.
template <CpuLayout layout, PointKind kind>
LAMINA_INLINE Float scalar_in(const CpuBrick& brick, Corners corners, const Float* weight) {
    float scale = brick.scale;
    if constexpr (kind == PointKind::exact && layout != CpuLayout::floats) {
        for (int i = 0; i < 4; ++i) {
            corners.lower[i] *= brick.unit;
            corners.upper[i] *= brick.unit;
        }
        scale = brick.unit_scale;
    }
    const Float mixed = interpolate(corners, weight[0], weight[1], weight[2]);
    if constexpr (layout == CpuLayout::floats) return mixed;
    return mixed * scale + brick.offset;
}

// Prefetches the samples of some lanes' cells into the cache: one pixel in each row and column of a
// block, because the cells of its neighbours are mostly in the same cache lines. `samples`: the
// brick's samples, or its gradients; `bytes`: size of one.
template <std::size_t bytes>
LAMINA_INLINE void prefetch_cells(const CpuBrick& brick, const void* samples,
                                  const std::int32_t* indices) {
    if (brick.pages != nullptr) return;
    const std::size_t slice = bytes * static_cast<std::size_t>(brick.slice);
    for (std::size_t lane = 0; lane < Float::lanes; lane += TileGrid::block + 1) {
        const std::byte* const at = static_cast<const std::byte*>(samples) +
                                    bytes * static_cast<std::size_t>(indices[lane]);
        __builtin_prefetch(at);
        __builtin_prefetch(at + slice);
    }
}

// Samples as sample_points() does, for half a block of slabs at a time, in three stages: find the
// cells of all points, fetch their samples, interpolate. Most fetches thus wait for memory
// together.
template <CpuLayout layout, PointKind kind, class PointAt>
LAMINA_INLINE void sample_in_stages(const CpuBrick& brick, bool hardware, int first, int end,
                                    const PointAt& point_at, float* scalars) {
    // One more than half a block, because n slabs have n + 1 boundaries.
    constexpr int most_points = block_slabs / 2 + 1;
    constexpr std::size_t lanes = Float::lanes;
    alignas(64) std::int32_t indices[most_points * most_lanes];
    alignas(64) float weights[3][most_points * most_lanes];
    PairOf<layout> pairs[4][most_points * most_lanes];
    for (int begin = first; begin < end; begin += most_points) {
        const auto count = static_cast<std::size_t>(std::min(most_points, end - begin));
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t lane = i * lanes;
            const Cell cell = cell_at<kind>(brick, point_at(begin + static_cast<int>(i)));
            store(cell.index, indices + lane);
            prefetch_cells<bytes_of_sample(layout)>(brick, brick.samples, indices + lane);
            for (std::size_t axis = 0; axis < 3; ++axis)
                store(cell.weight[axis], weights[axis] + lane);
        }
        fetch_pairs(brick, indices, count * lanes, pairs);
        if (hardware) {
            for (float* const weight : weights) {
                for (std::size_t i = 0; i < count * lanes; i += lanes)
                    store(hardware_weight(load<Float>(weight + i)), weight + i);
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t lane = i * lanes;
            const Float weight[3] = {load<Float>(weights[0] + lane), load<Float>(weights[1] + lane),
                                     load<Float>(weights[2] + lane)};
            const Corners corners = unpack_pairs<layout>(brick, pairs, lane);
            store(scalar_in<layout, kind>(brick, corners, weight),
                  scalars + (static_cast<std::size_t>(begin) + i) * most_lanes);
        }
    }
}

// Samples as sample_points() does, for a brick with one sample along x.
template <CpuLayout layout, PointKind kind, class PointAt>
LAMINA_INLINE void sample_by_gathers(const CpuBrick& brick, bool hardware, int first, int end,
                                     const PointAt& point_at, float* scalars) {
    for (int i = first; i < end; ++i) {
        Cell cell = cell_at<kind>(brick, point_at(i));
        if (hardware) {
            for (Float& weight : cell.weight) weight = hardware_weight(weight);
        }
        const Corners corners = fetch_corners<layout>(brick, cell.index);
        store(scalar_in<layout, kind>(brick, corners, cell.weight),
              scalars + static_cast<std::size_t>(i) * most_lanes);
    }
}

// Writes the normalised scalars at the points point_at(i), a vector of them for each i from `first`
// to end - 1, to scalars + i * most_lanes. `hardware`: with the rounded weights of texture units.
template <PointKind kind, class PointAt>
LAMINA_INLINE void sample_points(const CpuBrick& brick, bool hardware, int first, int end,
                                 const PointAt& point_at, float* scalars) {
    with_layout(brick.layout, [&](auto of_samples) LAMINA_LAMBDA {
        constexpr CpuLayout layout = decltype(of_samples)::value;
        if (brick.last_sample[0] > 0 || brick.pages != nullptr)
            return sample_in_stages<layout, kind>(brick, hardware, first, end, point_at, scalars);
        sample_by_gathers<layout, kind>(brick, hardware, first, end, point_at, scalars);
    });
}

LAMINA_SIMD_END

#endif
