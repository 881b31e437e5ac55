// SPDX-License-Identifier: Apache-2.0
// DICOM PS3.3, C.7.6.2 (image plane), C.11.1 (rescale).
#include "volume_files/dicom_image.h"

#include <gdcmAttribute.h>
#include <gdcmImage.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>

#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "base/error.h"
#include "base/file_bytes.h"

namespace lamina {
namespace {

std::string text_in(const gdcm::DataSet& set, const gdcm::Tag& tag) {
    if (!set.FindDataElement(tag)) return "";
    const gdcm::ByteValue* const value = set.GetDataElement(tag).GetByteValue();
    if (value == nullptr) return "";
    std::string text(value->GetPointer(), value->GetLength());
    const std::size_t end = text.find_last_not_of(std::string(" \0", 2));
    return end == std::string::npos ? "" : text.substr(0, end + 1);
}

// The numbers of a text with backslashes between; empty where it is anything else.
std::vector<double> numbers_in(const gdcm::DataSet& set, const gdcm::Tag& tag) {
    const std::string text = text_in(set, tag);
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end) {
        while (at < end && (*at == ' ' || *at == '+')) ++at;
        double number = 0;
        const auto [stop, problem] = std::from_chars(at, end, number);
        if (problem != std::errc{} || !std::isfinite(number)) return {};
        numbers.push_back(number);
        at = stop;
        while (at < end && *at == ' ') ++at;
        if (at == end) break;
        if (*at++ != '\\') return {};
    }
    return numbers;
}

double number_in(const gdcm::DataSet& set, const gdcm::Tag& tag, double otherwise) {
    const auto numbers = numbers_in(set, tag);
    return numbers.size() == 1 ? numbers[0] : otherwise;
}

// An unsigned short.
std::int64_t short_in(const gdcm::DataSet& set, const gdcm::Tag& tag) {
    if (!set.FindDataElement(tag)) return 0;
    const gdcm::ByteValue* const value = set.GetDataElement(tag).GetByteValue();
    if (value == nullptr || value->GetLength() < sizeof(std::uint16_t)) return 0;
    std::uint16_t number = 0;
    std::memcpy(&number, value->GetPointer(), sizeof number);
    return number;
}

const gdcm::Tag series_uid(0x0020, 0x000e), series_description(0x0008, 0x103e),
    instance_number(0x0020, 0x0013), image_position(0x0020, 0x0032),
    image_orientation(0x0020, 0x0037), pixel_spacing(0x0028, 0x0030), row_count(0x0028, 0x0010),
    column_count(0x0028, 0x0011), frame_count(0x0028, 0x0008), rescale_intercept(0x0028, 0x1052),
    rescale_slope(0x0028, 0x1053), slice_thickness(0x0018, 0x0050), pixel_data(0x7fe0, 0x0010);

void read_orientation(const gdcm::DataSet& set, DicomImage& image) {
    const auto values = numbers_in(set, image_orientation);
    if (values.size() != 6) return;
    image.along_row = {values[0], values[1], values[2]};
    image.along_column = {values[3], values[4], values[5]};
    for (const glm::dvec3& unit : {image.along_row, image.along_column}) {
        if (!(std::abs(glm::length(unit) - 1) < 1e-2)) {
            fail("{}: ImageOrientationPatient: found {}, expected two vectors of length 1",
                 image.file.string(), one_line(text_in(set, image_orientation)));
        }
    }
}

void read_place(const gdcm::DataSet& set, DicomImage& image) {
    if (const auto place = numbers_in(set, image_position); place.size() == 3)
        image.position = glm::dvec3(place[0], place[1], place[2]);
    read_orientation(set, image);
    const auto spacing = numbers_in(set, pixel_spacing);  // between rows, then between columns
    if (spacing.size() == 2) image.spacing = {spacing[1], spacing[0], 1};
    image.spacing.z = std::abs(number_in(set, slice_thickness, 1));
    if (!(image.spacing.x > 0 && image.spacing.y > 0)) {
        fail("{}: PixelSpacing: found {}, expected numbers above 0", image.file.string(),
             one_line(text_in(set, pixel_spacing)));
    }
    if (!(image.spacing.z > 0)) image.spacing.z = 1;
}

std::optional<ValueType> type_of(const gdcm::PixelFormat& format) {
    switch (format.GetScalarType()) {
        case gdcm::PixelFormat::UINT8:
            return ValueType::uint8;
        case gdcm::PixelFormat::INT8:
            return ValueType::int8;
        case gdcm::PixelFormat::UINT16:
            return ValueType::uint16;
        case gdcm::PixelFormat::INT16:
            return ValueType::int16;
        case gdcm::PixelFormat::UINT32:
            return ValueType::uint32;
        case gdcm::PixelFormat::INT32:
            return ValueType::int32;
        case gdcm::PixelFormat::FLOAT32:
            return ValueType::float32;
        case gdcm::PixelFormat::FLOAT64:
            return ValueType::float64;
        default:
            return {};
    }
}

}  // namespace

std::optional<DicomImage> read_dicom_header(const std::filesystem::path& file) {
    if (file_beginning(file, 132).find("DICM", 128) != 128) return {};
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    if (!reader.ReadUpToTag(pixel_data))
        fail("{}: truncated or damaged DICOM header", file.string());
    const gdcm::DataSet& set = reader.GetFile().GetDataSet();
    DicomImage image;
    image.file = file;
    image.series = text_in(set, series_uid);
    image.rows = short_in(set, row_count);
    image.columns = short_in(set, column_count);
    if (image.series.empty() || image.rows == 0 || image.columns == 0) return {};  // a DICOMDIR
    image.description = one_line(text_in(set, series_description));
    image.instance = static_cast<std::int64_t>(number_in(set, instance_number, 0));
    image.frames = static_cast<std::int64_t>(number_in(set, frame_count, 1));
    if (image.frames < 1 || image.frames > (1 << 20))
        fail("{}: NumberOfFrames: found {}", file.string(), image.frames);
    image.slope = number_in(set, rescale_slope, 1);
    image.intercept = number_in(set, rescale_intercept, 0);
    if (image.slope == 0) fail("{}: RescaleSlope: found 0, expected another number", file.string());
    read_place(set, image);
    return image;
}

struct DicomPixels::Reader {
    gdcm::ImageReader reader;
};

DicomPixels::DicomPixels(const DicomImage& image)
    : name_(image.file.string()), reader_(std::make_unique<Reader>()) {
    constexpr std::uint64_t most_expansion = 1 << 16;
    reader_->reader.SetFileName(image.file.c_str());
    if (!reader_->reader.Read()) fail("{}: truncated or damaged DICOM image", name_);
    const gdcm::Image& decoded = reader_->reader.GetImage();
    const gdcm::PixelFormat& format = decoded.GetPixelFormat();
    if (format.GetSamplesPerPixel() != 1) {
        fail("{}: SamplesPerPixel: found {}, expected 1: pictures in colour are no volume", name_,
             format.GetSamplesPerPixel());
    }
    const auto type = type_of(format);
    if (!type) {
        fail("{}: found pixels of type {}, expected 8, 16 or 32 bits", name_,
             format.GetScalarTypeAsString());
    }
    type_ = *type;
    const unsigned* const sizes = decoded.GetDimensions();
    const std::int64_t frames = decoded.GetNumberOfDimensions() > 2 ? sizes[2] : 1;
    if (sizes[0] != image.columns || sizes[1] != image.rows || frames != image.frames) {
        fail("{}: found {} x {} x {} pixels, expected {} x {} x {}", name_, sizes[0], sizes[1],
             frames, image.columns, image.rows, image.frames);
    }
    bytes_ = static_cast<std::size_t>(image.columns * image.rows * image.frames) * bytes_of(type_);
    const std::uint64_t there = std::filesystem::file_size(image.file);
    if (bytes_ / most_expansion > there || decoded.GetBufferLength() != bytes_) {
        fail("{}: the header promises {} bytes of pixels, the file has {} in all", name_, bytes_,
             there);
    }
}

DicomPixels::~DicomPixels() = default;

void DicomPixels::read(char* to) const {
    if (!reader_->reader.GetImage().GetBuffer(to)) fail("{}: damaged pixels", name_);
}

}  // namespace lamina
