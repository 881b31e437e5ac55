// SPDX-License-Identifier: Apache-2.0
#include "base/lz4_block.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace lamina {
namespace {

std::string decoded(const std::string& block, std::size_t size) {
    std::string output(size, '?');
    return decode_lz4_block(block, output) ? output : "damaged";
}

// By hand from lz4_Block_format.md.
TEST(Lz4Block, LiteralsMatchesAndLongLengths) {
    EXPECT_EQ(decoded(std::string("\x30") + "abc", 3), "abc");
    // 3 literals, then 4 + 4 bytes from 3 back, which overlap what they write; 1 literal.
    EXPECT_EQ(decoded(std::string("\x34") + "abc\x03" + std::string(1, '\0') + "\x10" + "d", 12),
              "abcabcabcabd");
    // 15 + 255 + 5 literals.
    const std::string many(275, 'x');
    std::string literals("\xf0\xff\x05");
    literals.append(many);
    EXPECT_EQ(decoded(literals, 275), many);
    // 1 literal, then 4 + 15 + 255 + 0 bytes from 1 back.
    const std::string run("\x1fy\x01\0\xff\0\0", 7);
    EXPECT_EQ(decoded(run, 275), std::string(275, 'y'));
}

TEST(Lz4Block, DamagedBlocks) {
    EXPECT_EQ(decoded("", 1), "damaged");
    EXPECT_EQ(decoded("\x30"
                      "ab",
                      3),
              "damaged");  // literals end early
    EXPECT_EQ(decoded("\x30"
                      "abc",
                      2),
              "damaged");  // too many
    EXPECT_EQ(decoded("\x30"
                      "abc",
                      4),
              "damaged");  // too few
    EXPECT_EQ(decoded(std::string("\x14") + "a\x02" + std::string(1, '\0'), 9), "damaged");
    EXPECT_EQ(decoded(std::string("\x14") + "a" + std::string(2, '\0'), 9), "damaged");
    EXPECT_EQ(decoded("\xf0\xff", 300), "damaged");
    EXPECT_EQ(decoded("\x14"
                      "a\x01",
                      9),
              "damaged");
    std::mt19937 random(1);
    for (int round = 0; round < 100000; ++round) {
        std::string block(random() % 20, '\0');
        for (char& c : block) c = static_cast<char>(random() % 64);
        decoded(block, random() % 40);
    }
}

}  // namespace
}  // namespace lamina
