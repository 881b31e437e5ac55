// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/value_counts.h"

namespace lamina {

// A volume that is drawn, with its min/max bricks, which are measured once. For a volume that stays
// in its files that is a pass over all of them, or over an index that an earlier one has left
// (volume/volume_index.h).
struct VolumeData {
    explicit VolumeData(Volume opened);

    Volume volume;
    MinMaxBricks bricks;
    std::optional<ValueCounts> values;  // of a volume that stays in its files
};

}  // namespace lamina
