// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace lamina {

// The most doubles that a vector of any instruction set has: AVX-512. Bits of lanes fill a byte.
inline constexpr std::size_t longest_vector = 8;

}  // namespace lamina
