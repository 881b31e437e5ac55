// SPDX-License-Identifier: Apache-2.0
#include "projection/scatter.h"

#include <utility>

#include "compositing/random_bits.h"

namespace lamina {

void scatter(std::span<TetPart> parts) {
    SplitMix64 random(1);
    for (std::size_t left = parts.size(); left > 1; --left)
        std::swap(parts[left - 1], parts[random.next() % left]);
}

}  // namespace lamina
