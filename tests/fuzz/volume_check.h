// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/volume.h"

namespace lamina::fuzz {

// Measures a volume that was read; a small one is planned for, too. Throws as check_slice_plans().
void check_volume(const Volume& volume);

}  // namespace lamina::fuzz
