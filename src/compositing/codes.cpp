// SPDX-License-Identifier: Apache-2.0
#include "compositing/codes.h"

#include <numeric>
#include <utility>

namespace lamina {

std::vector<std::uint32_t> dither_ranks(int period, std::uint64_t seed) {
    std::vector<std::uint32_t> ranks(static_cast<std::size_t>(period));
    std::iota(ranks.begin(), ranks.end(), 0u);
    SplitMix64 random(seed);
    for (std::size_t i = ranks.size() - 1; i > 0; --i) {
        std::swap(ranks[i], ranks[random.next() % (i + 1)]);
    }
    return ranks;
}

}  // namespace lamina
