// SPDX-License-Identifier: Apache-2.0
#include "projection/scatter.h"

#include <algorithm>
#include <utility>

#include "compositing/random_bits.h"

namespace lamina {

void scatter(std::span<TetPart> parts) {
    std::ranges::sort(parts, {},
                      [](const TetPart& part) { return std::pair(part.tet, part.piece); });
    SplitMix64 random(1);
    for (std::size_t left = parts.size(); left > 1; --left)
        std::swap(parts[left - 1], parts[random.next() % left]);
}

}  // namespace lamina
