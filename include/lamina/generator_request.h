// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "lamina/volume.h"

namespace lamina {

// Asks for a volume that is made by a formula (docs/scene.md, volume.generate).
struct GeneratorRequest {
    std::string name;  // "gaussians", "ramp", ...: docs/scene.md
    // Samples along x, y and z. Without a size a volume has 128^3 samples, and a ramp 256 x 4 x 1.
    std::optional<std::array<std::int64_t, 3>> size;
    SampleType type = SampleType::uint8;  // or uint16, float32

    bool operator==(const GeneratorRequest&) const = default;
};

}  // namespace lamina
