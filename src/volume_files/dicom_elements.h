// SPDX-License-Identifier: Apache-2.0
// The data elements of DICOM files: DICOM PS3.10, section 7 (the file); PS3.5, section 7 (the data
// set); PS3.6 (tags).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamina {

// A data element's group and number: 0x00280010 is (0028,0010).
using DicomTag = std::uint32_t;

namespace dicom_tag {
constexpr DicomTag media_class = 0x00020002, transfer_syntax = 0x00020010, image_type = 0x00080008,
                   sop_class = 0x00080016, sop_instance = 0x00080018, acquisition_time = 0x00080032,
                   series_description = 0x0008103e, slice_thickness = 0x00180050,
                   echo_time = 0x00180081, inversion_time = 0x00180082, echo_numbers = 0x00180086,
                   slice_spacing = 0x00180088, trigger_time = 0x00181060, frame_time = 0x00181063,
                   frame_time_vector = 0x00181065, imager_pixel_spacing = 0x00181164,
                   flip_angle = 0x00181314, slice_locations = 0x00182005,
                   scanned_pixel_spacing = 0x00182010, regions = 0x00186011,
                   region_units_x = 0x00186024, region_units_y = 0x00186026,
                   region_width = 0x0018602c, region_height = 0x0018602e,
                   frame_acquisition = 0x00189074, effective_echo_time = 0x00189082,
                   diffusion_b = 0x00189087, mosaic_images = 0x0019100a, mosaic_normal = 0x00191027,
                   series = 0x0020000e, acquisition_number = 0x00200012,
                   instance_number = 0x00200013, position = 0x00200032, orientation = 0x00200037,
                   temporal_identifier = 0x00200100, slice_location = 0x00201041,
                   temporal_index = 0x00209128, trigger_delay = 0x00209153,
                   frame_acquisition_number = 0x00209156, dimension_values = 0x00209157,
                   samples_per_pixel = 0x00280002, photometric = 0x00280004,
                   frame_count = 0x00280008, frame_pointer = 0x00280009, rows = 0x00280010,
                   columns = 0x00280011, pixel_spacing = 0x00280030, aspect_ratio = 0x00280034,
                   bits_allocated = 0x00280100, bits_stored = 0x00280101, high_bit = 0x00280102,
                   pixel_sign = 0x00280103, padding = 0x00280120, padding_limit = 0x00280121,
                   rescale_intercept = 0x00281052, rescale_slope = 0x00281053,
                   modality_lut = 0x00283000, lut_descriptor = 0x00283002, lut_data = 0x00283006,
                   csa_header = 0x00291010, real_world_map = 0x00409096,
                   real_world_intercept = 0x00409224, real_world_slope = 0x00409225,
                   energy_windows = 0x00540010, detectors = 0x00540022, time_slots = 0x00540070,
                   slice_vector = 0x00540080, lut_shape = 0x20500020, frame_offsets = 0x3004000c,
                   dose_scale = 0x3004000e, shared_groups = 0x52009229, frame_groups = 0x52009230,
                   float_pixels = 0x7fe00008, double_pixels = 0x7fe00009, pixels = 0x7fe00010;
}  // namespace dicom_tag

// The kept elements of a data set or of an item, of which the first one of a tag counts.
using DicomItem = std::vector<std::pair<DicomTag, std::string>>;

// The contents of a DICOM file, without its pixels.
struct DicomElements {
    std::string transfer_syntax;
    bool big_endian = false;                          // byte order of the data set
    bool encapsulated = false;                        // the pixels are compressed
    DicomTag pixel_tag = 0;                           // 0: the file has no pixels
    std::string pixel_form;                           // VR of the pixels: "OB", "OW"
    std::uint64_t pixels_begin = 0, pixel_bytes = 0;  // in the file; no bytes if encapsulated
    DicomItem values;                                 // outside of sequences
    // Items of the sequences outside of others that are kept. An item holds the elements of the
    // sequences inside it, too; those of private sequences are left out.
    std::map<DicomTag, std::vector<DicomItem>> items;

    // Returns an element of a frame: from its functional groups, else from those shared by all
    // frames, else from outside of sequences (PS3.3, C.7.6.16.1); null if there is none.
    const std::string* find(DicomTag tag, std::size_t frame = 0) const;
    const std::string* find_in(DicomTag sequence, std::size_t item, DicomTag tag) const;
    // Returns a text without blanks at its end, on one line; empty if there is none.
    std::string text(DicomTag tag, std::size_t frame = 0) const;
    // Return the numbers of an element; none if it is missing or holds anything else.
    std::vector<double> numbers(DicomTag tag, std::size_t frame = 0) const;
    std::vector<double> numbers_in(DicomTag sequence, std::size_t item, DicomTag tag) const;
    // Returns the number of a frame in a vector (VR US) that has one for each frame; else none.
    std::vector<double> number_of_frame(DicomTag tag, std::size_t frame, std::size_t frames) const;
    std::optional<double> number(DicomTag tag, std::size_t frame = 0) const;
    // Returns the whole number in an element of two bytes (VR US); 0 if the file lacks it.
    std::int64_t whole(DicomTag tag) const;

  private:
    std::vector<double> numbers_of(DicomTag tag, const std::string* value) const;
};

// Returns the numbers of a text, separated by backslashes; none if it holds anything else.
std::vector<double> dicom_numbers(std::string_view text);

// Tells by its first bytes if a file is a DICOM file: it has the mark "DICM", or begins, as some
// programs write it, with the elements of group 2 or, in a little-endian syntax, 8.
bool has_dicom_mark(const std::filesystem::path& file);

// Reads the elements of a file up to its pixels. Throws Error if it is truncated or damaged.
DicomElements read_dicom_elements(const std::filesystem::path& file);

}  // namespace lamina
