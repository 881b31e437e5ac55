// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lamina/volume.h"

namespace lamina::testing {

// Returns the samples of a volume in memory, whose type must be T.
template <typename T>
std::vector<T> samples_of(const Volume& volume) {
    const auto* const first = static_cast<const T*>(volume.data());
    return std::vector<T>(first, first + volume.grid().sample_count());
}

}  // namespace lamina::testing
