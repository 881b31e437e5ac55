// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A volume that is drawn, with its min/max bricks, which are measured once.
struct VolumeData {
    explicit VolumeData(Volume read) : volume(std::move(read)), bricks(measure_bricks(volume)) {}

    Volume volume;
    MinMaxBricks bricks;
};

}  // namespace lamina
