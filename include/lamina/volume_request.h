// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "lamina/export.h"

namespace lamina {

// Layout of the samples in a file without a header; x changes fastest.
struct RawLayout {
    std::array<std::int64_t, 3> size{1, 1, 1};  // samples along x, y and z
    // int8, uint8, int16, uint16, int32, uint32, int64, uint64, float or double
    std::string type = "uint8";
    std::int64_t offset = 0;  // bytes before the first sample
    bool big_endian = false;

    bool operator==(const RawLayout&) const = default;
};

// Selects a volume of a data file that holds several, and gives what the file itself does not say
// (docs/scene.md, "What is drawn"). Numbers count from 0.
struct LAMINA_API VolumeRequest {
    std::string array;  // name of the array; empty for the first
    // Level of a pyramid, component of the samples, step in time. The first is taken unless one is
    // given, and a warning says so.
    std::optional<std::int64_t> level, channel, time;
    // Distances between samples, above 0, and place of the first one, instead of the file's.
    std::optional<glm::dvec3> spacing;
    std::optional<glm::dvec3> origin;
    std::optional<RawLayout> raw;  // given if the file has no header

    bool operator==(const VolumeRequest&) const = default;
};

}  // namespace lamina
