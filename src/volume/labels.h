// SPDX-License-Identifier: Apache-2.0
#pragma once

// Tells volumes of labels (segmentations, atlases) from pictures by their samples (docs/scene.md,
// "Labels").

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
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

// How samples compare with labels (docs/scene.md, "Labels").
struct LabelSigns {
    enum class Verdict {
        none,
        scattered,  // all signs, but too few samples equal their neighbours
        smooth,     // all signs, but values that touch differ mostly by 1, as in a rounded field
        labels
    };
    Verdict verdict = Verdict::none;
    double equal = 0;   // share of samples that equal their six neighbours
    double by_one = 0;  // share of unequal neighbours that differ by 1

    bool are_labels() const { return verdict == Verdict::labels; }
};

// Measures samples in memory. They are taken for labels if
//   - all are whole numbers, of 2 to most_label_codes values,
//   - at least 95 % equal their six neighbours (beyond the border, themselves),
//   - at least half of the values have an inside: an equal pair of neighbours for every
//     two unequal ones. Pairs with the most frequent value do not count: most CTs are empty air,
//     and what they show is noisy; blurred edges have values that lie nowhere side by side. And
//   - there are up to 4 values, or less than 90 % of unequal neighbours differ by 1.
// Evenly spread slices are measured if there are more than 2^24 samples: of 2^22, but at least 8.
LabelSigns label_signs(const std::array<std::int64_t, 3>& size, ValueType type,
                       const void* samples);
// Measures a volume of whole numbers, which may stay in its files; others are not taken for labels.
LabelSigns label_signs(const Volume& volume);

// Returns a text that other lists of numbers do not have; empty if samples are the file's numbers.
std::string identity_of_codes(const Volume& volume);

// Returns the volume with names and colours for labels that its file describes by their numbers.
// The codes of `described` are ignored.
Volume with_descriptions(const Volume& volume, std::vector<Label> described);

}  // namespace lamina
