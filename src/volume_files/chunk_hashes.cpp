// SPDX-License-Identifier: Apache-2.0
#include "volume_files/chunk_hashes.h"

#include <cstring>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/output_file.h"

namespace lamina {
namespace {

// The file has a hash a chunk, one of the array's two headers, and one of all these.
constexpr const char* file_name = "lamina-chunks";
constexpr std::size_t more_hashes = 2;

std::uint64_t hash_of_headers(const std::filesystem::path& folder) {
    ContentHash hash;
    for (const char* const name : {".zarray", ".zattrs"})
        hash.add(read_large_file(folder / name).text());
    return hash.word();
}

std::uint64_t hash_of_all(std::span<const std::uint64_t> hashes) {
    ContentHash hash;
    hash.add(hashes.data(), hashes.size_bytes());
    return hash.word();
}

}  // namespace

std::uint64_t hash_of_chunk(std::span<const char> stored) {
    ContentHash hash;
    hash.add(stored.data(), stored.size());
    return hash.word() | 1;  // not no_chunk
}

void write_chunk_hashes(const std::filesystem::path& folder,
                        const std::vector<std::uint64_t>& hashes) {
    std::vector<std::uint64_t> all = hashes;
    all.push_back(hash_of_headers(folder));
    all.push_back(hash_of_all(all));
    AtomicFile file(folder / file_name);
    file.write(all.data(), all.size() * sizeof all[0]);
    file.commit();
}

std::optional<std::vector<std::uint64_t>> read_chunk_hashes(const std::filesystem::path& folder,
                                                            std::int64_t count) {
    std::vector<std::uint64_t> all(static_cast<std::size_t>(count) + more_hashes);
    const std::filesystem::path file = folder / file_name;
    std::error_code absent;
    if (!std::filesystem::is_regular_file(file, absent)) return std::nullopt;
    const ByteBuffer bytes = read_large_file(file);
    if (bytes.size() != all.size() * sizeof all[0]) return std::nullopt;
    std::memcpy(all.data(), bytes.text().data(), bytes.size());
    const std::uint64_t of_all = all.back();
    all.pop_back();
    if (hash_of_all(all) != of_all || hash_of_headers(folder) != all.back()) return std::nullopt;
    all.pop_back();
    return all;
}

}  // namespace lamina
