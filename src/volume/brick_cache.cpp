// SPDX-License-Identifier: Apache-2.0
#include "volume/brick_cache.h"

#include <thread>

#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lamina {
namespace {

// Number of bricks that one task of load_ahead() reads.
constexpr std::size_t together = 64;

// Most bricks along x that are read together because one of them is missing.
constexpr std::uint32_t neighbours = 16;

std::int64_t cache_bricks_along(std::int64_t size) {
    return std::max<std::int64_t>(1, (size - 1 + BrickCache::edge - 1) / BrickCache::edge);
}

}  // namespace

BrickCache::BrickCache(const std::array<std::int64_t, 3>& size, std::size_t brick_bytes, Fill fill)
    : brick_bytes_((brick_bytes + 63) / 64 * 64), fill_(std::move(fill)) {
    std::uint64_t bricks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        count_[axis] = cache_bricks_along(size[axis]);
        bricks *= static_cast<std::uint64_t>(count_[axis]);
    }
    if (bricks >= no_brick) fail("volume: found {} bricks, expected fewer than 2^32", bricks);
    slots_ = std::vector<std::atomic<std::uint32_t>>(bricks);
    for (auto& slot : slots_) slot.store(no_slot, std::memory_order_relaxed);
    used_ = std::vector<std::atomic<std::uint32_t>>(bricks);
    // Reserves address space only: bricks take memory when they are read.
    const std::uint64_t most = std::max(memory_limit() + own_memory, fewest_bytes());
    memory_ = ReservedMemory(std::min(bricks * brick_bytes_, most), ReservedMemory::Filling::dense);
    set_capacity(0);
}

// Each thread may hold most_held bricks while as many more are read for it.
std::uint64_t BrickCache::fewest_bytes() const {
    const std::uint64_t threads = std::max(2u, std::thread::hardware_concurrency());
    return std::min<std::uint64_t>(slots_.size(), 2 * most_held * threads) * brick_bytes_;
}

void BrickCache::set_capacity(std::uint64_t bytes) {
    const std::lock_guard lock(access_);
    const std::uint64_t kept = std::clamp<std::uint64_t>(bytes, fewest_bytes(), memory_.size());
    capacity_ = static_cast<std::uint32_t>(kept / brick_bytes_);
}

std::uint64_t BrickCache::capacity() const {
    const std::lock_guard lock(access_);
    return std::uint64_t{capacity_} * brick_bytes_;
}

std::uint64_t BrickCache::resident_bytes() const {
    const std::lock_guard lock(access_);
    return owners_.size() * brick_bytes_;
}

// Returns the mutex that this thread locks while it holds bricks; threads share the stripes.
std::mutex& BrickCache::stripe() const {
    static std::atomic<unsigned> threads{0};
    static thread_local const unsigned thread = threads++;
    return stripes_[thread % stripes_.size()].mutex;
}

std::uint32_t BrickCache::slot_of(const std::byte* at) const {
    return static_cast<std::uint32_t>(static_cast<std::size_t>(at - memory_.data()) / brick_bytes_);
}

void BrickCache::expect(std::span<const std::uint32_t> bricks) {
    expected_.assign(slots_.size(), 0);
    for (const std::uint32_t brick : bricks) expected_[brick] = 1;
}

// Returns the bricks and their expected neighbours, in ascending order, each once. Takes so few
// neighbours that all threads together claim at most half of the slots.
std::vector<std::uint32_t> BrickCache::with_neighbours(
    std::span<const std::uint32_t> bricks) const {
    std::vector<std::uint32_t> all(bricks.begin(), bricks.end());
    const std::uint64_t threads = std::max(2u, std::thread::hardware_concurrency());
    const std::uint64_t room = capacity() / (2 * threads * bricks.size() * brick_bytes_);
    const auto group = static_cast<std::uint32_t>(std::min<std::uint64_t>(neighbours, room));
    const auto columns = static_cast<std::uint32_t>(count_[0]);
    for (const std::uint32_t brick : group > 1 ? bricks : std::span<const std::uint32_t>()) {
        const std::uint32_t x = brick % columns, first = x / group * group;
        for (std::uint32_t other = first; other < std::min(first + group, columns); ++other) {
            const std::uint32_t number = brick - x + other;
            if ((expected_.empty() || expected_[number] != 0) &&
                slots_[number].load(std::memory_order_relaxed) == no_slot)
                all.push_back(number);
        }
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

void BrickCache::load(std::span<const std::uint32_t> bricks) const {
    const std::vector<Wanted> wanted = claim(with_neighbours(bricks));
    if (wanted.empty()) return;
    try {
        fill_(wanted);
    } catch (...) {
        publish(wanted, false);
        throw;
    }
    publish(wanted, true);
}

// Assigns slots to those of the bricks that are neither in memory nor being read. If there are
// none, waits until other threads have read the bricks.
std::vector<BrickCache::Wanted> BrickCache::claim(std::span<const std::uint32_t> bricks) const {
    std::unique_lock lock(access_);
    std::vector<Wanted> wanted;
    for (const std::uint32_t brick : bricks) {
        if (slots_[brick].load(std::memory_order_relaxed) != no_slot) continue;
        if (std::ranges::find(being_read_, brick) != being_read_.end()) continue;
        being_read_.push_back(brick);
        const std::uint32_t slot = take_slot(lock);
        owners_[slot] = brick;
        wanted.push_back({brick, memory_.data() + std::size_t{slot} * brick_bytes_});
    }
    if (!wanted.empty()) return wanted;
    changed_.wait(lock, [&] {
        return std::ranges::none_of(bricks, [&](std::uint32_t brick) {
            return std::ranges::find(being_read_, brick) != being_read_.end();
        });
    });
    return wanted;
}

// Ends the reading of bricks: makes them available if they are `filled`, else frees their slots.
void BrickCache::publish(std::span<const Wanted> bricks, bool filled) const {
    const std::lock_guard lock(access_);
    const std::uint32_t now = clock_.fetch_add(1, std::memory_order_relaxed) + 1;
    for (const Wanted& wanted : bricks) {
        const std::uint32_t slot = slot_of(wanted.to);
        std::erase(being_read_, wanted.brick);
        if (filled) {
            used_[wanted.brick].store(now, std::memory_order_relaxed);
            slots_[wanted.brick].store(slot, std::memory_order_release);
        } else {
            owners_[slot] = no_brick;
            free_.push_back(slot);
        }
    }
    if (filled) bricks_read_ += static_cast<std::int64_t>(bricks.size());
    changed_.notify_all();
}

// Returns a free slot; evicts bricks, or waits, until there is one.
std::uint32_t BrickCache::take_slot(std::unique_lock<std::mutex>& lock) const {
    while (true) {
        if (!free_.empty()) {
            const std::uint32_t slot = free_.back();
            free_.pop_back();
            return slot;
        }
        if (owners_.size() < capacity_) {
            owners_.push_back(no_brick);
            return static_cast<std::uint32_t>(owners_.size() - 1);
        }
        evict();
        if (free_.empty()) changed_.wait(lock);  // all are being read
    }
}

// Frees an eighth of the slots, those whose bricks were used least recently. A thread locks a
// stripe as long as it holds bricks: while all stripes are locked here, no brick is held.
void BrickCache::evict() const {
    struct Slot {
        std::uint32_t number;
        std::uint32_t used;
    };
    std::vector<Slot> resident;
    for (std::uint32_t slot = 0; slot < owners_.size(); ++slot) {
        const std::uint32_t brick = owners_[slot];
        if (brick != no_brick && slots_[brick].load(std::memory_order_relaxed) == slot)
            resident.push_back({slot, used_[brick].load(std::memory_order_relaxed)});
    }
    const std::size_t count = (resident.size() + 7) / 8;
    std::nth_element(resident.begin(), resident.begin() + static_cast<std::ptrdiff_t>(count),
                     resident.end(), [](const Slot& a, const Slot& b) { return a.used < b.used; });
    for (Stripe& each : stripes_) each.mutex.lock();
    for (std::size_t i = 0; i < count; ++i)
        slots_[owners_[resident[i].number]].store(no_slot, std::memory_order_relaxed);
    for (Stripe& each : stripes_) each.mutex.unlock();
    for (std::size_t i = 0; i < count; ++i) {
        owners_[resident[i].number] = no_brick;
        free_.push_back(resident[i].number);
    }
}

void BrickCache::clear() {
    const std::lock_guard lock(access_);
    for (auto& slot : slots_) slot.store(no_slot, std::memory_order_relaxed);
    owners_.clear();
    free_.clear();
    memory_.clear();
}

std::vector<std::uint32_t> BrickCache::missing(std::span<const std::uint32_t> bricks) const {
    std::vector<std::uint32_t> missing;
    for (const std::uint32_t brick : bricks) {
        if (slots_[brick].load(std::memory_order_relaxed) == no_slot) missing.push_back(brick);
    }
    std::ranges::sort(missing);
    return missing;
}

void BrickCache::load_ahead(std::span<const std::uint32_t> bricks) const {
    const std::vector<std::uint32_t> missing = this->missing(bricks);
    if (missing.empty()) return;
    Progress progress("reading bricks", static_cast<std::int64_t>(missing.size()));
    const auto parts = static_cast<std::int64_t>((missing.size() + together - 1) / together);
    parallel_for(parts, 1, [&](std::int64_t part) {
        const std::size_t first = static_cast<std::size_t>(part) * together;
        const std::size_t count = std::min(together, missing.size() - first);
        load(std::span(missing).subspan(first, count));
        progress.advance(static_cast<std::int64_t>(count));
    });
}

}  // namespace lamina
