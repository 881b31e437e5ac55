// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "projection/fragment_kind.h"
#include "projection/gradient_record.h"
#include "projection/part_outline.h"
#include "projection/tet_record.h"
#include "projection/triangle_record.h"

namespace lamina {

// A bound on the optical depth of any run through a cell fragment, on which the cost of its colour
// depends. thin: at most thin_depth; faint: at most faint_depth (optics/front_weights.h).
enum class PartDepth : std::uint8_t { any, thin, faint };

// The pixels that a cell fragment may cover: columns from the left, rows from the top of the
// picture.
struct alignas(64) PartArea : PixelArea {
    bool careful;     // depths on its faces are found in double precision (FragmentKind::careful)
    PartDepth depth;  // bound for any run through it
    // Outside a tet the planes of its faces meet at any depth, and there rounding alone may make
    // runs that can be seen. Where this is true, pixels outside these columns and rows do not
    // count, and no run ends beyond `farthest`, a depth relative to the record's center.
    bool bounded = true;
    float farthest = std::numeric_limits<float>::infinity();
    PartOutline outline = {};
};

// Some projected cell fragments that follow each other in visibility order, and the set of them
// that each tile of the picture draws. Its size does not depend on the view.
class TileChunk {
  public:
    static constexpr std::size_t most_parts = 512;
    // A set of cell fragments, one bit each.
    using Parts = std::array<std::uint64_t, most_parts / 64>;

    // `triangles`: the chunk holds triangles instead of cell fragments. `lit`: these have
    // gradients.
    TileChunk(int tiles, bool triangles, bool lit)
        : records_(triangles ? 0 : most_parts),
          gradients_(lit ? most_parts : 0),
          triangles_(triangles ? most_parts : 0),
          parts_of_tile_(static_cast<std::size_t>(tiles)) {}

    void clear() {
        if (count_ == 0) return;  // no tile has any of it
        count_ = 0;
        tets_ = 0;
        first_tet_ = last_tet_ = -1;
        std::fill(parts_of_tile_.begin(), parts_of_tile_.end(), Parts{});
    }
    // The record that the next cell fragment is written to. It is kept once add() is called.
    TetRecord& next() { return records_[count_]; }
    GradientRecord* next_gradient() { return gradients_.empty() ? nullptr : &gradients_[count_]; }
    TriangleRecord& next_triangle() { return triangles_[count_]; }
    void add(const PartArea& area, std::int32_t tet) {
        areas_[count_++] = area;
        if (tet != last_tet_) ++tets_;
        if (count_ == 1) first_tet_ = tet;
        last_tet_ = tet;
    }
    void touch(std::size_t tile, std::size_t part) {
        parts_of_tile_[tile][part / 64] |= std::uint64_t{1} << part % 64;
    }

    std::size_t count() const { return count_; }
    std::int64_t tets() const { return tets_; }  // number of tets that these belong to
    std::int32_t first_tet() const { return first_tet_; }
    std::int32_t last_tet() const { return last_tet_; }
    bool has_triangles() const { return !triangles_.empty(); }
    const TetRecord& record(std::size_t part) const { return records_[part]; }
    bool is_lit() const { return !gradients_.empty(); }
    const GradientRecord& gradient(std::size_t part) const { return gradients_[part]; }
    const TriangleRecord& triangle(std::size_t part) const { return triangles_[part]; }
    const PartArea& area(std::size_t part) const { return areas_[part]; }
    const Parts& parts(std::size_t tile) const { return parts_of_tile_[tile]; }
    bool has_parts(std::size_t tile) const {
        std::uint64_t any = 0;
        for (const std::uint64_t word : parts_of_tile_[tile]) any |= word;
        return any != 0;
    }
    std::int64_t byte_count() const {
        return static_cast<std::int64_t>(sizeof(*this) + records_.size() * sizeof(TetRecord) +
                                         gradients_.size() * sizeof(GradientRecord) +
                                         triangles_.size() * sizeof(TriangleRecord) +
                                         parts_of_tile_.size() * sizeof(Parts));
    }

  private:
    std::size_t count_ = 0;
    std::int64_t tets_ = 0;
    std::int32_t first_tet_ = -1, last_tet_ = -1;
    std::vector<TetRecord> records_;
    std::vector<GradientRecord> gradients_;  // of the records; empty where nothing is lit
    std::vector<TriangleRecord> triangles_;
    std::array<PartArea, most_parts> areas_;
    std::vector<Parts> parts_of_tile_;
};

// Calls visit(part) for the cell fragments of a set, in order.
template <typename Visit>
void for_each_part(const TileChunk::Parts& parts, const Visit& visit) {
    for (std::size_t word = 0; word < parts.size(); ++word) {
        for (std::uint64_t left = parts[word]; left != 0; left &= left - 1)
            visit(64 * word + static_cast<std::size_t>(std::countr_zero(left)));
    }
}

}  // namespace lamina
