// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "lamina/export.h"

namespace lamina {

// How the samples lie in a file without a header; x changes fastest.
struct RawLayout {
    std::array<std::int64_t, 3> size{1, 1, 1};  // samples along x, y and z
    // int8, uint8, int16, uint16, int32, uint32, int64, uint64, float or double
    std::string type = "uint8";
    std::int64_t offset = 0;  // bytes before the first sample
    bool big_endian = false;

    bool operator==(const RawLayout&) const = default;
};

// Which volume of a data file is wanted, where it holds several, and what the file itself does not
// say (docs/scene.md, "What is drawn"). Numbers count from 0.
struct LAMINA_API VolumeRequest {
    std::string array;  // its name; empty: the first
    // Of a pyramid, of the samples' components, of the steps in time. The first unless told; what
    // was taken is then said in a warning.
    std::optional<std::int64_t> level, channel, time;
    std::optional<glm::dvec3>
        spacing;                       // distances between samples, above 0, in place of the file's
    std::optional<glm::dvec3> origin;  // the first sample's place, in place of the file's
    std::optional<RawLayout> raw;      // the file has no header

    bool operator==(const VolumeRequest&) const = default;
};

}  // namespace lamina
