// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {

// Layers of samples at a side of a volume, all of one value. If this is not the volume's lowest,
// one sample in 1000 of each layer may have another, such as that of a burnt-in mark.
struct BorderLayers {
    struct Odd {
        std::int64_t index = 0;  // of the sample in the volume, x fastest
        double value = 0;
    };

    std::size_t axis = 0;
    bool upper = false;  // at the axis's end, else at its beginning
    std::int64_t width = 0;
    double value = 0;
    double behind = 0;  // median of the first layer inside
    SampleBox samples{};
    std::vector<Odd> odd{};  // samples of other values
};

// A border of constant values, as programs put around data to enlarge them: it means nothing, but
// closes the view of what is inside.
struct ConstantBorder {
    std::vector<BorderLayers> layers;  // at most one a side, in the order of taking them away
    SampleBox inside;
};

// Finds layers of one value at the sides of a volume, behind which the samples have several values,
// most of them others: up to two thirds of the samples along an axis. Layers of the lowest value
// are no border if what lies behind them is much higher: they are the empty space around a thing.
// Nothing in volumes that are large (large_volume). `range`: of the finite samples.
std::optional<ConstantBorder> find_constant_border(const Volume& volume, const ValueRange& range);

// Number of samples that find_constant_border() reads at once, or a row if it is longer, of a
// volume that stays in its files.
constexpr std::int64_t most_read = std::int64_t{1} << 20;

// Calls visitor(a SampleWindow<T> with the samples of a box), and returns its result. A window in
// memory holds the whole volume; of a volume that stays in its files, the box is read. T: the type
// of the samples.
template <typename T, typename Visitor>
decltype(auto) visit_window(const Volume& volume, const SampleBox& box, const Visitor& visitor) {
    if (volume.in_memory()) {
        return visitor(
            SampleWindow<T>{{{0, 0, 0}, volume.grid().size}, static_cast<const T*>(volume.data())});
    }
    const auto read = std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(box.count()));
    volume.store().source().read(box, read.get());
    return visitor(SampleWindow<T>{box, read.get()});
}

}  // namespace lamina
