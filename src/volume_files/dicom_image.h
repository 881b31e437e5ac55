// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/value_type.h"

namespace lamina {

// What the header of a DICOM image says, without its pixels. World axes are DICOM's: x to the
// patient's left, y to the back, z to the head; mm.
struct DicomImage {
    std::filesystem::path file;
    std::string series, description;  // SeriesInstanceUID, SeriesDescription
    std::int64_t instance = 0;        // InstanceNumber
    std::int64_t columns = 0, rows = 0, frames = 1;
    std::optional<glm::dvec3> position;                    // of the first pixel's centre
    glm::dvec3 along_row{1, 0, 0}, along_column{0, 1, 0};  // unit vectors
    glm::dvec3 spacing{1};  // between columns, rows and, of several frames, these
    double slope = 1, intercept = 0;
};

// Nothing where the file is no DICOM image. Throws Error where its header is damaged.
std::optional<DicomImage> read_dicom_header(const std::filesystem::path& file);

// The pixels of an image, decoded: columns x rows x frames of them, in native byte order. Throws
// Error.
class DicomPixels {
  public:
    explicit DicomPixels(const DicomImage& image);
    ~DicomPixels();
    DicomPixels(const DicomPixels&) = delete;
    DicomPixels& operator=(const DicomPixels&) = delete;

    ValueType type() const { return type_; }
    std::size_t byte_count() const { return bytes_; }
    void read(char* to) const;

  private:
    struct Reader;
    std::string name_;
    std::unique_ptr<Reader> reader_;
    ValueType type_ = ValueType::uint8;
    std::size_t bytes_ = 0;
};

}  // namespace lamina
