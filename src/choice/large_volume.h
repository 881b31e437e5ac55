// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// Number of samples above which a volume may lie on disk, so that fewer samples are used to choose
// a camera and extinctions. Volumes in memory use just as many, so that the picture is the same.
constexpr std::int64_t large_volume = std::int64_t{1} << 28;

}  // namespace lamina
