// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "scene/window_view.h"

namespace lamina {

// Consecutive places of a list that are drawn in some of the pixels alone.
struct LimitedRun {
    std::size_t first, end;
    PixelArea pixels;
};

// Tets, or cell fragments, back to front. No order of whole tets is right for all pixels if they
// hide one another in rings: these are listed several times, each time for other pixels.
template <typename Item>
struct DrawOrder {
    std::span<const Item> items;
    std::span<const LimitedRun> limited;  // ascending, disjoint; other places are for all pixels
    std::size_t first = 0;                // the place of items[0] that the runs count from

    // `count` items from the i-th on.
    DrawOrder part(std::size_t i, std::size_t count) const {
        const std::size_t begin = first + i, end = begin + count;
        const auto from = std::ranges::upper_bound(limited, begin, {}, &LimitedRun::end);
        const auto to = std::ranges::lower_bound(from, limited.end(), end, {}, &LimitedRun::first);
        return {items.subspan(i, count), {from, to}, begin};
    }
    // The pixels of the i-th item; null if these are all.
    const PixelArea* pixels(std::size_t i) const {
        if (limited.empty()) return nullptr;
        const auto run = std::ranges::upper_bound(limited, first + i, {}, &LimitedRun::end);
        return run != limited.end() && run->first <= first + i ? &run->pixels : nullptr;
    }
};

}  // namespace lamina
