// SPDX-License-Identifier: Apache-2.0
// Reproducible random numbers: hashes of a place, for stochastic rounding, and sequences, for
// permutations.
#pragma once

#include <cstdint>

namespace lamina {

// 32 random bits of (column, row, sample) and a seed: the hash pcg4d of Jarzynski and Olano, "Hash
// Functions for GPU Rendering", JCGT 2020. Twin of shaders/compositing/random_bits.glsl.
constexpr std::uint32_t random_bits(std::uint32_t column, std::uint32_t row, std::uint32_t sample,
                                    std::uint32_t seed) {
    std::uint32_t v[4] = {column, row, sample, seed};
    for (std::uint32_t& x : v) x = x * 1664525u + 1013904223u;
    const auto mix = [&v] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    mix();
    for (std::uint32_t& x : v) x ^= x >> 16;
    mix();
    return v[3];
}

// splitmix64 (Steele, Lea, Flood 2014).
class SplitMix64 {
  public:
    explicit constexpr SplitMix64(std::uint64_t seed) : state_(seed) {}
    constexpr std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

  private:
    std::uint64_t state_;
};

}  // namespace lamina
