// SPDX-License-Identifier: Apache-2.0
#include "projection/tet_setup.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "projection/tet_setup.cpp"
#include "simd/foreach_target.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "optics/segment_integral.h"
#include "projection/tet_setup-inl.h"

LAMINA_SIMD_BEGIN

// Writes a group of four numbers to some records, from `offset` bytes after the start of each. They
// are copied as bytes: some are integers.
template <std::size_t offset, typename Record>
LAMINA_INLINE void write_group(const TetSetup::Lanes::Group& rows, std::size_t count,
                               Record* records) {
    static_assert(offset % 16 == 0 && sizeof(Record) % 16 == 0);
    constexpr std::size_t together = 4;
    for (std::size_t first = 0; first < count; first += together) {
        Float4 columns[together];
        for (std::size_t i = 0; i < together; ++i)
            columns[i] = load<Float4>(rows[i].data() + first);
        transpose(columns);
        for (std::size_t i = 0; i < std::min(together, count - first); ++i) {
            alignas(16) float group[together];
            store(columns[i], group);
            auto* const record = reinterpret_cast<std::byte*>(records + first + i);
            std::memcpy(record + offset, group, sizeof(group));
        }
    }
}

// The groups have the layout of four numbers side by side in these types.
static_assert(sizeof(PixelArea) == 16 && std::is_base_of_v<PixelArea, PartArea>);
static_assert(sizeof(GradientRecord::Component) == 16);
static_assert(offsetof(SeenTet, center_z) == offsetof(SeenTet, center) + 12);
static_assert(offsetof(SeenTet, scalar_per_row) == offsetof(SeenTet, scalar) + 12);
static_assert(offsetof(TetRecord, fronts) == offsetof(TetRecord, least) + 8);
static_assert(offsetof(TetRecord, number) == offsetof(TetRecord, least) + 12);
static_assert(offsetof(FragmentRecord, upper_cut_per_column) == offsetof(TetRecord, least));
static_assert(offsetof(FragmentRecord, fronts) == offsetof(TetRecord, fronts));
static_assert(offsetof(FragmentRecord, number) == offsetof(TetRecord, number));
static_assert(offsetof(FragmentRecord, upper_cut) == offsetof(FragmentRecord, lower_cut) + 12);

LAMINA_INLINE void write_records(const TetSetup::Lanes& lanes, bool parts, std::size_t count,
                                 SilhouetteRecord* records) {
    write_group<offsetof(SeenTet, depth)>(lanes.depth, count, records);
    write_group<offsetof(SeenTet, depth_per_column)>(lanes.per_column, count, records);
    write_group<offsetof(SeenTet, depth_per_row)>(lanes.per_row, count, records);
    write_group<offsetof(SeenTet, center)>(lanes.center, count, records);
    write_group<offsetof(SeenTet, scalar)>(lanes.scalar, count, records);
    write_group<offsetof(TetRecord, least)>(lanes.limits, count, records);
    if (!parts) return;
    write_group<offsetof(FragmentRecord, lower_cut)>(lanes.cuts, count, records);
    write_group<offsetof(FragmentRecord, low)>(lanes.low, count, records);
    write_group<offsetof(FragmentRecord, high)>(lanes.high, count, records);
}

LAMINA_INLINE void write_gradients(const TetSetup::Lanes& lanes, std::size_t count,
                                   GradientRecord* lit) {
    constexpr std::size_t component = sizeof(GradientRecord::Component);
    write_group<0>(lanes.lit[0], count, lit);
    write_group<component>(lanes.lit[1], count, lit);
    write_group<2 * component>(lanes.lit[2], count, lit);
}

// Sets up one vector after the other, and writes `count` records, their gradients if `lit` is not
// null, and the pixels of areas.
void set_up_vectors(const SetupView& view, bool parts, TetSetup::Lanes& lanes, std::size_t count,
                    SilhouetteRecord* records, GradientRecord* lit, PartArea* areas) {
    for (std::size_t first = 0; first < TetSetup::most_parts; first += Double::lanes)
        TetVectors(view, lanes, first).set_up(parts, lit != nullptr);
    write_records(lanes, parts, count, records);
    if (lit != nullptr) write_gradients(lanes, count, lit);
    write_group<0>(lanes.pixels, count, areas);
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(set_up_vectors);

namespace {

std::array<std::size_t, 4> sorted_corners(const Tet& tet) {
    std::array<std::size_t, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = static_cast<std::size_t>(tet[i]);
    const auto sort = [&](std::size_t i, std::size_t j) {
        const std::size_t low = std::min(corners[i], corners[j]);
        corners[j] = std::max(corners[i], corners[j]);
        corners[i] = low;
    };
    sort(0, 1);
    sort(2, 3);
    sort(0, 2);
    sort(1, 3);
    sort(1, 2);
    return corners;
}

}  // namespace

// The order of a view does not follow the mesh's, so the corners of the next tets, and the tets
// after these, are prefetched while this one's are in use. It is inlined because GCC 12 drops calls
// of a function that only prefetches, in which it sees no effect.
void TetSetup::prefetch(std::span<const TetPart> next) const {
    for (std::size_t i = 0; i < std::min(next.size(), most_parts); ++i) {
        for (const std::int32_t corner : tets_[static_cast<std::size_t>(next[i].tet)]) {
            __builtin_prefetch(&points_[static_cast<std::size_t>(corner)]);
            __builtin_prefetch(&scalar_[static_cast<std::size_t>(corner)]);
        }
    }
    for (std::size_t i = most_parts; i < std::min(next.size(), 2 * most_parts); ++i)
        __builtin_prefetch(&tets_[static_cast<std::size_t>(next[i].tet)]);
}

void TetSetup::set_up(std::span<const TetPart> parts, std::span<const TetPart> next,
                      SilhouetteRecord* records, GradientRecord* lit, Parts& result) const {
    Lanes lanes;
    prefetch(next);
    load(parts, lanes);
    if (lit != nullptr) load_gradients(parts, lanes);
    const bool pieces = parts[0].piece != TetPart::whole;
    const SetupView view{window_.view(), near_depth_, margin_, range_};
    LAMINA_DISPATCH(set_up_vectors)
    (view, pieces, lanes, parts.size(), records, lit, result.areas.data());
    store(parts, lanes, records, result);
}

void TetSetup::load_gradients(std::span<const TetPart> parts, Lanes& lanes) const {
    for (std::size_t lane = 0; lane < most_parts; ++lane) {
        const TetPart& part = parts[std::min(lane, parts.size() - 1)];
        const auto corners = sorted_corners(tets_[static_cast<std::size_t>(part.tet)]);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::vec3& gradient = gradients_[corners[i]];
            for (int axis = 0; axis < 3; ++axis)
                lanes.gradient[static_cast<std::size_t>(axis)][i][lane] =
                    static_cast<double>(gradient[axis]);
        }
    }
}

// Lanes without a cell fragment repeat the last one.
void TetSetup::load(std::span<const TetPart> parts, Lanes& lanes) const {
    for (std::size_t lane = 0; lane < most_parts; ++lane) {
        const TetPart& part = parts[std::min(lane, parts.size() - 1)];
        const auto corners = sorted_corners(tets_[static_cast<std::size_t>(part.tet)]);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3& point = points_[corners[i]];
            lanes.x[i][lane] = point.x;
            lanes.y[i][lane] = point.y;
            lanes.z[i][lane] = point.z;
            lanes.value[i][lane] = scalar_[corners[i]];
        }
        lanes.limits[3][lane] = std::bit_cast<float>(part_number(part, tets_.size()));
        if (part.piece == TetPart::whole) continue;
        const LinearPiece& piece = pieces_.pieces()[static_cast<std::size_t>(part.piece)];
        lanes.piece_from[lane] = piece.from;
        lanes.piece_to[lane] = piece.to;
        for (int channel = 0; channel < 3; ++channel) {
            lanes.at_from[static_cast<std::size_t>(channel)][lane] = piece.at_from.color[channel];
            lanes.at_to[static_cast<std::size_t>(channel)][lane] = piece.at_to.color[channel];
        }
        lanes.at_from[3][lane] = piece.at_from.extinction;
        lanes.at_to[3][lane] = piece.at_to.extinction;
    }
}

void TetSetup::store(std::span<const TetPart> parts, const Lanes& lanes,
                     const SilhouetteRecord* records, Parts& result) const {
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
        Outcome& outcome = result.outcomes[lane];
        outcome = lanes.good[lane] == 0      ? Outcome::doubtful
                  : lanes.visible[lane] == 0 ? Outcome::invisible
                                             : Outcome::done;
        if (outcome != Outcome::done) continue;
        const bool whole = parts[lane].piece == TetPart::whole;
        const double depth = whole ? INFINITY : lanes.largest_depth[lane];
        PartArea& area = result.areas[lane];
        area.careful = false;
        area.depth = depth <= faint_depth  ? PartDepth::faint
                     : depth <= thin_depth ? PartDepth::thin
                                           : PartDepth::any;
        area.bounded = lanes.bounded[lane] != 0;
        area.farthest = static_cast<float>(lanes.farthest[lane]);
        area.outline = outline_of(records[lane], area, window_.view().height);
    }
}

}  // namespace lamina
#endif
