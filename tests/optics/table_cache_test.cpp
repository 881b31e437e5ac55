// SPDX-License-Identifier: Apache-2.0
#include "optics/table_cache.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "base/error.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;

TransferFunction ramp(double extinction) {
    return TransferFunction::linear({knot(0, {1, 0, 0}, 0), knot(1, {0, 0, 1}, extinction)});
}

SegmentTableRequest equal_steps(int nodes) {
    SegmentTableRequest request;
    request.scalar_nodes = nodes;
    request.length_layers = 2;
    return request;
}

PreintegrationRequest aligned(int nodes) {
    PreintegrationRequest request;
    request.scalar_nodes = nodes;
    request.length_layers = 2;
    return request;
}

TEST(TableCache, FindsTablesByContent) {
    TableCache cache;
    const auto table = cache.get(ramp(1), aligned(16));
    EXPECT_EQ(cache.get(ramp(1), aligned(16)), table);
    EXPECT_NE(cache.get(ramp(2), aligned(16)), table);
    EXPECT_NE(cache.get(ramp(1), aligned(17)), table);
    const auto other = cache.get(ramp(1), equal_steps(16));
    EXPECT_EQ(cache.get(ramp(1), equal_steps(16)), other);
    EXPECT_NE(cache.get(ramp(2), equal_steps(16)), other);
    const PreintegrationTable built = build_preintegration_table(ramp(1), aligned(16));
    EXPECT_EQ(table->emission, built.emission);
    EXPECT_EQ(other->texels, build_segment_table(ramp(1), equal_steps(16)).texels);
}

TEST(TableCache, KeepsEightTablesOfBothKindsTogether) {
    TableCache cache;
    std::weak_ptr<const PreintegrationTable> oldest = cache.get(ramp(1), aligned(16));
    std::weak_ptr<const SegmentTable> second = cache.get(ramp(1), equal_steps(16));
    for (int nodes = 2; nodes < 5; ++nodes) {
        cache.get(ramp(1), aligned(nodes));
        cache.get(ramp(1), equal_steps(nodes));
    }
    EXPECT_FALSE(oldest.expired());
    EXPECT_FALSE(second.expired());
    cache.get(ramp(1), aligned(16));  // is the newest now
    cache.get(ramp(1), aligned(5));
    EXPECT_FALSE(oldest.expired());
    EXPECT_TRUE(second.expired());
    for (int nodes = 20; nodes < 28; ++nodes) cache.get(ramp(1), equal_steps(nodes));
    EXPECT_TRUE(oldest.expired());
}

TEST(TableCache, FindsTablesThatOthersHold) {
    TableCache cache;
    const auto held = cache.get(ramp(1), aligned(16));
    for (int nodes = 2; nodes < 12; ++nodes) cache.get(ramp(1), equal_steps(nodes));
    EXPECT_EQ(held.use_count(), 1);  // the cache keeps it no longer
    EXPECT_EQ(cache.get(ramp(1), aligned(16)), held);
    EXPECT_EQ(held.use_count(), 2);  // and now it does
}

// A table takes 16 * 16 * 2 texels of 4 floats.
TEST(TableCache, KeepsNoMoreThanItMay) {
    TableCache cache(2 * 16 * 16 * 2 * 4 * sizeof(float));
    std::weak_ptr<const SegmentTable> first = cache.get(ramp(1), equal_steps(16));
    cache.get(ramp(2), equal_steps(16));
    EXPECT_FALSE(first.expired());
    cache.get(ramp(3), equal_steps(16));
    EXPECT_TRUE(first.expired());
    const auto large = cache.get(ramp(1), equal_steps(32));
    EXPECT_EQ(large.use_count(), 1);
}

TEST(TableCache, SharesNothingWithAnother) {
    TableCache one, other;
    EXPECT_NE(one.get(ramp(1), aligned(16)), other.get(ramp(1), aligned(16)));
}

TEST(TableCache, KeepsNothingThatCouldNotBeBuilt) {
    TableCache cache;
    EXPECT_THROW(cache.get(ramp(1), equal_steps(1 << 15)), Error);
    EXPECT_THROW(cache.get(ramp(1), equal_steps(1 << 15)), Error);
}

TEST(TableCache, GivesAllThreadsOneTable) {
    TableCache cache;
    constexpr int count = 8;
    std::vector<std::shared_ptr<const PreintegrationTable>> tables(count);
    std::vector<std::thread> threads;
    for (auto& table : tables) {
        threads.emplace_back([&] {
            for (int nodes = 8; nodes < 12; ++nodes) cache.get(ramp(2), aligned(nodes));
            table = cache.get(ramp(1), aligned(16));
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& table : tables) EXPECT_EQ(table, tables.front());
}

}  // namespace
}  // namespace lamina
