// SPDX-License-Identifier: Apache-2.0
#include "projection/cpu_batch.h"

#include <gtest/gtest.h>

#include <vector>

namespace lamina {
namespace {

constexpr int tiles = 600;  // more than fit into one set

std::vector<std::size_t> drawn_by(const TileBatch& batch, std::size_t tile) {
    std::vector<std::size_t> numbers;
    batch.for_each_word(tile, [&](std::size_t first, std::uint64_t word) {
        for_each_member(first, word, [&](std::size_t number) { numbers.push_back(number); });
    });
    return numbers;
}

void add(TileBatch::Chunk& chunk, float depth, std::int32_t tet,
         const std::vector<std::size_t>& touched) {
    chunk.next().seen().center_depth = depth;
    chunk.add({}, tet);
    for (const std::size_t tile : touched) chunk.touch(tile);
}

TEST(TileBatch, TilesDrawTheirCellFragmentsInTheOrderOfTheChunks) {
    TileBatch batch(3, tiles, false, false);
    add(batch.chunk(2), 5, 9, {599});
    add(batch.chunk(0), 1, 7, {0, 599});
    add(batch.chunk(0), 2, 7, {0});
    constexpr std::size_t third = 2 * TileBatch::chunk_size;
    EXPECT_EQ(drawn_by(batch, 0), (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(drawn_by(batch, 599), (std::vector<std::size_t>{0, third}));
    EXPECT_FALSE(batch.is_drawn_by(511));
    EXPECT_EQ(batch.record(1).seen().center_depth, 2);
    EXPECT_EQ(batch.record(third).seen().center_depth, 5);
    EXPECT_EQ(batch.chunk(0).tets(), 1);
    EXPECT_TRUE(batch.chunk(1).empty());
}

TEST(TileBatch, AFullChunkIsForgottenWhenItIsCleared) {
    TileBatch batch(2, tiles, false, false);
    for (std::size_t number = 0; number < TileBatch::chunk_size; ++number)
        add(batch.chunk(1), 0, static_cast<std::int32_t>(number), {number});
    EXPECT_EQ(drawn_by(batch, 511), (std::vector<std::size_t>{2 * TileBatch::chunk_size - 1}));
    batch.chunk(1).clear();
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        EXPECT_FALSE(batch.is_drawn_by(tile));
        EXPECT_TRUE(drawn_by(batch, tile).empty());
    }
    add(batch.chunk(1), 3, 0, {511});
    EXPECT_EQ(drawn_by(batch, 511), (std::vector<std::size_t>{TileBatch::chunk_size}));
}

}  // namespace
}  // namespace lamina
