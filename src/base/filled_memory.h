// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

namespace lamina {

// Memory that is about to be filled from end to end. Throws std::bad_alloc.
std::shared_ptr<void> filled_memory(std::size_t bytes);

// Asks for huge pages, where the system has some on demand: of pages of 4 KiB the system clears
// and maps each by itself, which can take a second and more for a gigabyte.
void prefer_huge_pages(void* memory, std::size_t bytes);

}  // namespace lamina
