// SPDX-License-Identifier: Apache-2.0
// A queue of fragments of cell fragments over a tile, between the steps that find, colour and draw
// them.
#if defined(LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_
#undef LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_
#else
#define LAMINA_PROJECTION_FRAGMENT_QUEUE_INL_H_
#endif

#include <algorithm>

#include "projection/tet_run-inl.h"
#include "simd/members-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// Fragments are added as vectors of 4 x 1, 4 x 2 or 4 x 4 pixels. A cell fragment covers about half
// of the pixels of a vector. AVX-512 packs the covered pixels of one cell fragment, so that few
// colours are computed in vain. Each step is done for all fragments of the queue before the next
// step, because vectors within a step do not depend on each other.
class FragmentQueue {
  public:
    static constexpr std::size_t lanes = Float::lanes;

    // A vector of pixels, by the TileGrid::place() of the first one, and the number in the
    // TileBatch of the cell fragment that covers some of them.
    struct Place {
        std::uint16_t place, part;
    };

    bool is_full() const { return end_ >= enough; }  // another cell fragment may not fit
    void clear() { end_ = place_count_ = 0; }

    // Adds the vectors of one cell fragment.
    class Writer {
      public:
        LAMINA_INLINE Writer(FragmentQueue& queue, std::size_t part)
            : queue_(queue),
              part_(static_cast<std::uint16_t>(part)),
              to_(queue.values_ + position(0, queue.end_)),
              place_(queue.places_ + queue.place_count_) {}

        LAMINA_INLINE void add(std::size_t place, const SlantedRay& found, FloatMask inside) {
            add(place, found.span, found.aside, found.slant, inside);
        }
        LAMINA_INLINE void add(std::size_t place, const PlacedRay& found, FloatMask inside) {
            add(place, found.span, found.column, found.row, inside);
        }
        // Ends the vectors, and returns the number of fragments.
        LAMINA_INLINE std::size_t finish() {
            if constexpr (packs) {
                for (std::size_t i = 0; i < values; ++i) put(i, 0);
            }
            const auto written = static_cast<std::size_t>(to_ - queue_.values_);
            const std::size_t end =
                packs ? (written + lanes - 1) / lanes * lanes : written / values;
            // A single store is mostly enough. A branch on the number that is needed could not be
            // predicted.
            std::uint16_t* const parts = queue_.parts_ + queue_.end_ / lanes;
            const std::size_t vectors = (end - queue_.end_) / lanes;
            std::fill_n(parts, some_parts, part_);
            if (vectors > some_parts) std::fill_n(parts + some_parts, vectors - some_parts, part_);
            queue_.end_ = end;
            queue_.place_count_ = static_cast<std::size_t>(place_ - queue_.places_);
            return count_;
        }

      private:
        // Keeps the vector if one of its pixels is `inside`. It does so without a branch, which
        // could not be predicted. The span of pixels that are not inside becomes 0, so that the
        // other two numbers, which keep their values, make no difference there.
        LAMINA_INLINE void add(std::size_t place, const InsideSpan<Float>& span, Float third,
                               Float fourth, FloatMask inside) {
            const std::size_t count = count_of(inside), some = count > 0 ? 1 : 0;
            *place_ = {static_cast<std::uint16_t>(place), part_};
            if constexpr (packs) {
                put(0, members_first(span.enter, inside));
                put(1, members_first(span.leave, inside));
                put(2, members_first(third, inside));
                put(3, members_first(fourth, inside));
                Packed& packed = queue_.packed_[place_ - queue_.places_];
                packed.first = static_cast<std::uint16_t>(to_ - queue_.values_);
                packed.inside = static_cast<std::uint16_t>(bits_of(inside));
                to_ += count;
            } else {
                put(0, zero_unless(inside, span.enter));
                put(1, zero_unless(inside, span.leave));
                put(2, third);
                put(3, fourth);
                to_ += some * (values * lanes);
            }
            place_ += some;
            count_ += count;
        }
        LAMINA_INLINE void put(std::size_t value, Float v) {
            store_unaligned(v, to_ + position(value, 0));
        }

        FragmentQueue& queue_;
        std::uint16_t part_;
        float* to_;
        Place* place_;
        std::size_t count_ = 0;
    };

    // Calls visit(part, i) for each vector of fragments; `i` is the number of its first fragment.
    template <class Visit>
    LAMINA_INLINE void for_each_vector(const Visit& visit) const {
        for (std::size_t i = 0; i < end_; i += lanes) visit(std::size_t{parts_[i / lanes]}, i);
    }
    // Calls visit(Place, color) for each vector of pixels. The colour of a pixel that is not
    // covered is 0.
    template <class Visit>
    LAMINA_INLINE void for_each_place(const Visit& visit) const {
        for (std::size_t i = 0; i < place_count_; ++i) {
            const auto channel = [&](std::size_t value) LAMINA_LAMBDA { return pixels(value, i); };
            visit(places_[i], Fragment{channel(0), channel(1), channel(2), channel(3)});
        }
    }

    // A fragment has four numbers at a time: those of the first step, then those of a segment
    // unless it is lit, then those of a colour.
    LAMINA_INLINE SlantedRay slanted(std::size_t i) const {
        return {{value(0, i), value(1, i)}, value(2, i), value(3, i)};
    }
    LAMINA_INLINE PlacedRay placed(std::size_t i) const {
        return {{value(0, i), value(1, i)}, value(2, i), value(3, i)};
    }
    LAMINA_INLINE void set_run(std::size_t i, const TetRun& run) {
        put(0, i, run.front);
        put(1, i, run.back);
        put(2, i, run.world_length);
    }
    LAMINA_INLINE TetRun run(std::size_t i) const {
        return {value(0, i), value(1, i), value(2, i)};
    }
    LAMINA_INLINE void set_color(std::size_t i, const Fragment& color) {
        put(0, i, color.red);
        put(1, i, color.green);
        put(2, i, color.blue);
        put(3, i, color.alpha);
    }

  private:
    static_assert(TileBatch::most_chunks * TileBatch::chunk_parts <= 1 << 16,
                  "numbers of cell fragments are kept in 16 bits");
    static constexpr bool packs = packs_quickly;
    static constexpr std::size_t values = 4, enough = 256, most = enough + TileGrid::pixels + lanes,
                                 some_parts = 16;
    // The position of a place's fragments in a queue that packs them.
    struct Packed {
        std::uint16_t first;
        std::uint16_t inside;  // one bit a pixel
    };

    // Packed fragments begin anywhere, so each value has an array of its own. Else the values of a
    // vector follow each other.
    static constexpr std::size_t position(std::size_t value, std::size_t i) {
        return packs ? value * most + i : value * lanes + i * values;
    }
    LAMINA_INLINE Float pixels(std::size_t number, std::size_t place) const {
        if constexpr (!packs) return value(number, place * lanes);
        const Packed& packed = packed_[place];
        return expand_members(packed.inside, values_ + position(number, packed.first));
    }
    LAMINA_INLINE void put(std::size_t number, std::size_t i, Float v) {
        store(v, values_ + position(number, i));
    }
    LAMINA_INLINE Float value(std::size_t number, std::size_t i) const {
        return load<Float>(values_ + position(number, i));
    }

    std::size_t end_ = 0, place_count_ = 0;
    std::uint16_t parts_[most / lanes + some_parts];  // of vectors
    Place places_[enough + TileGrid::pixels / lanes + 1];
    Packed packed_[packs ? enough + TileGrid::pixels / lanes + 1 : 1];
    alignas(64) float values_[values * most];
};

LAMINA_SIMD_END

#endif
