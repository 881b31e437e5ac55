// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace lamina {

// Memory that is 0 and takes room where it has been written to, by pages. Throws std::bad_alloc.
class ReservedMemory {
  public:
    ReservedMemory() = default;
    // sparse: a byte here and there. dense: from the beginning on.
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
