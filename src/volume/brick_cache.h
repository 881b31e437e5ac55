// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/memory.h"
#include "volume/sample_source.h"

namespace lamina {

// A cache of a volume's samples in bricks of edge^3 cells, which drops the least recently used
// bricks. A brick has one more sample along each axis than cells, so that each cell lies in one
// brick; beyond the volume's last sample, that sample is repeated. Safe from any thread: a thread
// that holds bricks locks one of several mutexes (stripes), and eviction locks all of them.
class BrickCache {
  public:
    static constexpr std::int64_t edge = 32, shift = 5;
    static constexpr std::int64_t samples = edge + 1;  // of a brick along each axis
    static constexpr std::int64_t row = samples, slice = samples * samples;
    static constexpr std::int64_t sample_count = samples * samples * samples;

    // A brick that is to be read, and the memory for its samples.
    struct Wanted {
        std::uint32_t brick;
        std::byte* to;
    };
    // A function that reads bricks, which are in ascending order; some may lie beside each other
    // along x. Several threads may call it at once. It may throw.
    using Fill = std::function<void(std::span<const Wanted>)>;

    // `size`: samples of the volume along each axis.
    BrickCache(const std::array<std::int64_t, 3>& size, std::size_t brick_bytes, Fill fill);

    const std::array<std::int64_t, 3>& count() const { return count_; }
    std::uint32_t brick_count() const { return static_cast<std::uint32_t>(slots_.size()); }
    std::uint32_t number(std::int64_t x, std::int64_t y, std::int64_t z) const {  // of a brick
        return static_cast<std::uint32_t>((z * count_[1] + y) * count_[0] + x);
    }

    // Sets how many bytes bricks may take, but no less than fewest_bytes(). Drops no bricks.
    void set_capacity(std::uint64_t bytes);
    std::uint64_t capacity() const;
    static constexpr std::size_t most_held = 64;  // bricks in one call of hold()
    std::uint64_t fewest_bytes() const;
    std::uint64_t resident_bytes() const;
    bool fits(std::size_t bricks) const { return bricks * brick_bytes_ <= capacity(); }

    // While a hold lives, its bricks stay in memory.
    using Hold = std::unique_lock<std::mutex>;
    // Reads the bricks number_of(i), i = 0 .. count - 1, if they are not in memory, and holds them.
    // At most most_held of them may differ, and a thread may have one hold at a time.
    template <typename NumberOf>
    Hold hold(std::size_t count, const NumberOf& number_of) const {
        std::array<std::uint32_t, most_held> missing;
        while (true) {
            Hold held(stripe());
            std::size_t lacking = 0;
            std::uint32_t before = no_brick;
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t brick = number_of(i);
                if (brick == before) continue;
                before = brick;
                if (slots_[brick].load(std::memory_order_acquire) == no_slot) {
                    if (lacking < most_held) missing[lacking++] = brick;
                } else {
                    used_[brick].store(clock_.load(std::memory_order_relaxed),
                                       std::memory_order_relaxed);
                }
            }
            if (lacking == 0) return held;
            held.unlock();
            load(std::span(missing).first(lacking));
        }
    }
    // Returns the samples of a brick, which must be held.
    const std::byte* at(std::uint32_t brick) const {
        return memory_.data() +
               std::size_t{slots_[brick].load(std::memory_order_relaxed)} * brick_bytes_;
    }

    void clear();  // forgets all bricks, and gives their memory back; nobody may hold any
    // Tells the cache which bricks, ascending, will be used. Only these are then read as neighbours
    // along x of a missing brick (they lie near it in files); without this call, all are.
    void expect(std::span<const std::uint32_t> bricks);
    // Returns the bricks that are not in memory, ascending.
    std::vector<std::uint32_t> missing(std::span<const std::uint32_t> bricks) const;
    // Reads the bricks that are not in memory, on all cores. All must fit in memory (fits()).
    void load_ahead(std::span<const std::uint32_t> bricks) const;
    std::int64_t bricks_read() const { return bricks_read_.load(); }

  private:
    static constexpr std::uint32_t no_slot = ~std::uint32_t{0}, no_brick = ~std::uint32_t{0};

    struct alignas(64) Stripe {
        std::mutex mutex;
    };

    std::mutex& stripe() const;
    void load(std::span<const std::uint32_t> bricks) const;
    std::vector<std::uint32_t> with_neighbours(std::span<const std::uint32_t> bricks) const;
    std::vector<Wanted> claim(std::span<const std::uint32_t> bricks) const;
    void publish(std::span<const Wanted> bricks, bool filled) const;
    std::uint32_t take_slot(std::unique_lock<std::mutex>& lock) const;
    void evict() const;
    std::uint32_t slot_of(const std::byte* at) const;

    std::array<std::int64_t, 3> count_{};
    std::size_t brick_bytes_;
    Fill fill_;
    mutable std::vector<std::atomic<std::uint32_t>> slots_;  // slot of each brick
    mutable std::vector<std::atomic<std::uint32_t>> used_;   // clock_ at the last use of each brick
    mutable std::atomic<std::uint32_t> clock_{0};            // counts calls of fill_
    mutable std::atomic<std::int64_t> bricks_read_{0};
    std::vector<std::uint8_t> expected_;  // 1: the brick is expected; empty: all are
    mutable std::array<Stripe, 32> stripes_;

    mutable std::mutex access_;  // guards all members below
    mutable std::condition_variable changed_;
    mutable ReservedMemory memory_;
    std::uint32_t capacity_ = 0;                     // in slots
    mutable std::vector<std::uint32_t> owners_;      // brick in each slot that was ever used
    mutable std::vector<std::uint32_t> free_;        // slots
    mutable std::vector<std::uint32_t> being_read_;  // bricks
};

// The places of bricks in a volume.
struct BrickPlaces {
    std::array<std::int64_t, 3> size;    // samples of the volume
    std::array<std::int64_t, 3> count;   // bricks along each axis
    std::array<std::int64_t, 3> origin;  // the volume's sample with which brick 0 begins

    std::array<std::int64_t, 3> first_sample(std::uint32_t brick) const {
        const std::int64_t number = brick;
        return {origin[0] + number % count[0] * BrickCache::edge,
                origin[1] + number / count[0] % count[1] * BrickCache::edge,
                origin[2] + number / (count[0] * count[1]) * BrickCache::edge};
    }

    // Returns the samples of neighbours along x and `margin` more on each side, within the volume.
    SampleBox box_of(std::uint32_t first_brick, std::uint32_t last_brick,
                     std::int64_t margin) const {
        const auto first = first_sample(first_brick), last = first_sample(last_brick);
        SampleBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t last_of_all = size[axis] - 1;
            const std::int64_t from =
                std::clamp<std::int64_t>(first[axis] - margin, 0, last_of_all);
            const std::int64_t to =
                std::clamp<std::int64_t>(last[axis] + BrickCache::edge + margin, from, last_of_all);
            box.first[axis] = from;
            box.size[axis] = to - from + 1;
        }
        return box;
    }
};

// Reads the samples (type T) of bricks, with `margin` more samples on each side, in one read for
// neighbours along x. Calls make(brick, its first sample, window of samples) for each brick.
template <typename T, typename Make>
void read_adjacent_bricks(const SampleSource& source, const BrickPlaces& places,
                          std::span<const BrickCache::Wanted> wanted, std::int64_t margin,
                          const Make& make) {
    const auto together = [&](std::uint32_t a, std::uint32_t b) {
        return a / places.count[0] == b / places.count[0];
    };
    for (std::size_t begin = 0, end = 0; begin < wanted.size(); begin = end) {
        for (end = begin + 1; end < wanted.size() &&
                              wanted[end].brick == wanted[end - 1].brick + 1 &&
                              together(wanted[end].brick, wanted[begin].brick);)
            ++end;
        SampleWindow<T> window;
        window.box = places.box_of(wanted[begin].brick, wanted[end - 1].brick, margin);
        const auto samples =
            std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(window.box.count()));
        source.read(window.box, samples.get());
        window.samples = samples.get();
        for (std::size_t i = begin; i < end; ++i)
            make(wanted[i], places.first_sample(wanted[i].brick), window);
    }
}

}  // namespace lamina
