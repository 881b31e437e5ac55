// SPDX-License-Identifier: Apache-2.0
// DICOM PS3.3, C.7.6.2 (image plane), C.7.6.3 (image pixel), C.11.1 (rescale).
#include "volume_files/dicom_image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "volume_files/dicom_codec.h"
#include "volume_files/dicom_elements.h"
#include "volume_files/opened_file.h"

namespace lamina {
namespace {

constexpr DicomTag series_description = 0x0008103e, slice_thickness = 0x00180050,
                   slice_spacing = 0x00180088, series_uid = 0x0020000e,
                   instance_number = 0x00200013, image_position = 0x00200032,
                   image_orientation = 0x00200037, samples_per_pixel = 0x00280002,
                   frame_count = 0x00280008, row_count = 0x00280010, column_count = 0x00280011,
                   pixel_spacing = 0x00280030, bits_allocated = 0x00280100,
                   bits_stored = 0x00280101, highest_bit = 0x00280102, pixel_sign = 0x00280103,
                   rescale_intercept = 0x00281052, rescale_slope = 0x00281053;

std::optional<glm::dvec3> place_of(const std::vector<double>& numbers) {
    if (numbers.size() != 3) return {};
    return glm::dvec3(numbers[0], numbers[1], numbers[2]);
}

std::string trimmed(const std::string& text) {
    const std::size_t end = text.find_last_not_of(std::string(" \0", 2));
    return end == std::string::npos ? "" : one_line(text.substr(0, end + 1));
}

void read_place(const DicomElements& elements, DicomImage& image) {
    image.position = place_of(elements.numbers(image_position));
    for (const std::string& text : elements.frame_positions) {
        if (const auto place = place_of(dicom_numbers(text)))
            image.frame_positions.push_back(*place);
    }
    if (!image.position && !image.frame_positions.empty())
        image.position = image.frame_positions.front();
    if (const auto v = elements.numbers(image_orientation); v.size() == 6) {
        image.along_row = {v[0], v[1], v[2]};
        image.along_column = {v[3], v[4], v[5]};
    }
    const double row_length = glm::length(image.along_row),
                 column_length = glm::length(image.along_column),
                 cosine = glm::dot(image.along_row, image.along_column);
    if (!(std::abs(row_length - 1) < 1e-2 && std::abs(column_length - 1) < 1e-2 &&
          std::abs(cosine) < 1e-2)) {
        fail(
            "{}: ImageOrientationPatient: found {}, expected two vectors of length 1 at a right "
            "angle",
            image.file.string(), trimmed(elements.text(image_orientation)));
    }
    const auto spacing = elements.numbers(pixel_spacing);  // between rows, then between columns
    if (spacing.size() == 2) image.spacing = {spacing[1], spacing[0], 1};
    if (!(image.spacing.x > 0 && image.spacing.y > 0)) {
        fail("{}: PixelSpacing: found {}, expected numbers above 0", image.file.string(),
             trimmed(elements.text(pixel_spacing)));
    }
    const double thickness = elements.number(slice_thickness, 1);
    image.spacing.z = std::abs(elements.number(slice_spacing, thickness));
    if (image.spacing.z == 0) image.spacing.z = 1;
}

void read_form(const DicomElements& elements, DicomImage& image) {
    const std::string name = image.file.string();
    if (const auto samples = elements.whole(samples_per_pixel); samples > 1) {
        fail("{}: SamplesPerPixel: found {}, expected 1: pictures in colour are no volume", name,
             samples);
    }
    const std::int64_t allocated = elements.whole(bits_allocated);
    const bool is_signed = elements.whole(pixel_sign) == 1;
    if (allocated == 8) {
        image.type = is_signed ? ValueType::int8 : ValueType::uint8;
    } else if (allocated == 16) {
        image.type = is_signed ? ValueType::int16 : ValueType::uint16;
    } else if (allocated == 32) {
        image.type = is_signed ? ValueType::int32 : ValueType::uint32;
    } else {
        fail("{}: BitsAllocated: found {}, expected 8, 16 or 32", name, allocated);
    }
    image.stored_bits = elements.whole(bits_stored);
    image.high_bit = elements.whole(highest_bit);
    if (image.stored_bits < 1 || image.stored_bits > allocated || image.high_bit >= allocated ||
        image.high_bit + 1 < image.stored_bits) {
        fail("{}: BitsStored and HighBit: found {} and {}, expected them within {} bits", name,
             image.stored_bits, image.high_bit, allocated);
    }
    image.big_endian = elements.big_endian;
    image.swapped_bytes = elements.big_endian && allocated == 8 && elements.pixel_form == "OW";
    image.transfer_syntax = trimmed(elements.transfer_syntax);
    image.compressed = elements.encapsulated;
    image.pixels_begin = elements.pixels_begin;
    image.pixel_bytes = elements.pixel_bytes;
    const std::string& syntax = image.transfer_syntax;
    const bool plain = syntax == "1.2.840.10008.1.2" || syntax == "1.2.840.10008.1.2.1" ||
                       syntax == "1.2.840.10008.1.2.2";
    if (plain == image.compressed) {
        fail("{}: found pixels in {} piece with transfer syntax {}, expected {}", name,
             image.compressed ? "more than one" : "one", syntax, plain ? "one" : "several");
    }
    if (!image.compressed && image.pixel_bytes < image.byte_count()) {
        fail("{}: found {} bytes of pixels, expected {}", name, image.pixel_bytes,
             image.byte_count());
    }
}

// The bits that count, as a number: shifted down, and with their sign.
template <typename Value>
void take_bits(const DicomImage& image, char* pixels, std::size_t count) {
    using Word = std::make_unsigned_t<Value>;
    const auto bits = static_cast<int>(8 * sizeof(Value));
    const int above = bits - 1 - static_cast<int>(image.high_bit);
    const int unused = bits - static_cast<int>(image.stored_bits);
    for (std::size_t i = 0; i < count; ++i) {
        Word word;
        std::memcpy(&word, pixels + i * sizeof(Word), sizeof(Word));
        const auto high = static_cast<Value>(static_cast<Word>(word << above));
        const auto value = static_cast<Value>(high >> unused);
        std::memcpy(pixels + i * sizeof(Word), &value, sizeof(Value));
    }
}

void normalize(const DicomImage& image, char* pixels, std::size_t count) {
    const std::size_t bytes = bytes_of(image.type);
    const bool big = std::endian::native == std::endian::big;
    // Without threads, which a process of its own has none of (isolated_read.h).
    for (std::size_t i = 0; i < count && image.big_endian != big; ++i)
        std::reverse(pixels + i * bytes, pixels + (i + 1) * bytes);
    if (image.swapped_bytes) {
        for (std::size_t i = 0; i + 1 < count; i += 2) std::swap(pixels[i], pixels[i + 1]);
    }
    if (image.stored_bits == static_cast<std::int64_t>(8 * bytes)) return;
    with_type(image.type, [&](auto zero) {
        if constexpr (std::is_integral_v<decltype(zero)>)
            take_bits<decltype(zero)>(image, pixels, count);
    });
}

}  // namespace

std::optional<DicomImage> read_dicom_image(const std::filesystem::path& file) {
    if (!has_dicom_mark(file)) return {};
    const DicomElements elements = read_dicom_elements(file);
    DicomImage image;
    image.file = file;
    image.series = trimmed(elements.text(series_uid));
    image.description = trimmed(elements.text(series_description));
    image.rows = elements.whole(row_count);
    image.columns = elements.whole(column_count);
    if (image.rows == 0 || image.columns == 0)
        fail("{}: found {} x {} pixels, expected some", file.string(), image.columns, image.rows);
    const double number = elements.number(instance_number, 0);
    if (std::abs(number) < 1e15) image.instance = static_cast<std::int64_t>(number);
    const double frames = elements.number(frame_count, 1);
    if (!(frames >= 1 && frames <= (1 << 20)))
        fail("{}: NumberOfFrames: found {}, expected 1 to {}", file.string(), frames, 1 << 20);
    image.frames = static_cast<std::int64_t>(frames);
    image.slope = elements.number(rescale_slope, 1);
    image.intercept = elements.number(rescale_intercept, 0);
    if (image.slope == 0) fail("{}: RescaleSlope: found 0, expected another number", file.string());
    read_place(elements, image);
    read_form(elements, image);
    return image;
}

void read_dicom_pixels(const DicomImage& image, char* to) {
    if (image.compressed) return decode_dicom(image, to);
    const OpenedFile file = open_to_read(image.file, static_cast<std::int64_t>(image.pixels_begin));
    const std::size_t bytes = image.byte_count();
    const std::size_t found = std::fread(to, 1, bytes, file.get());
    if (found != bytes)
        fail("{}: found {} bytes of pixels, expected {}", image.file.string(), found, bytes);
    normalize(image, to, bytes / bytes_of(image.type));
}

}  // namespace lamina
