// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "lamina/volume.h"

namespace lamina {

// A volume that is made by formula (docs/scene.md, volume.generate).
struct GeneratorRequest {
    std::string name;  // "gaussians", "ramp", ...: docs/scene.md
    std::optional<std::array<std::int64_t, 3>>
        // Samples along x, y and z. Without a size a volume has 128^3 samples, and a ramp 256 x 4 x
        // 1.
        size;
    SampleType type = SampleType::uint8;  // or uint16, float32

    bool operator==(const GeneratorRequest&) const = default;
};

}  // namespace lamina
