// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace lamina::python {

// An array's lines are dealt out to so many parts, each with lines from all over it.
inline constexpr std::size_t sample_parts = 16;

// Returns the hash of a part, 0 .. sample_parts - 1. Of arrays above 64 MiB the parts leave lines
// out, so that none has more than 4 MiB. A contiguous change of 2 KiB shows in every part; of
// arrays above 64 MiB it must be as many times longer as these have 64 MiB, rounded up to a power
// of two. Of arrays up to 64 KiB each part has all lines. It protects against accidents, not
// attacks.
std::uint64_t hash_of_part(const char* samples, std::size_t bytes, std::size_t part);

}  // namespace lamina::python
