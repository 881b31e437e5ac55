// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "lamina/memory.h"

namespace lamina {

// Memory in bytes that the process may take for itself, beside memory_limit() for data.
constexpr std::uint64_t own_memory = 200'000'000;

bool memory_limit_is_told();  // true once set_memory_limit() was called

// Sets the limit that holds until somebody calls set_memory_limit().
void set_default_memory_limit(std::uint64_t bytes);

// Returns the bytes of memory of the machine, or of the control group that the process is in.
std::uint64_t machine_memory();

// Returns the process's resident memory in bytes; 0 if it is not known.
std::uint64_t resident_memory();

// Returns the largest resident memory so far, as the kernel keeps it for the program alone: that of
// getrusage() includes what the process held before it became lamina.
std::uint64_t peak_resident_memory();

// Returns how many bytes may still be taken: memory_limit() + own_memory - resident_memory(), 0 or
// more.
std::uint64_t memory_left();

// Takes memory without clearing it, for data that fill it from end to end. Throws std::bad_alloc.
std::shared_ptr<void> filled_memory(std::size_t bytes);

// Asks the system to back memory of more than 32 MiB by huge pages, if it has some on demand: pages
// of 4 KiB are cleared and mapped one by one, which can take seconds for a gigabyte.
void prefer_huge_pages(void* memory, std::size_t bytes);

// Memory that is 0 at first and takes room, page by page, only once it is written to. Throws
// std::bad_alloc.
class ReservedMemory {
  public:
    ReservedMemory() = default;
    // sparse: bytes are written here and there. dense: they are written from the beginning on.
    enum class Filling { sparse, dense };
    explicit ReservedMemory(std::size_t bytes, Filling filling = Filling::sparse);
    ReservedMemory(ReservedMemory&& other) noexcept { swap(other); }
    ReservedMemory& operator=(ReservedMemory&& other) noexcept {
        swap(other);
        return *this;
    }
    ~ReservedMemory();

    std::byte* data() { return data_; }
    const std::byte* data() const { return data_; }
    std::size_t size() const { return size_; }
    void clear();  // all is 0 again

  private:
    void swap(ReservedMemory& other) noexcept;

    std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lamina
