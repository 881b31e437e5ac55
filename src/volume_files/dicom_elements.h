// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lamina {

// A data element's group and number: 0x00280010 is (0028,0010).
using DicomTag = std::uint32_t;

// What a DICOM file says, without its pixels.
struct DicomElements {
    std::string transfer_syntax;
    bool big_endian = false;    // of the data set, whose numbers are in that order
    bool encapsulated = false;  // the pixels are compressed
    // Values of the elements that are known to matter (dicom_elements.cpp). `shared`: of all frames
    // of a file with several.
    std::map<DicomTag, std::string> values, shared;
    std::vector<std::string> frame_positions;  // ImagePositionPatient of each frame
    std::uint64_t pixels_begin = 0;            // byte of the file
    std::uint64_t pixel_bytes = 0;             // 0 where they are encapsulated
    std::string pixel_form;                    // VR of the pixels: "OB", "OW"

    // The value, of the file or of all of its frames; empty where there is none.
    const std::string& text(DicomTag tag) const;
    std::vector<double> numbers(DicomTag tag) const;  // of a text; empty where it is anything else
    double number(DicomTag tag, double otherwise) const;
    std::int64_t whole(DicomTag tag) const;  // of two bytes; 0 where there is none
};

// The numbers of a text with backslashes between; empty where it is anything else.
std::vector<double> dicom_numbers(std::string_view text);

// Whether the file begins as DICOM files do.
bool has_dicom_mark(const std::filesystem::path& file);

// Reads the elements of a file up to its pixels. Throws Error where it is truncated or damaged.
DicomElements read_dicom_elements(const std::filesystem::path& file);

}  // namespace lamina
