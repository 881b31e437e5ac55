// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// Volumes of more samples may lie on disks, so fewer of them are looked at to choose a camera and
// extinctions: in memory just as many, because the same picture has to come of it.
constexpr std::int64_t large_volume = std::int64_t{1} << 28;

}  // namespace lamina
