// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "volume_files/volume_opening.h"

namespace lamina::fuzz {

// Opens a volume, lists what its file has, measures it and, if it is small, plans its picture:
// open(use) opens it, or throws Error.
void check_volume(const std::function<Volume(const VolumeUse& use)>& open);

}  // namespace lamina::fuzz
