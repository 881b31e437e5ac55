// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lamina {

// How a VTK XML file compresses the blocks of its arrays: the names of VTK's classes.
class VtuCompressor {
  public:
    // Throws Error for a class that is not known. `what`: names the file and the array in messages.
    static VtuCompressor named(const std::string& name, const std::string& what);

    const char* word() const { return word_; }  // "zlib", "LZ4", "LZMA"
    // A stored byte stands for at most so many bytes.
    std::uint64_t most_expansion() const { return most_expansion_; }
    // Decodes a block of exactly block.size() bytes. Returns how many of the `stored` bytes it
    // took, or -1 where it is damaged or has another number of bytes.
    std::int64_t decode(std::span<const char> stored, std::span<char> block) const {
        return decode_(stored, block);
    }

  private:
    using Decode = std::int64_t (*)(std::span<const char>, std::span<char>);

    VtuCompressor(const char* word, std::uint64_t most_expansion, Decode decoder)
        : word_(word), most_expansion_(most_expansion), decode_(decoder) {}

    const char* word_;
    std::uint64_t most_expansion_;
    Decode decode_;
};

}  // namespace lamina
