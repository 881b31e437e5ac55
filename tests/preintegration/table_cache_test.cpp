// SPDX-License-Identifier: Apache-2.0
#include "preintegration/preintegration_table.h"

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

TableRequest at_knots(int nodes) {
    TableRequest request;
    request.scalar_nodes = nodes;
    request.length_layers = 2;
    return request;
}

TableRequest evenly(int nodes) {
    TableRequest request = at_knots(nodes);
    request.kind = TableKind::uniform;
    return request;
}

TEST(TableCache, FindsTablesByContent) {
    TableCache cache;
    const auto table = cache.get(ramp(1), at_knots(16));
    EXPECT_EQ(cache.get(ramp(1), at_knots(16)), table);
    EXPECT_NE(cache.get(ramp(2), at_knots(16)), table);
    EXPECT_NE(cache.get(ramp(1), at_knots(17)), table);
    const auto other = cache.get(ramp(1), evenly(16));
    EXPECT_EQ(cache.get(ramp(1), evenly(16)), other);
    EXPECT_NE(cache.get(ramp(2), evenly(16)), other);
    const auto& knots = dynamic_cast<const KnotTable&>(*table);
    EXPECT_EQ(knots.emission, KnotTable(ramp(1), at_knots(16)).emission);
    const auto& uniform = dynamic_cast<const UniformTable&>(*other);
    EXPECT_EQ(uniform.texels, UniformTable(ramp(1), evenly(16)).texels);
}

// The longest segment changes when a camera moves.
TEST(TableCache, OneLayerServesSegmentsOfAnyLength) {
    TableCache cache;
    TableRequest near = at_knots(16), far = at_knots(16);
    far.max_length = 2 * near.max_length;
    EXPECT_NE(cache.get(ramp(1), near), cache.get(ramp(1), far));
    near.length_layers = far.length_layers = 1;
    EXPECT_EQ(cache.get(ramp(1), near), cache.get(ramp(1), far));
    near.kind = far.kind = TableKind::uniform;
    near.store = far.store = TableStore::opacity;  // depends on max_length
    EXPECT_NE(cache.get(ramp(1), near), cache.get(ramp(1), far));
}

TEST(TableCache, KeepsEightTablesOfBothKindsTogether) {
    TableCache cache;
    std::weak_ptr<const PreintegrationTable> oldest = cache.get(ramp(1), at_knots(16));
    std::weak_ptr<const PreintegrationTable> second = cache.get(ramp(1), evenly(16));
    for (int nodes = 2; nodes < 5; ++nodes) {
        cache.get(ramp(1), at_knots(nodes));
        cache.get(ramp(1), evenly(nodes));
    }
    EXPECT_FALSE(oldest.expired());
    EXPECT_FALSE(second.expired());
    cache.get(ramp(1), at_knots(16));  // makes `oldest` the newest table
    cache.get(ramp(1), at_knots(5));
    EXPECT_FALSE(oldest.expired());
    EXPECT_TRUE(second.expired());
    for (int nodes = 20; nodes < 28; ++nodes) cache.get(ramp(1), evenly(nodes));
    EXPECT_TRUE(oldest.expired());
}

TEST(TableCache, FindsTablesThatAreStillInUse) {
    TableCache cache;
    const auto held = cache.get(ramp(1), at_knots(16));
    for (int nodes = 2; nodes < 12; ++nodes) cache.get(ramp(1), evenly(nodes));
    EXPECT_EQ(held.use_count(), 1);  // the cache no longer keeps it
    EXPECT_EQ(cache.get(ramp(1), at_knots(16)), held);
    EXPECT_EQ(held.use_count(), 2);  // the cache keeps it again
}

// A table takes 16 * 16 * 2 texels of 4 floats.
TEST(TableCache, KeepsNoMoreBytesThanAllowed) {
    TableCache cache(2 * 16 * 16 * 2 * 4 * sizeof(float));
    std::weak_ptr<const PreintegrationTable> first = cache.get(ramp(1), evenly(16));
    cache.get(ramp(2), evenly(16));
    EXPECT_FALSE(first.expired());
    cache.get(ramp(3), evenly(16));
    EXPECT_TRUE(first.expired());
    const auto large = cache.get(ramp(1), evenly(32));
    EXPECT_EQ(large.use_count(), 1);
}

TEST(TableCache, SharesNothingWithAnother) {
    TableCache one, other;
    EXPECT_NE(one.get(ramp(1), at_knots(16)), other.get(ramp(1), at_knots(16)));
}

TEST(TableCache, KeepsNothingThatCouldNotBeBuilt) {
    TableCache cache;
    EXPECT_THROW(cache.get(ramp(1), evenly(1 << 15)), Error);
    EXPECT_THROW(cache.get(ramp(1), evenly(1 << 15)), Error);
}

TEST(TableCache, GivesAllThreadsOneTable) {
    TableCache cache;
    constexpr int count = 8;
    std::vector<std::shared_ptr<const PreintegrationTable>> tables(count);
    std::vector<std::thread> threads;
    for (auto& table : tables) {
        threads.emplace_back([&] {
            for (int nodes = 8; nodes < 12; ++nodes) cache.get(ramp(2), at_knots(nodes));
            table = cache.get(ramp(1), at_knots(16));
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& table : tables) EXPECT_EQ(table, tables.front());
}

}  // namespace
}  // namespace lamina
