// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "lamina/volume.h"
#include "volume/sample_source.h"
#include "volume_files/stored_data.h"

namespace lamina {

// What a volume is opened for.
struct VolumeUse {
    enum class Residence {
        in_memory,
        as_fits,   // in its files where it does not fit the memory limit and can stay there
        in_files,  // Error where it cannot stay there
        in_order,  // in its files where they can be read at least once, from first to last
    };
    Residence residence = Residence::in_memory;
    bool lit = false;  // drawing takes memory for gradients, too
};

// Whether a volume that can do so is to stay in its files: by the memory that it and what is drawn
// of it take (base/memory.h).
bool stays_in_files(const Grid& grid, SampleType type, const VolumeUse& use);

// Of a volume that cannot stay in its files: throws Error where it has to, or where its samples
// alone take more than a memory limit that somebody has set. `name`: of the file; `why`: as "its
// data are compressed".
void expect_room(const std::string& name, std::uint64_t bytes, const VolumeUse& use,
                 const std::string& why);

// The volume of data that a header has told: in its files where the use allows it and memory has no
// room for it, else in memory. Throws Error.
Volume open_stored(const Grid& grid, const StoredData& data, const VolumeUse& use);

// A volume that stays in its files.
Volume stored_volume(const Grid& grid, SampleType type, std::unique_ptr<const SampleSource> source);

}  // namespace lamina
