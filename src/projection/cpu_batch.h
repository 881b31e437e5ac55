// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>

#include "projection/fan_geometry.h"

namespace lamina {

// Calls visit(first + i) for each bit i of a word that is set.
template <typename Visit>
void for_each_member(std::size_t first, std::uint64_t word, const Visit& visit) {
    for (std::uint64_t left = word; left != 0; left &= left - 1)
        visit(first + static_cast<std::size_t>(std::countr_zero(left)));
}

// A batch of projected cell fragments (CellFragment) in visibility order, and for each tile of the
// picture the set of those that it draws. Each thread fills a chunk of its own.
class TileBatch {
  public:
    // The cell fragments (or triangles) of chunk i have numbers from i * chunk_size on.
    static constexpr std::size_t chunk_size = 512, most_chunks = 12;

    // `triangles`: it holds TriangleRecords, not SilhouetteRecords. `lit`: it has GradientRecords.
    TileBatch(std::size_t chunks, int tiles, bool triangles, bool lit)
        : records_(triangles ? 0 : chunks * chunk_size),
          gradients_(lit ? chunks * chunk_size : 0),
          triangles_(triangles ? chunks * chunk_size : 0),
          areas_(chunks * chunk_size),
          sets_(static_cast<std::size_t>(tiles) * chunks) {
        chunks_.reserve(chunks);
        for (std::size_t i = 0; i < chunks; ++i)
            chunks_.emplace_back(*this, i, static_cast<std::size_t>(tiles));
    }
    TileBatch(const TileBatch&) = delete;
    TileBatch& operator=(const TileBatch&) = delete;

  private:
    // A set of numbers below chunk_size. It fills a cache line of its own, because threads write
    // the sets that one tile has in different chunks at the same time.
    struct alignas(64) Set {
        std::array<std::uint64_t, chunk_size / 64> words{};

        void add(std::size_t number) { words[number / 64] |= std::uint64_t{1} << number % 64; }
        bool has(std::size_t number) const { return (words[number / 64] >> number % 64 & 1) != 0; }
    };

  public:
    // One chunk: it is filled by one thread, and then read by all.
    class alignas(64) Chunk {
      public:
        Chunk(TileBatch& batch, std::size_t number, std::size_t tiles)
            : batch_(&batch), number_(number), tiles_((tiles + chunk_size - 1) / chunk_size) {}

        void clear() {
            for (std::size_t i = 0; i < tiles_.size(); ++i) {
                for (std::size_t word = 0; word < tiles_[i].words.size(); ++word) {
                    for_each_member(chunk_size * i + 64 * word, tiles_[i].words[word],
                                    [&](std::size_t tile) { set_of(tile) = {}; });
                }
                tiles_[i] = {};
            }
            count_ = 0;
            tets_ = 0;
            first_tet_ = last_tet_ = -1;
        }
        // Returns the record for the next cell fragment; it is overwritten until add() keeps it.
        SilhouetteRecord& next() { return batch_->records_[end()]; }
        GradientRecord* next_gradient() {
            return batch_->is_lit() ? &batch_->gradients_[end()] : nullptr;
        }
        TriangleRecord& next_triangle() { return batch_->triangles_[end()]; }
        void add(const CoveredArea& area, std::int32_t tet) {
            batch_->areas_[end()] = area;
            ++count_;
            if (tet != last_tet_) ++tets_;
            if (count_ == 1) first_tet_ = tet;
            last_tet_ = tet;
        }
        // Makes the tile draw the cell fragment that was added last.
        void touch(std::size_t tile) {
            tiles_[tile / chunk_size].add(tile % chunk_size);
            set_of(tile).add(count_ - 1);
        }

        bool empty() const { return count_ == 0; }
        std::int64_t tets() const { return tets_; }  // tets of its cell fragments
        std::int32_t first_tet() const { return first_tet_; }
        std::int32_t last_tet() const { return last_tet_; }
        bool is_drawn_by(std::size_t tile) const {
            return tiles_[tile / chunk_size].has(tile % chunk_size);
        }
        std::size_t byte_count() const { return sizeof(*this) + tiles_.size() * sizeof(Set); }

      private:
        std::size_t end() const { return number_ * chunk_size + count_; }
        Set& set_of(std::size_t tile) {
            return batch_->sets_[tile * batch_->chunks_.size() + number_];
        }

        TileBatch* batch_;
        std::size_t number_, count_ = 0;
        std::int64_t tets_ = 0;
        std::int32_t first_tet_ = -1, last_tet_ = -1;
        std::vector<Set> tiles_;  // tiles that draw the chunk; each set has chunk_size tiles
    };

    std::size_t chunk_count() const { return chunks_.size(); }
    Chunk& chunk(std::size_t number) { return chunks_[number]; }
    const Chunk& chunk(std::size_t number) const { return chunks_[number]; }

    bool has_triangles() const { return !triangles_.empty(); }
    bool is_lit() const { return !gradients_.empty(); }
    const SilhouetteRecord& record(std::size_t number) const { return records_[number]; }
    const GradientRecord& gradient(std::size_t number) const { return gradients_[number]; }
    const TriangleRecord& triangle(std::size_t number) const { return triangles_[number]; }
    const CoveredArea& area(std::size_t number) const { return areas_[number]; }

    // Calls visit(first, word) for the cell fragments that a tile draws, in visibility order: bit i
    // of `word` is set if the tile draws number first + i.
    template <typename Visit>
    void for_each_word(std::size_t tile, const Visit& visit) const {
        for (std::size_t i = 0; i < chunks_.size(); ++i) {
            if (!chunks_[i].is_drawn_by(tile)) continue;
            const auto& words = sets_[tile * chunks_.size() + i].words;
            for (std::size_t word = 0; word < words.size(); ++word) {
                if (words[word] != 0) visit(i * chunk_size + 64 * word, words[word]);
            }
        }
    }
    bool is_drawn_by(std::size_t tile) const {
        return std::ranges::any_of(chunks_,
                                   [&](const Chunk& chunk) { return chunk.is_drawn_by(tile); });
    }
    std::int64_t byte_count() const {
        std::size_t bytes = sizeof(*this) + records_.size() * sizeof(SilhouetteRecord) +
                            gradients_.size() * sizeof(GradientRecord) +
                            triangles_.size() * sizeof(TriangleRecord) +
                            areas_.size() * sizeof(CoveredArea) + sets_.size() * sizeof(Set);
        for (const Chunk& chunk : chunks_) bytes += chunk.byte_count();
        return static_cast<std::int64_t>(bytes);
    }

  private:
    std::vector<SilhouetteRecord> records_;
    std::vector<GradientRecord> gradients_;  // one for each record; empty if nothing is lit
    std::vector<TriangleRecord> triangles_;
    std::vector<CoveredArea> areas_;
    std::vector<Set> sets_;  // sets of all chunks for tile 0, then for tile 1, ...
    std::vector<Chunk> chunks_;
};

}  // namespace lamina
