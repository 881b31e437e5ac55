// SPDX-License-Identifier: Apache-2.0
#pragma once

// Tells volumes of labels (segmentations, atlases) from pictures by their samples (docs/scene.md,
// "Labels").

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/value_type.h"
#include "lamina/volume.h"

namespace lamina {

// Largest number of labels of a volume: their codes fit into 16 bits.
inline constexpr std::size_t most_label_codes = 65535;

// Tells if a value can be that of a label. Beyond 2^53 all doubles are whole, measured or not.
template <typename T>
bool is_whole_label(T value) {
    if constexpr (std::is_integral_v<T>)
        return true;
    else
        return value == std::trunc(value) && std::abs(value) <= T(0x1p53);
}

// Returns the share of samples that equal their six neighbours (beyond the border, themselves) if
// samples in memory are taken for labels, else nothing. They are if
//   - all are whole numbers, of 2 to most_label_codes values,
//   - at least 95 % equal their six neighbours, and
//   - so do at least half of all pairs of neighbours of which neither has the most frequent value:
//     the inside of what a CT shows in empty air is noisy.
// Evenly spread slices are measured if there are more than 2^24 samples: of 2^22, but at least 8.
std::optional<double> share_if_labels(const std::array<std::int64_t, 3>& size, ValueType type,
                                      const void* samples);
// Measures a volume of whole numbers, which may stay in its files; others are not taken for labels.
std::optional<double> share_if_labels(const Volume& volume);

// Returns the volume with names and colours for labels that its file describes by their numbers.
// The codes of `described` are ignored.
Volume with_descriptions(const Volume& volume, std::vector<Label> described);

}  // namespace lamina
