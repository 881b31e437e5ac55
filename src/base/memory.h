// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

#include "lamina/volume.h"

namespace lamina {

// Bytes that the process may take for its own needs, beside memory_limit() bytes for data.
constexpr std::uint64_t own_memory = 200'000'000;

bool memory_limit_is_given();  // true once set_memory_limit() was called

// Sets memory_limit() for as long as set_memory_limit() is not called.
void set_default_memory_limit(std::uint64_t bytes);

// Returns the bytes of memory of the machine, or of the control group that the process is in.
std::uint64_t machine_memory();

// Returns the process's resident memory in bytes; 0 if it is not known.
std::uint64_t resident_memory();

// Returns the largest resident memory so far in bytes, of this program alone (VmHWM).
std::uint64_t peak_resident_memory();

// Returns how many bytes may still be taken: memory_limit() + own_memory - resident_memory(), >= 0.
std::uint64_t memory_left();

// Allocates memory that is not zeroed, for data that will fill all of it. Throws std::bad_alloc.
std::shared_ptr<void> filled_memory(std::size_t bytes);

// Asks for huge pages beyond 32 MiB: with 4 KiB pages, first writes to a gigabyte take seconds.
void prefer_huge_pages(void* memory, std::size_t bytes);

// Memory that is 0 at first and takes pages only as they are written to. Throws std::bad_alloc.
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
    void clear();  // sets all bytes to 0 and gives the physical memory back

  private:
    void swap(ReservedMemory& other) noexcept;

    std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

// Tells whether all bytes have one value. `count`: 1 or more.
inline bool all_equal(const void* bytes, std::size_t count, std::uint8_t value) {
    const auto* const first = static_cast<const std::uint8_t*>(bytes);
    return *first == value && std::memcmp(first, first + 1, count - 1) == 0;
}

inline bool all_zero(const void* bytes, std::size_t count) {
    return all_equal(bytes, count, 0);
}

// An array of bytes most of which have one value, the background: pages of background alone take no
// physical memory. Copies share the bytes. Several threads may set different bytes.
class SparseBytes {
  public:
    SparseBytes() = default;
    SparseBytes(std::size_t size, std::uint8_t background)
        : size_(size),
          background_(background),
          memory_(std::make_shared<ReservedMemory>(size + padding)) {}

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::uint8_t background() const { return background_; }
    std::uint8_t operator[](std::size_t i) const {
        return static_cast<std::uint8_t>(coded()[i] ^ background_);
    }
    void set(std::size_t i, std::uint8_t value) {
        const auto code = static_cast<std::uint8_t>(value ^ background_);
        auto* const at = reinterpret_cast<std::uint8_t*>(memory_->data()) + i;
        if (*at != code) *at = code;
    }
    // Sets the bytes from `first` on. Pages of background alone stay untouched, without memory;
    // others are not read before they are written, which would map them twice.
    void set(std::size_t first, std::span<const std::uint8_t> values) {
        constexpr std::size_t page = 4096;
        std::array<std::uint8_t, page> codes;
        auto* const bytes = reinterpret_cast<std::uint8_t*>(memory_->data());
        while (!values.empty()) {
            const std::size_t count = std::min(page - first % page, values.size());
            for (std::size_t i = 0; i < count; ++i)
                codes[i] = static_cast<std::uint8_t>(values[i] ^ background_);
            if (!all_zero(codes.data(), count) || !all_zero(bytes + first, count))
                std::memcpy(bytes + first, codes.data(), count);
            first += count;
            values = values.subspan(count);
        }
    }

    // Returns the bytes as they are stored: each combined with the background by exclusive or.
    // Three bytes beyond size() may be read, too, for vector code that reads four at a time.
    const std::uint8_t* coded() const {
        return reinterpret_cast<const std::uint8_t*>(memory_->data());
    }

    // Returns the first place in first .. end - 1 that has this value, or `end` if none has it.
    std::size_t find(std::uint8_t value, std::size_t first, std::size_t end) const {
        const auto code = static_cast<std::uint8_t>(value ^ background_);
        if (first == end || coded()[first] == code) return first;
        const void* const found = std::memchr(coded() + first, code, end - first);
        if (found == nullptr) return end;
        return static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - coded());
    }

    std::size_t count(std::uint8_t value) const {
        const auto code = static_cast<std::uint8_t>(value ^ background_);
        std::size_t found = 0;
        for (std::size_t i = 0; i < size_; ++i) found += coded()[i] == code;
        return found;
    }

  private:
    static constexpr std::size_t padding = 3;

    std::size_t size_ = 0;
    std::uint8_t background_ = 0;
    std::shared_ptr<ReservedMemory> memory_;
};

}  // namespace lamina
