// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

namespace lamina {

// Memory of any content, which is about to be filled from end to end. Throws std::bad_alloc.
std::shared_ptr<void> filled_memory(std::size_t bytes);

// Asks the system to back memory of 32 MiB and more by huge pages, where it has some on demand:
// pages of 4 KiB are cleared and mapped one by one, which can take seconds for a gigabyte.
void prefer_huge_pages(void* memory, std::size_t bytes);

}  // namespace lamina
