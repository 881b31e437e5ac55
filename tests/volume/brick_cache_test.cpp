// SPDX-License-Identifier: Apache-2.0
#include "volume/brick_cache.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>
#include <vector>

#include "support/expect_error.h"
#include "support/stored_volume.h"
#include "support/volume_of.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

constexpr std::array<std::int64_t, 3> cached_size{300, 130, 70};

double number_at(double x, double y, double z) {
    return static_cast<double>(static_cast<int>(x + 300 * y + 7 * z) % 65536);
}

Volume numbers() {
    return test::volume_of<std::uint16_t>(test::grid_of(cached_size, Centering::node), number_at);
}

// Returns a cache whose bricks are filled with their own numbers; counts the filled bricks.
BrickCache numbered(std::atomic<int>& filled) {
    return BrickCache(cached_size, 4096, [&](std::span<const BrickCache::Wanted> wanted) {
        for (const BrickCache::Wanted& each : wanted) {
            std::fill_n(reinterpret_cast<std::uint32_t*>(each.to), 1024, each.brick);
            ++filled;
        }
    });
}

TEST(BrickCache, BricksHaveTheSamplesOfTheVolume) {
    const Volume volume = test::stored(numbers());
    const auto samples = SamplesInFiles<std::uint16_t>(volume.store());
    std::mt19937 random(1);
    for (int i = 0; i < 20000; ++i) {
        const std::int64_t x = random() % 300, y = random() % 130, z = random() % 70;
        EXPECT_EQ(
            samples[(z * 130 + y) * 300 + x],
            number_at(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)));
    }
}

TEST(BrickCache, RepeatsTheBorder) {
    const Volume volume = test::stored(numbers());
    const BrickCache& bricks = volume.store().bricks();
    const std::uint32_t last = bricks.brick_count() - 1;
    const auto held = bricks.hold(1, [&](std::size_t) { return last; });
    const auto* const samples = reinterpret_cast<const std::uint16_t*>(bricks.at(last));
    EXPECT_EQ(samples[BrickCache::sample_count - 1], number_at(299, 129, 69));
}

// Four threads hold more bricks in turn than fit in memory.
TEST(BrickCache, KeepsWhatIsHeldAndForgetsTheRest) {
    std::atomic<int> filled{0};
    BrickCache cache = numbered(filled);
    cache.set_capacity(0);
    ASSERT_LT(cache.capacity(), std::uint64_t{cache.brick_count()} * 4096 * 100);
    std::vector<std::thread> threads;
    std::atomic<int> wrong{0};
    for (unsigned seed = 0; seed < 4; ++seed) {
        threads.emplace_back([&, seed] {
            std::mt19937 random(seed);
            for (int round = 0; round < 500; ++round) {
                std::array<std::uint32_t, 20> wanted;
                for (std::uint32_t& brick : wanted)
                    brick = static_cast<std::uint32_t>(random()) % cache.brick_count();
                const auto held = cache.hold(20, [&](std::size_t i) { return wanted[i]; });
                for (const std::uint32_t brick : wanted) {
                    const auto* const at = reinterpret_cast<const std::uint32_t*>(cache.at(brick));
                    wrong += at[0] != brick || at[1023] != brick;
                }
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(cache.resident_bytes(), cache.capacity());
}

TEST(BrickCache, ReadsNothingTwiceWhereAllFits) {
    std::atomic<int> filled{0};
    BrickCache cache = numbered(filled);
    cache.set_capacity(std::uint64_t{1} << 40);
    std::vector<std::uint32_t> all(cache.brick_count());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    EXPECT_TRUE(cache.fits(all.size()));
    for (int round = 0; round < 3; ++round) cache.load_ahead(all);
    for (const std::uint32_t brick : all) cache.hold(1, [&](std::size_t) { return brick; });
    EXPECT_EQ(filled, static_cast<int>(all.size()));
}

TEST(BrickCache, ForgetsWhatWasUsedLongestAgo) {
    std::atomic<int> filled{0};
    BrickCache cache({32 * 4000 + 1, 2, 2}, 4096, [&](std::span<const BrickCache::Wanted> wanted) {
        filled += static_cast<int>(wanted.size());
    });
    cache.set_capacity(0);
    const auto slots = static_cast<std::uint32_t>(cache.capacity() / 4096);
    const auto use = [&](std::uint32_t brick) {
        cache.hold(1, [&](std::size_t) { return brick; });
    };
    for (std::uint32_t brick = 0; brick < 3 * slots; ++brick) {
        use(0);  // keeps brick 0 in use
        use(brick);
    }
    EXPECT_EQ(filled, static_cast<int>(3 * slots));
}

TEST(BrickCache, ReadsExpectedNeighborsTogether) {
    std::vector<std::size_t> calls;
    BrickCache cache({32 * 4000 + 1, 2, 2}, 4096, [&](std::span<const BrickCache::Wanted> wanted) {
        calls.push_back(wanted.size());
    });
    cache.set_capacity(std::uint64_t{1} << 40);
    const std::vector<std::uint32_t> expected{8, 9, 11, 15, 16};
    cache.expect(expected);
    cache.hold(1, [](std::size_t) { return 9u; });  // reads 8, 11 and 15, too
    cache.hold(1, [](std::size_t) { return 12u; });
    EXPECT_EQ(calls, (std::vector<std::size_t>{4, 1}));
}

TEST(BrickCache, PassesAnErrorOnAndTriesAgain) {
    bool fails = true;
    BrickCache cache(cached_size, 4096, [&](std::span<const BrickCache::Wanted>) {
        if (fails) fail("volume.raw: truncated");
    });
    constexpr std::uint32_t used = 3;
    cache.expect({&used, 1});  // no neighbour is expected
    const auto use = [&] { cache.hold(1, [](std::size_t) { return used; }); };
    expect_error([&] { use(); }, {"truncated"});
    fails = false;
    use();
    cache.clear();
    EXPECT_EQ(cache.resident_bytes(), 0u);
    use();
    EXPECT_EQ(cache.bricks_read(), 2);
}

}  // namespace
}  // namespace lamina
