// SPDX-License-Identifier: Apache-2.0
#include "base/reserved_memory.h"

#include <sys/mman.h>

#include <new>
#include <utility>

#include "base/filled_memory.h"

namespace lamina {

ReservedMemory::ReservedMemory(std::size_t bytes, Filling filling) : size_(bytes) {
    if (bytes == 0) return;
    void* const mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<std::byte*>(mapped);
    if (filling == Filling::dense)
        prefer_huge_pages(mapped, bytes);
    else  // a huge page would take 2 MiB for its first byte
        madvise(mapped, bytes, MADV_NOHUGEPAGE);
}

ReservedMemory::~ReservedMemory() {
    if (data_ != nullptr) munmap(data_, size_);
}

void ReservedMemory::clear() {
    if (data_ != nullptr) madvise(data_, size_, MADV_DONTNEED);
}

void ReservedMemory::swap(ReservedMemory& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
}

}  // namespace lamina
