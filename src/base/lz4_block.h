// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace lamina {

// The most bytes that one byte of an LZ4 block can stand for.
inline constexpr std::size_t lz4_expansion = 255;

// Decodes an LZ4 block (lz4_Block_format.md; no frame around it) that holds exactly output.size()
// bytes. Returns false if it is damaged or holds another number of bytes.
bool decode_lz4_block(std::span<const char> block, std::span<char> output);

}  // namespace lamina
