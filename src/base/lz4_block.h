// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace lamina {

// A byte of an LZ4 block stands for at most so many bytes.
inline constexpr std::size_t lz4_expansion = 255;

// Decodes an LZ4 block (the format that lz4_Block_format.md describes; no frame around it) that has
// exactly output.size() bytes. Returns false where it is damaged, or has another number of bytes.
bool decode_lz4_block(std::span<const char> block, std::span<char> output);

}  // namespace lamina
