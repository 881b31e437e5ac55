// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/volume.h"

namespace lamina::fuzz {

// Measures a volume that was read and, if it is small, plans its picture.
void check_volume(const Volume& volume);

}  // namespace lamina::fuzz
