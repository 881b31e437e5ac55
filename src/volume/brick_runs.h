// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "volume/brick_cache.h"
#include "volume/sample_window.h"

namespace lamina {

// How bricks lie in a volume.
struct BrickPlaces {
    std::array<std::int64_t, 3> size;    // of the volume
    std::array<std::int64_t, 3> count;   // of bricks
    std::array<std::int64_t, 3> origin;  // the volume's sample with which brick 0 begins

    std::array<std::int64_t, 3> first_sample(std::uint32_t brick) const {
        const std::int64_t number = brick;
        return {origin[0] + number % count[0] * BrickCache::edge,
                origin[1] + number / count[0] % count[1] * BrickCache::edge,
                origin[2] + number / (count[0] * count[1]) * BrickCache::edge};
    }

    // The volume's samples of bricks that lie beside each other along x, and so many more on each
    // side.
    SampleBox box_of(std::uint32_t first_brick, std::uint32_t last_brick,
                     std::int64_t margin) const {
        const auto first = first_sample(first_brick), last = first_sample(last_brick);
        SampleBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t last_of_all = size[axis] - 1;
            const std::int64_t from =
                std::clamp<std::int64_t>(first[axis] - margin, 0, last_of_all);
            const std::int64_t to =
                std::clamp<std::int64_t>(last[axis] + BrickCache::edge + margin, from, last_of_all);
            box.first[axis] = from;
            box.size[axis] = to - from + 1;
        }
        return box;
    }
};

// Reads the samples of bricks, with `margin` more on each side, at once for those that lie beside
// each other along x, and calls make(wanted, first sample, window) for each. T: the type of the
// source's samples.
template <typename T, typename Make>
void read_brick_runs(const SampleSource& source, const BrickPlaces& places,
                     std::span<const BrickCache::Wanted> wanted, std::int64_t margin,
                     const Make& make) {
    const auto together = [&](std::uint32_t a, std::uint32_t b) {
        return a / places.count[0] == b / places.count[0];
    };
    for (std::size_t begin = 0, end = 0; begin < wanted.size(); begin = end) {
        for (end = begin + 1; end < wanted.size() &&
                              wanted[end].brick == wanted[end - 1].brick + 1 &&
                              together(wanted[end].brick, wanted[begin].brick);)
            ++end;
        SampleWindow<T> window;
        window.box = places.box_of(wanted[begin].brick, wanted[end - 1].brick, margin);
        const auto samples =
            std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(window.box.count()));
        source.read(window.box, samples.get());
        window.samples = samples.get();
        for (std::size_t i = begin; i < end; ++i)
            make(wanted[i], places.first_sample(wanted[i].brick), window);
    }
}

}  // namespace lamina
