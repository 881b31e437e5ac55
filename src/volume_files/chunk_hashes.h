// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace lamina {

// Hashes of the chunks of an array that lamina wrote, in the order of ZarrChunks, so that a damaged
// or lost chunk is never drawn.
inline constexpr std::uint64_t no_chunk = 0;  // of a chunk of zeros, which has no file

std::uint64_t hash_of_chunk(std::span<const char> stored);

// Writes the hashes into the array's folder, with one of .zarray and .zattrs, which must be there.
// Throws Error.
void write_chunk_hashes(const std::filesystem::path& folder,
                        const std::vector<std::uint64_t>& hashes);

// Returns nothing if there is no such file, if it is damaged or of another number of chunks, or if
// .zarray or .zattrs are not those that were written.
std::optional<std::vector<std::uint64_t>> read_chunk_hashes(const std::filesystem::path& folder,
                                                            std::int64_t count);

}  // namespace lamina
