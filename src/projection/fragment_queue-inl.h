// SPDX-License-Identifier: Apache-2.0
// A queue of fragments of cell fragments over a tile, between the steps that find, colour and draw
// them.
#if defined(LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_
#undef LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_
#else
#define LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "projection/tet_run-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, TileGrid::block * TileGrid::block>;
using Vector = hn::Vec<Tag>;
using Inside = hn::Mask<Tag>;

// Fragments are added as vectors of 4 x 1, 4 x 2 or 4 x 4 pixels. A cell fragment covers about half
// of the pixels of a vector. AVX-512 packs the covered pixels of one cell fragment, so that few
// colours are computed in vain. Each step is done for all fragments of the queue before the next
// step, because vectors within a step do not depend on each other.
class FragmentQueue {
  public:
    static constexpr std::size_t lanes = hn::MaxLanes(Tag());

    // The result of the first step.
    struct Found {
        InsideSpan<Vector> span;
        // The scalar's change from the record's center, at z = 1, and world length per unit of z.
        // Of lit fragments: columns and rows from the center.
        Vector aside, slant;
    };
    // A vector of pixels, and the position of its fragments in the queue.
    struct Place {
        std::uint16_t place;  // TileGrid::place() of the first pixel
        std::uint16_t part;   // number of the cell fragment in its TileChunk
        std::uint16_t first;
        std::uint8_t inside[8];
    };

    bool is_full() const { return end_ >= enough; }  // another cell fragment may not fit
    void clear() { end_ = place_count_ = 0; }

    // Adds the vectors of one cell fragment.
    class Writer {
      public:
        Writer(FragmentQueue& queue, std::size_t part)
            : queue_(queue),
              part_(static_cast<std::uint16_t>(part)),
              end_(queue.end_),
              place_count_(queue.place_count_) {}

        // Keeps the vector where one of its pixels is `inside`. It does so without a branch, which
        // could not be predicted.
        HWY_INLINE void add(Tag d, std::size_t place, const Found& found, Inside inside) {
            store(d, 0, pack(inside, found.span.enter));
            store(d, 1, pack(inside, found.span.leave));
            store(d, 2, pack(inside, found.aside));
            store(d, 3, pack(inside, found.slant));
            Place& pixels = queue_.places_[place_count_];
            pixels.place = static_cast<std::uint16_t>(place);
            pixels.part = part_;
            pixels.first = static_cast<std::uint16_t>(end_);
            hn::StoreMaskBits(d, inside, pixels.inside);
            const std::size_t count = hn::CountTrue(d, inside);
            count_ += count;
            place_count_ += count > 0 ? 1 : 0;
            end_ += packs ? count : count > 0 ? lanes : 0;
        }
        // Returns the number of fragments.
        HWY_INLINE std::size_t finish(Tag d) {
            if constexpr (packs) {
                for (std::size_t i = 0; i < values; ++i) store(d, i, hn::Zero(d));
                end_ = (end_ + lanes - 1) / lanes * lanes;
            }
            // A single store is mostly enough. The number that is needed could not be predicted.
            std::uint16_t* const parts = queue_.parts_ + queue_.end_ / lanes;
            const std::size_t vectors = (end_ - queue_.end_) / lanes;
            std::fill_n(parts, some_parts, part_);
            if (vectors > some_parts) std::fill_n(parts + some_parts, vectors - some_parts, part_);
            queue_.end_ = end_;
            queue_.place_count_ = place_count_;
            return count_;
        }

      private:
        HWY_INLINE void store(Tag d, std::size_t value, Vector v) {
            hn::StoreU(v, d, queue_.values_[value] + end_);
        }

        FragmentQueue& queue_;
        std::uint16_t part_;
        std::size_t end_, place_count_, count_ = 0;
    };

    // Calls visit(part, i) for each vector of fragments; `i` is the number of its first fragment.
    template <class Visit>
    HWY_INLINE void for_each_vector(const Visit& visit) const {
        for (std::size_t i = 0; i < end_; i += lanes) visit(std::size_t{parts_[i / lanes]}, i);
    }
    std::span<const Place> places() const { return {places_, place_count_}; }

    HWY_INLINE Found found(Tag d, std::size_t i) const {
        return {{load(d, 0, i), load(d, 1, i)}, load(d, 2, i), load(d, 3, i)};
    }
    // A run overwrites the result of the first step, and a colour overwrites a run.
    HWY_INLINE void set_run(Tag d, std::size_t i, const TetRun<Vector>& run) {
        store(d, 0, i, run.front);
        store(d, 1, i, run.back);
        store(d, 2, i, run.world_length);
    }
    HWY_INLINE TetRun<Vector> run(Tag d, std::size_t i) const {
        return {load(d, 0, i), load(d, 1, i), load(d, 2, i)};
    }
    HWY_INLINE void set_color(Tag d, std::size_t i, const Fragment<Vector>& color) {
        store(d, 0, i, color.red);
        store(d, 1, i, color.green);
        store(d, 2, i, color.blue);
        store(d, 3, i, color.alpha);
    }
    // The colours of a vector of pixels; 0 for pixels that are not covered.
    HWY_INLINE Fragment<Vector> color(Tag d, const Place& pixels) const {
        const Inside inside = hn::LoadMaskBits(d, pixels.inside);
        const auto channel = [&](std::size_t value) HWY_ATTR {
            return unpack(d, inside, values_[value] + pixels.first);
        };
        return {channel(0), channel(1), channel(2), channel(3)};
    }

  private:
    static constexpr bool packs = HWY_TARGET <= HWY_AVX3;
    static constexpr std::size_t values = 4, enough = 256, most = enough + TileGrid::pixels + lanes,
                                 some_parts = 16;

    static HWY_INLINE Vector pack(Inside inside, Vector v) {
        if constexpr (packs) {
            return hn::Compress(v, inside);
        } else {
            return hn::IfThenElseZero(inside, v);
        }
    }
    static HWY_INLINE Vector unpack(Tag d, Inside inside, const float* from) {
#if HWY_TARGET <= HWY_AVX3
        static_cast<void>(d);
        return Vector{_mm512_maskz_expandloadu_ps(inside.raw, from)};
#else
        static_cast<void>(inside);
        return hn::Load(d, from);
#endif
    }
    HWY_INLINE void store(Tag d, std::size_t value, std::size_t i, Vector v) {
        hn::Store(v, d, values_[value] + i);
    }
    HWY_INLINE Vector load(Tag d, std::size_t value, std::size_t i) const {
        return hn::Load(d, values_[value] + i);
    }

    std::size_t end_ = 0, place_count_ = 0;
    std::uint16_t parts_[most / lanes + some_parts];  // of vectors
    Place places_[enough + TileGrid::pixels / lanes + 1];
    HWY_ALIGN float values_[values][most];
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
