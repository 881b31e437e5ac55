// SPDX-License-Identifier: Apache-2.0
// DICOM PS3.3, C.7.6.2 (image plane), C.7.6.16 (functional groups), C.8.4 (nuclear medicine),
// C.8.8.3 (RT dose), C.11.1 (rescale).
#include "volume_files/dicom_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

// Shares of the distance between slices: a slice may lie up to `mended_share` off their line, and
// up to `rounded_share` for the digits of headers; if a distance differs by more than `gap_share`
// from the usual one, slices are missing.
constexpr double mended_share = 5e-2, rounded_share = 2e-3, gap_share = .2;

// Notes what the first frame lacks: others lack it, too.
void note(DicomImage& image, const DicomFrame& frame, const std::string& words) {
    if (frame.index == 0) image.missing.push_back(words);
}

// Returns the numbers of an attribute that nuclear medicine has for each detector.
std::vector<double> place_numbers(const DicomElements& elements, DicomTag tag, std::size_t frame) {
    const auto found = elements.numbers(tag, frame);
    return found.empty() ? elements.numbers_in(dicom_tag::detectors, 0, tag) : found;
}

void set_orientation(const DicomElements& elements, DicomImage& image, DicomFrame& frame) {
    const auto at = static_cast<std::size_t>(frame.index);
    const auto v = place_numbers(elements, dicom_tag::orientation, at);
    const std::string text = elements.text(dicom_tag::orientation, at);
    if (v.empty() && text.empty())
        return note(image, frame, "ImageOrientationPatient (axial slices are taken)");
    const bool is_whole = v.size() == 6;
    const glm::dvec3 row = is_whole ? glm::dvec3(v[0], v[1], v[2]) : glm::dvec3(0),
                     column = is_whole ? glm::dvec3(v[3], v[4], v[5]) : glm::dvec3(0);
    if (!(std::abs(glm::length(row) - 1) < 1e-2 && std::abs(glm::length(column) - 1) < 1e-2 &&
          std::abs(glm::dot(row, column)) < 1e-2)) {
        fail(
            "{}: ImageOrientationPatient: found {}, expected two vectors of length 1 at a right "
            "angle",
            image.file.string(), text);
    }
    frame.along_row = glm::normalize(row);
    frame.along_column = glm::normalize(column);
}

// Returns the distances of rows and of columns in mm that those regions of an ultrasound image have
// in common whose units are cm along both (PS3.3, C.8.5.5): others are curves over time, such as of
// Doppler. Returns zeros if there is none, or if they differ.
std::pair<double, double> ultrasound_spacing(const DicomElements& elements) {
    constexpr double centimetres = 3;  // PhysicalUnitsXDirection and PhysicalUnitsYDirection
    const auto regions = elements.items.find(dicom_tag::regions);
    const std::size_t count = regions == elements.items.end() ? 0 : regions->second.size();
    std::optional<std::pair<double, double>> found;
    for (std::size_t i = 0; i < count; ++i) {
        const auto number = [&](DicomTag tag) {
            const auto numbers = elements.numbers_in(dicom_tag::regions, i, tag);
            return numbers.size() == 1 ? std::abs(numbers[0]) : 0;
        };
        if (number(dicom_tag::region_units_x) != centimetres ||
            number(dicom_tag::region_units_y) != centimetres)
            continue;
        const std::pair own{10 * number(dicom_tag::region_height),
                            10 * number(dicom_tag::region_width)};
        if (found && own != *found) return {};
        found = own;
    }
    return found.value_or(std::pair(0.0, 0.0));
}

void set_spacing(const DicomElements& elements, DicomImage& image, DicomFrame& frame) {
    constexpr std::pair<DicomTag, const char*> attributes[] = {
        {dicom_tag::pixel_spacing, "PixelSpacing"},
        {dicom_tag::imager_pixel_spacing, "ImagerPixelSpacing"},
        {dicom_tag::scanned_pixel_spacing, "NominalScannedPixelSpacing"}};
    for (const auto& [tag, name] : attributes) {
        const auto at = static_cast<std::size_t>(frame.index);
        const std::string text = elements.text(tag, at);
        if (text.empty()) continue;
        const auto spacing = elements.numbers(tag, at);  // of rows, then of columns
        if (!(spacing.size() == 2 && spacing[0] > 0 && spacing[1] > 0)) {
            fail("{}: {}: found {}, expected two numbers above 0", image.file.string(), name, text);
        }
        if (tag != dicom_tag::pixel_spacing)
            note(image, frame, fmt::format("PixelSpacing ({} is taken)", name));
        frame.row_spacing = spacing[0];
        frame.column_spacing = spacing[1];
        return;
    }
    if (const auto [height, width] = ultrasound_spacing(elements); width > 0 && height > 0) {
        note(image, frame,
             "PixelSpacing (PhysicalDeltaX and PhysicalDeltaY of its ultrasound regions are "
             "taken)");
        frame.row_spacing = height;
        frame.column_spacing = width;
        return;
    }
    image.has_spacing = false;
    const auto ratio = elements.numbers(dicom_tag::aspect_ratio);  // height, width
    const bool has_ratio = ratio.size() == 2 && ratio[0] > 0 && ratio[1] > 0;
    if (has_ratio) frame.row_spacing = ratio[0] / ratio[1];
    note(image, frame,
         fmt::format("PixelSpacing (1{}; \"spacing\" in the volume sets another)",
                     has_ratio ? " and PixelAspectRatio are taken" : " is taken"));
}

// Sets the scale of a frame's samples: that of a dose, else of the modality, else of the real
// world.
void set_scale(const DicomElements& elements, DicomImage& image, DicomFrame& frame) {
    const auto at = static_cast<std::size_t>(frame.index);
    const char* words = "RescaleSlope";
    auto slope = elements.number(dicom_tag::rescale_slope, at);
    auto intercept = elements.number(dicom_tag::rescale_intercept, at);
    if (const auto dose = elements.number(dicom_tag::dose_scale)) {
        words = "DoseGridScaling";
        slope = dose;
        intercept = 0;
    } else if (!slope && !intercept && image.lut.empty()) {
        const auto real_world = [&](DicomTag tag) {
            auto found = elements.numbers(tag, at);
            if (found.empty()) found = elements.numbers_in(dicom_tag::real_world_map, 0, tag);
            return found.size() == 1 ? std::optional(found[0]) : std::nullopt;
        };
        slope = real_world(dicom_tag::real_world_slope);
        intercept = real_world(dicom_tag::real_world_intercept);
        if (slope.value_or(1) != 1 || intercept.value_or(0) != 0)
            note(image, frame, "RescaleSlope (RealWorldValueSlope is taken)");
    }
    frame.slope = slope.value_or(1);
    frame.intercept = intercept.value_or(0);
    if (frame.slope == 0)
        fail("{}: {}: found 0, expected another number", image.file.string(), words);
}

// Sets the distance of an image's frames. Its sign says on which side of the first the others lie:
// PS3.3, C.8.4.15. `is_used`: the frames have no places of their own.
void set_frame_spacing(const DicomElements& elements, DicomImage& image, bool is_used) {
    const double between = elements.number(dicom_tag::slice_spacing).value_or(0);
    const double thickness = elements.number(dicom_tag::slice_thickness).value_or(0);
    image.frame_spacing = between != 0 ? between : thickness != 0 ? thickness : 1;
    image.spacing_words = between != 0     ? "SpacingBetweenSlices"
                          : thickness != 0 ? "SliceThickness"
                                           : "";
    if (is_used && between == 0) {
        image.missing.emplace_back(thickness != 0 ? "SpacingBetweenSlices (SliceThickness is taken)"
                                                  : "SpacingBetweenSlices (1 mm is taken)");
    }
}

DicomTag frame_pointer(const DicomElements& elements, std::size_t which) {
    const auto words = elements.numbers(dicom_tag::frame_pointer);
    if (words.size() < 2 * which + 2) return 0;
    return static_cast<DicomTag>(words[2 * which]) << 16 |
           static_cast<DicomTag>(words[2 * which + 1]);
}

// Tells if frames are counted by vectors of nuclear medicine, but not as slices: PS3.3, C.8.4.8.
bool has_views(const DicomElements& elements) {
    constexpr std::size_t most_vectors = 8;
    bool nuclear = false;
    for (std::size_t i = 0; i < most_vectors; ++i) {
        const DicomTag tag = frame_pointer(elements, i);
        if (tag == dicom_tag::slice_vector) return false;
        nuclear = nuclear || tag >> 16 == dicom_tag::slice_vector >> 16;
    }
    return nuclear;
}

// Places the frames of a dose: the offsets are relative to the first frame, along the normal, if
// the first one is 0; else they are z of axial frames (PS3.3, C.8.8.3.2).
void place_by_offsets(const DicomElements& elements, DicomImage& image) {
    const auto offsets = elements.numbers(dicom_tag::frame_offsets);
    const std::string name = image.file.string();
    image.place_words = "GridFrameOffsetVector";
    if (std::ssize(offsets) != image.frame_count) {
        fail("{}: GridFrameOffsetVector: found {} numbers, expected {}, one for each frame", name,
             offsets.size(), image.frame_count);
    }
    const DicomFrame& first = image.frames[0];
    const glm::dvec3 begin = *first.position;
    const glm::dvec3 normal = glm::cross(first.along_row, first.along_column);
    if (offsets[0] != 0) {
        constexpr double same_place = 1e-2;  // mm
        if (std::abs(normal.z) < 1 - 1e-6 || std::abs(offsets[0] - begin.z) > same_place) {
            fail(
                "{}: GridFrameOffsetVector: found {} as the first, expected 0, or for axial frames "
                "z of ImagePositionPatient, {}",
                name, offsets[0], begin.z);
        }
    }
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        image.frames[i].position = offsets[0] == 0 ? begin + normal * offsets[i]
                                                   : glm::dvec3(begin.x, begin.y, offsets[i]);
    }
}

// Places frames that lack positions of their own: by offsets, one at another's place if they are
// times, at their SliceLocationVector, else at equal distances from the first in their order or
// that of SliceVector.
void spread_frames(const DicomElements& elements, DicomImage& image) {
    if (!image.frames[0].position) {
        image.missing.emplace_back("ImagePositionPatient (0, 0, 0 is taken)");
        image.frames[0].position = glm::dvec3(0);
    }
    if (elements.find(dicom_tag::frame_offsets) != nullptr)
        return place_by_offsets(elements, image);
    const DicomFrame first = image.frames[0];
    const DicomTag pointer = frame_pointer(elements, 0);
    const bool times = pointer == dicom_tag::frame_time || pointer == dicom_tag::frame_time_vector;
    const auto slices = elements.numbers(dicom_tag::slice_vector);
    const auto locations = elements.numbers(dicom_tag::slice_locations);
    const bool has_locations = !times && std::ssize(locations) == image.frame_count;
    if (!times && !has_locations && !locations.empty())
        image.missing.push_back(fmt::format("SliceLocationVector with {} places ({} are not used)",
                                            image.frame_count, locations.size()));
    const glm::dvec3 normal = glm::cross(first.along_row, first.along_column);
    set_frame_spacing(elements, image, !times && !has_locations);
    image.place_words = has_locations ? "SliceLocationVector" : "SpacingBetweenSlices";
    const glm::dvec3 step = normal * (times ? 0 : image.frame_spacing);
    for (DicomFrame& frame : image.frames) {
        double place = static_cast<double>(frame.index);
        if (std::ssize(slices) == image.frame_count)
            place = slices[static_cast<std::size_t>(frame.index)] - 1;
        frame.position = *first.position + step * place;
        if (has_locations) {
            const double location = locations[static_cast<std::size_t>(frame.index)];
            frame.position = *first.position + normal * (location - locations[0]);
        }
    }
}

// Returns the distances between slices. Throws Error if one differs so much that slices are
// missing.
std::vector<double> even_distances(const std::vector<SlicePlace>& slices, const std::string& file,
                                   const char* words) {
    std::vector<double> distances;
    for (std::size_t i = 1; i < slices.size(); ++i)
        distances.push_back(glm::length(slices[i].position - slices[i - 1].position));
    std::vector<double> sorted = distances;
    std::ranges::sort(sorted);
    const double usual = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < distances.size(); ++i) {
        if (usual > 0 && std::abs(distances[i] - usual) <= gap_share * usual) continue;
        fail(
            "{}: {}: found {:.6g} mm between {} and {}, expected {:.6g} as between most: slices "
            "are missing or not equally spaced",
            file, words, distances[i], slices[i].name, slices[i + 1].name, usual);
    }
    return distances;
}

// Returns the line that has the least sum of squared distances from the slices' places to its own.
SliceLine nearest_line(const std::vector<SlicePlace>& slices) {
    const auto count = static_cast<double>(slices.size());
    const double middle = (count - 1) / 2;
    glm::dvec3 mean{0}, product{0};
    double squares = 0;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const double from_middle = static_cast<double>(i) - middle;
        mean += slices[i].position / count;
        product += from_middle * slices[i].position;
        squares += from_middle * from_middle;
    }
    const glm::dvec3 step = product / squares;
    return {mean - middle * step, step};
}

}  // namespace

std::pair<const SlicePlace*, double> SliceLine::worst(const std::vector<SlicePlace>& slices) const {
    std::pair<const SlicePlace*, double> found{slices.data(), 0};
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const double shift =
            glm::length(slices[i].position - first - static_cast<double>(i) * step);
        if (shift > found.second) found = {&slices[i], shift};
    }
    return found;
}

void place_frames(const DicomElements& elements, DicomImage& image) {
    const auto groups = elements.items.find(dicom_tag::frame_groups);
    const std::size_t found = groups == elements.items.end() ? 0 : groups->second.size();
    const auto count = static_cast<std::size_t>(image.frame_count);
    if (found != 0 && found != count) {
        fail(
            "{}: PerFrameFunctionalGroupsSequence: found {} items, expected {}, one for each frame",
            image.file.string(), found, count);
    }
    std::size_t placed = 0;  // frames with a position of their own
    image.frames.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        DicomFrame& frame = image.frames[i];
        frame.index = static_cast<std::int64_t>(i);
        set_orientation(elements, image, frame);
        set_spacing(elements, image, frame);
        set_scale(elements, image, frame);
        frame.phase = phase_of(elements, i, count);
        if (const auto v = place_numbers(elements, dicom_tag::position, i); v.size() == 3)
            frame.position = glm::dvec3(v[0], v[1], v[2]);
        if (elements.find_in(dicom_tag::frame_groups, i, dicom_tag::position) != nullptr) ++placed;
    }
    if (count > 1 && has_views(elements)) {
        image.refusal =
            "FrameIncrementPointer: found views of a gamma camera, expected slices (SliceVector)";
    }
    if (placed != 0 && placed != count) {
        fail("{}: ImagePositionPatient: found it for {} frames, expected it for all {}",
             image.file.string(), placed, count);
    }
    set_frame_spacing(elements, image, false);
    if (count > 1 && placed == 0) spread_frames(elements, image);
    cut_mosaic(elements, image);
}

void place_by_numbers(std::vector<DicomImage>& images, const std::string& name) {
    const auto is_single = [](const DicomImage& image) {
        return image.frames.size() == 1 && !image.frames[0].position;
    };
    if (images.size() < 2 || !std::ranges::all_of(images, is_single)) return;
    // Tells if all images have a number, and these differ.
    const auto tell_apart = [&](std::optional<double> DicomImage::*member) {
        std::vector<double> numbers;
        for (const DicomImage& image : images)
            if ((image.*member).has_value()) numbers.push_back(*(image.*member));
        std::ranges::sort(numbers);
        return numbers.size() == images.size() &&
               std::ranges::adjacent_find(numbers) == numbers.end();
    };
    const bool by_location = tell_apart(&DicomImage::location);
    if (!by_location && !tell_apart(&DicomImage::number)) return;
    const auto member = by_location ? &DicomImage::location : &DicomImage::number;
    std::vector<DicomImage*> sorted;
    for (DicomImage& image : images) sorted.push_back(&image);
    std::ranges::sort(sorted, {}, [&](const DicomImage* image) { return *(image->*member); });
    const double spacing = std::abs(images[0].frame_spacing);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        DicomFrame& frame = sorted[i]->frames[0];
        const double depth = by_location ? *(sorted[i]->*member) : static_cast<double>(i) * spacing;
        frame.position = depth * glm::cross(frame.along_row, frame.along_column);
        sorted[i]->place_words = by_location ? "SliceLocation" : "InstanceNumber";
    }
    if (by_location) {
        say("{}: found no ImagePositionPatient: slices lie at their SliceLocation", name);
        return;
    }
    const std::string words = images[0].spacing_words;
    say("{}: found no ImagePositionPatient: slices are taken in the order of "
        "InstanceNumber, {} mm apart ({}); \"spacing\" in the volume sets another",
        name, spacing, words.empty() ? "no file says it" : words);
    std::vector<std::int64_t> numbers;
    for (const DicomImage* image : sorted) numbers.push_back(std::llround(*image->number));
    if (const std::string gaps = gaps_of(numbers); !gaps.empty()) {
        say("{}: InstanceNumber: {} are missing: the slices beside a gap are "
            "neighbours here",
            name, gaps);
    }
}

SliceLine fitted_line(const std::vector<SlicePlace>& slices, const std::string& file,
                      const char* words) {
    const std::vector<double> distances = even_distances(slices, file, words);
    const auto steps = static_cast<double>(slices.size() - 1);
    SliceLine line{slices.front().position,
                   (slices.back().position - slices.front().position) / steps};
    if (line.worst(slices).second <= rounded_share * glm::length(line.step)) return line;
    line = nearest_line(slices);
    const auto [slice, shift] = line.worst(slices);
    const double distance = glm::length(line.step);
    if (!(shift <= mended_share * distance)) {
        fail("{}: {}: {} does not lie on a line with the others at equal distances", file, words,
             slice->name);
    }
    const auto [least, most] = std::ranges::minmax(distances);
    say("{}: {}: slices are {:.6g} to {:.6g} mm apart: they are placed {:.6g} mm apart on the "
        "straight line nearest to them, which moves them by up to {:.2g} mm",
        file, words, least, most, distance, shift);
    return line;
}

}  // namespace lamina
