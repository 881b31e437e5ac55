// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/volume.h"

namespace lamina::fuzz {

// Measures a volume that was read, and plans its picture where it is small.
void check_volume(const Volume& volume);

}  // namespace lamina::fuzz
