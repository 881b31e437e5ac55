// SPDX-License-Identifier: Apache-2.0
// Loops that do one thing as fast as a core can, with the instruction set in use. What they return
// is of no use but must be used, lest the compiler leave them out.
#pragma once

#include <cstdint>
#include <span>

namespace lamina {

int float_lanes();

// `rounds` of one vector operation in each of 12 chains: more than a core has in flight, and as
// many as fit 16 registers.
inline constexpr int chains = 12;
float multiply_and_add(std::int64_t rounds, float factor, float summand);  // x = x factor + summand
float divide(std::int64_t rounds, float dividend);                         // x = dividend / x

// `rounds` of 4 gathers of one 32-bit number a lane from the table, whose size is a power of two.
inline constexpr int gathers = 4;
float gather_anywhere(std::span<const float> table, std::int64_t rounds);
// The lanes of a gather lie in 4 x 4 neighbours (8 lanes: 4 x 2), in rows of 256 numbers; blocks
// follow each other.
float gather_blocks(std::span<const float> table, std::int64_t rounds);

float read_all(std::span<const float> numbers);
// a = b + c / 2 (McCalpin's STREAM triad): 12 bytes a number, and the reading of a's lines.
void triad(std::span<float> a, std::span<const float> b, std::span<const float> c);

}  // namespace lamina
