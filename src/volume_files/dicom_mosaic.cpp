// SPDX-License-Identifier: Apache-2.0
// The CSA header is not published by Siemens; nibabel describes it
// (https://nipy.org/nibabel/dicom/siemens_csa.html), and the places of a mosaic's slices
// (https://nipy.org/nibabel/dicom/dicom_mosaic.html).
#include "volume_files/dicom_places.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <string_view>

#include "base/error.h"
#include "volume_files/byte_readers.h"

namespace lamina {
namespace {

// Reads a CSA header: little-endian tags, each a name and items of text.
class CsaReader {
  public:
    CsaReader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

    // Returns the numbers of the tag `name`; none if there is no such tag.
    std::vector<double> numbers(std::string_view name) {
        at_ = 0;
        const bool second_form = bytes_.starts_with("SV10");
        if (second_form) take(8);
        const std::int64_t tags = word();
        take(4);
        std::int64_t length_shift = 0;  // that the first form adds to the lengths of items: the
                                        // number of the first tag's items
        for (std::int64_t tag = 0; tag < tags; ++tag) {
            const std::string_view found = text(take(64));
            take(12);  // multiplicity, VR, and SyngoDT
            const std::int64_t items = word();
            take(4);
            if (length_shift == 0) length_shift = items;
            std::vector<double> values;
            for (std::int64_t item = 0; item < items; ++item) {
                const std::int64_t first = word(), second = word();
                take(8);
                std::int64_t length = second_form ? second : first - length_shift;
                if (!second_form && (length < 0 || length > left())) break;
                const auto number = dicom_numbers(text(take(length)));
                take(std::min((4 - length % 4) % 4, left()));
                if (number.size() == 1) values.push_back(number[0]);
            }
            if (found == name) return values;
        }
        return {};
    }

  private:
    std::int64_t left() const { return std::ssize(bytes_) - at_; }

    std::string_view take(std::int64_t count) {
        if (count < 0 || count > left())
            fail("{}: CSA header (0029,1010): truncated or damaged", file_);
        at_ += count;
        return bytes_.substr(static_cast<std::size_t>(at_ - count),
                             static_cast<std::size_t>(count));
    }

    std::int64_t word() { return static_cast<std::int32_t>(number_of_bytes(take(4), false)); }

    // Returns a text up to its first zero byte.
    static std::string_view text(std::string_view bytes) {
        return bytes.substr(0, bytes.find('\0'));
    }

    const std::string& file_;
    std::string_view bytes_;
    std::int64_t at_ = 0;
};

bool is_mosaic(const DicomElements& elements) {
    const std::string types = '\\' + elements.text(dicom_tag::image_type) + '\\';
    return types.find("\\MOSAIC\\") != std::string::npos;
}

}  // namespace

void cut_mosaic(const DicomElements& elements, DicomImage& image) {
    if (!is_mosaic(elements) || image.frame_count != 1) return;
    const std::string name = image.file.string();
    std::vector<double> count = elements.numbers(dicom_tag::mosaic_images),
                        direction = elements.numbers(dicom_tag::mosaic_normal);
    if (const std::string* const header = elements.find(dicom_tag::csa_header)) {
        CsaReader csa(name, *header);
        count = csa.numbers("NumberOfImagesInMosaic");
        direction = csa.numbers("SliceNormalVector");
    }
    if (count.size() != 1 || direction.size() != 3) {
        image.refusal =
            "ImageType: found MOSAIC, slices as tiles of one image: expected a CSA "
            "header (0029,1010) with NumberOfImagesInMosaic and SliceNormalVector";
        return;
    }
    constexpr double most_tiles = 256 * 256;
    const auto edge =
        static_cast<std::int64_t>(std::ceil(std::sqrt(std::clamp(count[0], 1.0, most_tiles))));
    if (!(count[0] >= 1 && count[0] <= most_tiles) || image.columns % edge != 0 ||
        image.rows % edge != 0) {
        fail("{}: NumberOfImagesInMosaic: found {}, expected a number of tiles of {} x {} pixels",
             name, count[0], image.columns, image.rows);
    }
    if (!elements.number(dicom_tag::slice_spacing))
        image.missing.emplace_back("SpacingBetweenSlices (SliceThickness is taken)");
    DicomFrame tile = image.frames[0];
    const glm::dvec3 normal{direction[0], direction[1], direction[2]};
    const glm::dvec3 across = glm::cross(tile.along_row, tile.along_column);
    if (!(std::abs(std::abs(glm::dot(normal, across)) - 1) < 1e-2)) {
        fail("{}: SliceNormalVector: found {} {} {}, expected the normal of the image, {} {} {}",
             name, normal.x, normal.y, normal.z, across.x, across.y, across.z);
    }
    image.slice_columns = image.columns / edge;
    image.slice_rows = image.rows / edge;
    // ImagePositionPatient is the corner of an image as large as the mosaic around the first slice.
    const glm::dvec3 first =
        tile.position.value_or(glm::dvec3(0)) +
        tile.along_row *
            (tile.column_spacing * static_cast<double>(image.columns - image.slice_columns) / 2) +
        tile.along_column *
            (tile.row_spacing * static_cast<double>(image.rows - image.slice_rows) / 2);
    const glm::dvec3 step =
        across * (std::copysign(1, glm::dot(normal, across)) * std::abs(image.frame_spacing));
    image.frames.clear();
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(count[0]); ++i) {
        tile.first_column = i % edge * image.slice_columns;
        tile.first_row = i / edge * image.slice_rows;
        tile.position = first + static_cast<double>(i) * step;
        image.frames.push_back(tile);
    }
}

}  // namespace lamina
