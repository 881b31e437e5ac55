// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <new>
#include <string>
#include <utility>

namespace lamina {

namespace {

std::atomic<std::uint64_t> given_limit{0}, default_limit{0};  // 0: not set

}  // namespace

std::uint64_t machine_memory() {
    static const std::uint64_t measured = [] {
        const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
        std::uint64_t bytes = page * static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES));
        // The file has "max", or does not exist, if the control group has no limit.
        std::uint64_t group = 0;
        if (std::ifstream("/sys/fs/cgroup/memory.max") >> group) bytes = std::min(bytes, group);
        return bytes;
    }();
    return measured;
}

std::uint64_t memory_limit() {
    if (const std::uint64_t given = given_limit.load(); given > 0) return given;
    const std::uint64_t usual = default_limit.load();
    return usual > 0 ? usual : machine_memory() / 2;
}

void set_memory_limit(std::uint64_t bytes) {
    given_limit.store(bytes);
}

void set_default_memory_limit(std::uint64_t bytes) {
    default_limit.store(bytes);
}

bool memory_limit_is_given() {
    return given_limit.load() > 0;
}

std::uint64_t resident_memory() {
    std::uint64_t pages = 0, resident = 0;
    if (!(std::ifstream("/proc/self/statm") >> pages >> resident)) return 0;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_memory() {
    std::ifstream status("/proc/self/status");
    const std::string name = "VmHWM:";
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(name)) return std::stoull(line.substr(name.size())) * 1024;  // KiB
    return 0;
}

std::uint64_t memory_left() {
    const std::uint64_t allowed = memory_limit() + own_memory, taken = resident_memory();
    return allowed - std::min(allowed, taken);
}

std::shared_ptr<void> filled_memory(std::size_t bytes) {
    std::shared_ptr<void> memory(std::malloc(bytes), &std::free);
    if (!memory) throw std::bad_alloc();
    prefer_huge_pages(memory.get(), bytes);
    return memory;
}

void prefer_huge_pages(void* memory, std::size_t bytes) {
    // malloc() maps blocks of more than 32 MiB by themselves. Smaller ones may lie in its heap,
    // where the advice would stay after they are freed.
    constexpr std::size_t least = (std::size_t{1} << 25) + 1;
    if (bytes < least) return;
    // Advice is for whole pages. A system without huge pages refuses it, and nothing is lost.
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto first = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t begin = (first + page - 1) / page * page;
    const std::uintptr_t end = (first + bytes) / page * page;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

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
