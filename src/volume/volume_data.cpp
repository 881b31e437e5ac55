// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_data.h"

#include <utility>

#include "volume/volume_index.h"

namespace lamina {

VolumeData::VolumeData(Volume opened) : volume(std::move(opened)) {
    if (volume.in_memory()) {
        bricks = measure_bricks(volume);
        return;
    }
    VolumeIndex index = index_of(volume);
    bricks = std::move(index.bricks);
    values = std::move(index.values);
}

}  // namespace lamina
