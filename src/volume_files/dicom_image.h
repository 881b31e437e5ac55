// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/value_type.h"

namespace lamina {

// Describes a DICOM image, without its pixels. x points to the patient's left, y to the back, z to
// the head. Lengths are in mm.
struct DicomImage {
    std::filesystem::path file;
    std::string series, description;  // SeriesInstanceUID, SeriesDescription
    std::int64_t instance = 0;        // InstanceNumber
    std::int64_t columns = 0, rows = 0, frames = 1;
    std::optional<glm::dvec3> position;       // the first pixel's centre
    std::vector<glm::dvec3> frame_positions;  // first pixel of each frame; may be empty
    glm::dvec3 along_row{1, 0, 0}, along_column{0, 1, 0};  // unit vectors
    glm::dvec3 spacing{1};                                 // between columns, rows and frames
    double slope = 1, intercept = 0;                       // RescaleSlope, RescaleIntercept

    // A pixel has the bits of `type`, of which the `stored_bits` bits up to bit `high_bit` hold its
    // value. `big_endian`: byte order of pixels of more than 8 bits. `swapped_bytes`: 8-bit pixels
    // lie in pairs in big-endian words (VR OW), the second pixel first.
    ValueType type = ValueType::uint8;
    std::int64_t stored_bits = 8, high_bit = 7;
    bool big_endian = false, swapped_bytes = false;
    std::string transfer_syntax;
    bool compressed = false;
    std::uint64_t pixels_begin = 0, pixel_bytes = 0;  // in the file, if not compressed

    std::size_t byte_count() const {
        return static_cast<std::size_t>(columns * rows * frames) * bytes_of(type);
    }
};

// Tells by its first bytes if a file is a DICOM file.
bool has_dicom_mark(const std::filesystem::path& file);

// Returns nothing if the file is no DICOM image. Throws Error if it is damaged or no volume.
std::optional<DicomImage> read_dicom_image(const std::filesystem::path& file);

// Writes byte_count() bytes of pixels in native byte order to `to`. Throws Error.
void read_dicom_pixels(const DicomImage& image, char* to);

}  // namespace lamina
