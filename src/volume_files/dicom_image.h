// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/value_type.h"
#include "volume_files/dicom_elements.h"

namespace lamina {

// A frame of an image: one slice. x points to the patient's left, y to the back, z to the head.
// Lengths are in mm.
struct DicomFrame {
    std::int64_t index = 0;                                // in the file, from 0 on
    std::int64_t first_column = 0, first_row = 0;          // of a tile in a mosaic
    std::optional<glm::dvec3> position;                    // the first pixel's centre
    glm::dvec3 along_row{1, 0, 0}, along_column{0, 1, 0};  // unit vectors
    double column_spacing = 1, row_spacing = 1;            // between columns, between rows
    double slope = 1, intercept = 0;                       // value = slope * sample + intercept
    std::vector<std::pair<std::size_t, double>> phase;     // phase_attributes that it has
};

// Upper bound on the bytes that one byte of compressed pixels decodes to. Headers that promise more
// are refused before memory is taken.
inline constexpr std::uint64_t most_dicom_expansion = 1 << 16;

// Describes a DICOM image, without its pixels.
struct DicomImage {
    std::filesystem::path file;
    std::string series, description, instance_uid;  // SeriesInstanceUID, SOPInstanceUID
    // Reason why the file is no volume, as messages say it; if it is set, the rest is not.
    std::string refusal;
    // Attributes that the file lacks, and what is taken instead: "PixelSpacing (1 is taken)".
    std::vector<std::string> missing;
    std::string inverse;  // attribute and value that say that the lowest value is white; or none
    const char* place_words = "ImagePositionPatient";  // attribute that gives the frames' places
    bool is_localizer = false, has_spacing = true;
    std::int64_t columns = 0, rows = 0, frame_count = 1;  // as the pixels lie in the file
    std::int64_t slice_columns = 0, slice_rows = 0;       // of each of `frames`
    std::vector<DicomFrame> frames;
    double frame_spacing = 1;                // of a single frame, in mm
    const char* spacing_words = "";          // attribute that gives it; empty: none does
    std::optional<double> number, location;  // InstanceNumber, SliceLocation

    // A pixel has the bits of `type`, of which the `stored_bits` bits up to bit `high_bit` hold its
    // value. `big_endian`: byte order of pixels of more than 8 bits. `swapped_bytes`: 8-bit pixels
    // lie in pairs in big-endian words (VR OW), the second pixel first.
    ValueType type = ValueType::uint8;
    std::int64_t stored_bits = 8, high_bit = 7;
    bool big_endian = false, swapped_bytes = false;
    std::string transfer_syntax;
    bool compressed = false;
    std::uint64_t pixels_begin = 0, pixel_bytes = 0;  // in the file, if not compressed
    // ModalityLUTSequence: the value of sample `lut_first` and of those after it.
    std::vector<std::uint16_t> lut;
    double lut_first = 0;
    std::optional<std::pair<double, double>> padding;  // samples from .. to are no data

    std::size_t frame_bytes() const {
        return static_cast<std::size_t>(columns * rows) * bytes_of(type);
    }
    std::size_t byte_count() const { return static_cast<std::size_t>(frame_count) * frame_bytes(); }
};

// Returns nothing if the file is no DICOM file. Throws Error if it is damaged.
std::optional<DicomImage> read_dicom_image(const std::filesystem::path& file);

// Reads the pixels of an image frame by frame. Throws Error.
class DicomPixels {
  public:
    // Decodes the frames of a compressed image, if it has several. `image` must outlive this.
    explicit DicomPixels(const DicomImage& image);
    // Writes frame_bytes() bytes in native byte order to `to`.
    void read(std::int64_t frame, char* to) const;

  private:
    const DicomImage& image_;
    std::string decoded_;
};

// Returns a hash of a frame's pixels as they lie in its file; nothing for compressed images with
// several frames, whose pixels count as different.
std::optional<std::uint64_t> pixel_hash(const DicomImage& image, const DicomFrame& frame);
// Tells if two frames that have hashes have the same pixels in their files.
bool same_pixels(const DicomImage& a, const DicomFrame& in_a, const DicomImage& b,
                 const DicomFrame& in_b);

}  // namespace lamina
