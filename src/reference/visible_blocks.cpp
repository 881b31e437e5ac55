// SPDX-License-Identifier: Apache-2.0
#include "reference/visible_blocks.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/parallel.h"

namespace lamina {
namespace {

// The range of samples that are numbers; lo > hi where there are none. A cell with one that is not
// is transparent.
template <typename Sample>
struct SampleRange {
    Sample lo = std::numeric_limits<Sample>::max(), hi = std::numeric_limits<Sample>::lowest();

    void add(Sample sample) {
        lo = sample < lo ? sample : lo;
        hi = hi < sample ? sample : hi;
    }
};

}  // namespace

VisibleBlocks::VisibleBlocks(const Volume& volume, const TransferIntervals& transfer) {
    const std::array<std::int64_t, 3>& size = volume.grid().size;
    for (std::size_t axis = 0; axis < 3; ++axis) count_[axis] = (size[axis] - 1) / edge + 1;
    visible_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    volume.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        parallel_for(count_[1] * count_[2], 1, [&](std::int64_t row) {
            const std::int64_t first_y = row % count_[1] * edge, first_z = row / count_[1] * edge;
            std::vector<SampleRange<Sample>> of_row(static_cast<std::size_t>(count_[0]));
            // Neighbouring blocks share the samples between them.
            for (std::int64_t z = first_z; z < std::min(first_z + edge + 1, size[2]); ++z) {
                for (std::int64_t y = first_y; y < std::min(first_y + edge + 1, size[1]); ++y) {
                    const Sample* const line = samples + (z * size[1] + y) * size[0];
                    for (std::int64_t block = 0; block < count_[0]; ++block) {
                        SampleRange<Sample> range = of_row[static_cast<std::size_t>(block)];
                        const std::int64_t end = std::min((block + 1) * edge + 1, size[0]);
                        for (std::int64_t x = block * edge; x < end; ++x) range.add(line[x]);
                        of_row[static_cast<std::size_t>(block)] = range;
                    }
                }
            }
            for (std::int64_t block = 0; block < count_[0]; ++block) {
                const auto [lo, hi] = of_row[static_cast<std::size_t>(block)];
                visible_[static_cast<std::size_t>(row * count_[0] + block)] =
                    lo <= hi && transfer.visible(static_cast<double>(lo), static_cast<double>(hi));
            }
        });
    });
}

}  // namespace lamina
