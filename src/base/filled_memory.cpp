// SPDX-License-Identifier: Apache-2.0
#include "base/filled_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <new>

namespace lamina {

std::shared_ptr<void> filled_memory(std::size_t bytes) {
    std::shared_ptr<void> memory(std::malloc(bytes), &std::free);
    if (!memory) throw std::bad_alloc();
    prefer_huge_pages(memory.get(), bytes);
    return memory;
}

void prefer_huge_pages(void* memory, std::size_t bytes) {
    // Less may lie in the heap of malloc(), where what is asked would outlive the memory.
    constexpr std::size_t least = (std::size_t{1} << 25) + 1;
    if (bytes < least) return;
    // Whole pages alone. Where there are no huge ones, the system refuses, and nothing is lost.
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto first = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (first + page - 1) / page * page;
    const std::uintptr_t end = (first + bytes) / page * page;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace lamina
