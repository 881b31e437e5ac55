// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "volume_files/dicom_image.h"
#include "volume_files/isolated_process.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;
using Images = std::vector<DicomImage>;

// The images of one volume, from the first slice to the last, and its grid.
struct DicomSeries {
    std::string name;  // for messages
    std::vector<DicomImage> slices;
    Grid grid;
};

// Largest deviation of the distance between two slices from the usual distance, as a share of it; a
// slice may lie twice as far off the series' line. Scanners round positions to a few digits.
constexpr double place_tolerance = 1e-2;

// Returns the DICOM images of a file or folder by their SeriesInstanceUID. Warns of other files.
std::map<std::string, Images> images_by_series(const Path& path) {
    const std::vector<Path> files = files_of_dicom(path);
    std::map<std::string, Images> series;
    std::size_t others = 0;
    for (const Path& file : files) {
        check_interrupt();
        if (auto image = read_dicom_image(file)) {
            series[image->series].push_back(std::move(*image));
        } else {
            ++others;
        }
    }
    if (series.empty()) fail("{}: found no DICOM images in it", path.string());
    if (others > 0) {
        warn(fmt::format("{}: {} of {} files are no DICOM images, and not used", path.string(),
                         others, files.size()));
    }
    return series;
}

std::string described(const Images& images) {
    return fmt::format("\"{}\" ({} images)",
                       images[0].description.empty() ? images[0].series : images[0].description,
                       images.size());
}

// Returns the images of the series that request.array names, else those of the largest series.
Images chosen_series(const Path& path, const VolumeRequest& request) {
    std::map<std::string, Images> all = images_by_series(path);
    std::vector<std::string> list;
    for (const auto& [uid, images] : all) list.push_back(described(images));
    if (!request.array.empty()) {
        for (auto& [uid, images] : all) {
            if (uid == request.array || images[0].description == request.array)
                return std::move(images);
        }
        fail("{}: array: found \"{}\", expected one of the series {}", path.string(), request.array,
             fmt::join(list, ", "));
    }
    const auto largest =
        std::ranges::max_element(all, {}, [](const auto& entry) { return entry.second.size(); });
    if (all.size() > 1) {
        warn(
            fmt::format("{}: of the series {} the largest, {}, is drawn: \"array\" in the volume "
                        "names another",
                        path.string(), fmt::join(list, ", "), described(largest->second)));
    }
    return std::move(largest->second);
}

// Throws Error unless all images have one size, orientation and pixel spacing. Several images must
// also have positions, and one frame each.
void expect_alike(const Images& images) {
    const DicomImage& first = images.front();
    for (const DicomImage& image : images) {
        const std::string name = image.file.string();
        if (image.columns != first.columns || image.rows != first.rows) {
            fail("{}: found {} x {} pixels, expected {} x {}, as {} has", name, image.columns,
                 image.rows, first.columns, first.rows, first.file.filename().string());
        }
        const auto differ = [](const glm::dvec3& a, const glm::dvec3& b) {
            return glm::length(a - b) > 1e-3;
        };
        if (differ(image.along_row, first.along_row) ||
            differ(image.along_column, first.along_column)) {
            fail("{}: ImageOrientationPatient: found another than in {}, expected the same", name,
                 first.file.filename().string());
        }
        if (differ(image.spacing / first.spacing,
                   glm::dvec3(1, 1, image.spacing.z / first.spacing.z)))
            fail("{}: PixelSpacing: found {} x {}, expected {} x {}, as {} has", name,
                 image.spacing.x, image.spacing.y, first.spacing.x, first.spacing.y,
                 first.file.filename().string());
        if (images.size() == 1) return;
        if (!image.position) fail("{}: ImagePositionPatient: found none, expected one", name);
        if (image.frames != 1) {
            fail("{}: NumberOfFrames: found {}, expected 1 in a series of {} files", name,
                 image.frames, images.size());
        }
    }
}

// Returns the position of an image along the slices' normal, in mm.
double depth_of(const DicomImage& image, const glm::dvec3& normal) {
    return glm::dot(*image.position, normal);
}

// Sorts the images by depth along the normal. If several lie at each depth, they are times in the
// order of InstanceNumber, and only the image of the request's time is kept.
void order(Images& images, const glm::dvec3& normal, const std::string& name,
           const VolumeRequest& request) {
    std::ranges::stable_sort(images, {}, &DicomImage::instance);
    std::ranges::stable_sort(images, {},
                             [&](const DicomImage& image) { return depth_of(image, normal); });
    constexpr double same_place = 1e-4;  // mm; images that are nearer are at one place
    std::vector<Images> places;
    for (DicomImage& image : images) {
        const bool next = places.empty() ||
                          depth_of(image, normal) > depth_of(places.back()[0], normal) + same_place;
        if (next) places.emplace_back();
        places.back().push_back(std::move(image));
    }
    for (Images& place : places) {
        std::ranges::stable_sort(place, {}, &DicomImage::instance);
        if (place.size() == places[0].size()) continue;
        fail("{}: found {} images at the place of {}, and {} at that of {}, expected as many", name,
             place.size(), place[0].file.filename().string(), places[0].size(),
             places[0][0].file.filename().string());
    }
    const std::int64_t time =
        taken_of(name, "time", request.time, static_cast<std::int64_t>(places[0].size()));
    images.clear();
    for (Images& place : places) images.push_back(std::move(place[static_cast<std::size_t>(time)]));
}

struct SlicePlace {
    glm::dvec3 position;
    std::string name;
};

// Returns the step between slices. Throws Error unless they lie on a line at equal distances.
glm::dvec3 slice_step(const std::vector<SlicePlace>& slices, const std::string& name) {
    const std::size_t count = slices.size();
    std::vector<double> distances;
    for (std::size_t i = 1; i < count; ++i)
        distances.push_back(glm::length(slices[i].position - slices[i - 1].position));
    std::vector<double> sorted = distances;
    std::ranges::sort(sorted);
    const double usual = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < distances.size(); ++i) {
        if (usual > 0 && std::abs(distances[i] - usual) <= place_tolerance * usual) continue;
        fail(
            "{}: found {:.6g} mm between {} and {}, expected {:.6g} as between most: slices are "
            "missing or not equally spaced",
            name, distances[i], slices[i].name, slices[i + 1].name, usual);
    }
    const glm::dvec3 step =
        (slices.back().position - slices.front().position) / static_cast<double>(count - 1);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 place = slices.front().position + static_cast<double>(i) * step;
        if (glm::length(slices[i].position - place) > 2 * place_tolerance * usual)
            fail("{}: ImagePositionPatient: {} does not lie on a line with the others", name,
                 slices[i].name);
    }
    return step;
}

// Returns the places of the files, or of a single file's frames; none if frames lack positions.
std::vector<SlicePlace> places_of(const Images& images) {
    std::vector<SlicePlace> places;
    if (images.size() > 1) {
        for (const DicomImage& image : images)
            places.push_back({*image.position, image.file.filename().string()});
    } else if (images[0].frames == std::ssize(images[0].frame_positions)) {
        for (const glm::dvec3& position : images[0].frame_positions)
            places.push_back({position, fmt::format("frame {}", places.size() + 1)});
    }
    return places;
}

// Throws Error unless the step between slices is normal to them (it is not if a gantry is tilted).
void expect_straight(const glm::dvec3& step, const DicomImage& image, const std::string& name) {
    for (const glm::dvec3& axis : {image.along_row, image.along_column}) {
        const double cosine = glm::dot(axis, step) / glm::length(step);
        if (std::abs(cosine) <= 1e-3) continue;
        fail(
            "{}: the slices are shifted against each other by {:.3g} of their distance (a tilted "
            "gantry), expected none",
            name, cosine);
    }
}

// Finds the images that open_dicom() reads: chooses the series, checks that its images are alike,
// sorts them along the normal, and takes the step between slices from equally spaced positions.
DicomSeries read_dicom_series(const Path& path, const VolumeRequest& request) {
    DicomSeries series;
    series.name = path.string();
    series.slices = chosen_series(path, request);
    expect_alike(series.slices);
    const DicomImage first = series.slices.front();
    const glm::dvec3 normal = glm::normalize(glm::cross(first.along_row, first.along_column));
    glm::dvec3 step = normal * first.spacing.z;
    if (series.slices.size() > 1) {
        order(series.slices, normal, series.name, request);
    } else {
        taken_of(series.name, "time", request.time, 1);
    }
    if (const auto places = places_of(series.slices); places.size() > 1) {
        step = slice_step(places, series.name);
        expect_straight(step, first, series.name);
    }
    const auto slices = static_cast<std::int64_t>(series.slices.size());
    Grid& grid = series.grid;
    grid = plain_grid({first.columns, first.rows, slices > 1 ? slices : first.frames});
    // Nearly orthogonal vectors are made orthogonal: headers have few digits.
    grid.step = {first.along_row * first.spacing.x,
                 glm::cross(normal, first.along_row) * first.spacing.y,
                 normal * glm::dot(normal, step)};
    grid.origin = series.slices.front().position.value_or(glm::dvec3(0));
    grid.axes = WorldAxes::left_posterior_superior;
    check_grid(series.name, grid, {"PixelSpacing", "ImagePositionPatient"});
    return series;
}

// Throws Error if a compressed slice has more pixels than its file can hold, before taking memory.
void expect_pixels(const DicomSeries& series) {
    constexpr std::uint64_t most_expansion = 1 << 16;
    for (const DicomImage& slice : series.slices) {
        const std::uint64_t there = std::filesystem::file_size(slice.file);
        if (slice.compressed && slice.byte_count() / most_expansion > there) {
            fail("{}: the header promises {} bytes of pixels, the file has {} in all",
                 slice.file.string(), slice.byte_count(), there);
        }
    }
}

// Reads a slice to `to`, scaled to floats. Returns the end of the floats.
float* read_scaled(const DicomImage& slice, float* to) {
    std::string raw(slice.byte_count(), '\0');
    read_dicom_pixels(slice, raw.data());
    const std::size_t count = raw.size() / bytes_of(slice.type);
    for (const double value : values_from_bytes<double>(slice.type, raw.data(), count, false))
        *to++ = static_cast<float>(slice.slope * value + slice.intercept);
    return to;
}

// Reads the samples of a series. If slopes or intercepts differ, as in PET, scales each slice to
// floats. `line`: the line of the isolated process that reads compressed slices; else null.
StoredSamples read_slices(const DicomSeries& series, IsolatedLine* line = nullptr) {
    expect_pixels(series);
    const DicomImage& first = series.slices.front();
    StoredSamples samples{series.name, first.type, nullptr, first.slope, first.intercept};
    const bool scales_alike = std::ranges::all_of(series.slices, [&](const DicomImage& slice) {
        return slice.slope == first.slope && slice.intercept == first.intercept;
    });
    if (!scales_alike) samples = {series.name, ValueType::float32, nullptr};
    const auto& size = series.grid.size;
    const StoredAxis axes[] = {{size[0], {}}, {size[1], {}}, {size[2], {}}};
    const std::size_t bytes = stored_bytes(series.name, axes, bytes_of(samples.type));
    if (line != nullptr) line->allow_bytes(bytes);
    samples.bytes = line != nullptr ? line->shared_memory(bytes) : filled_memory(bytes);
    auto* to = static_cast<char*>(samples.bytes.get());
    for (const DicomImage& slice : series.slices) {
        check_interrupt();
        if (slice.type != first.type) {
            fail("{}: found {} pixels, expected {}, as the other slices have", slice.file.string(),
                 name_of(slice.type), name_of(first.type));
        }
        if (scales_alike) {
            read_dicom_pixels(slice, to);
            to += slice.byte_count();
        } else {
            to = reinterpret_cast<char*>(read_scaled(slice, reinterpret_cast<float*>(to)));
        }
    }
    return samples;
}

}  // namespace

bool is_dicom(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::is_regular_file(path, unreadable)) return has_dicom_mark(path);
    int left = 64;  // files of the folder that are looked at
    for (const auto& entry : std::filesystem::directory_iterator(path, unreadable)) {
        if (left-- == 0) break;
        if (entry.is_regular_file(unreadable) && has_dicom_mark(entry.path())) return true;
    }
    return false;
}

Volume open_dicom(const std::filesystem::path& path, const VolumeRequest& request,
                  const VolumeUse& /*use*/) {
    const DicomSeries series = read_dicom_series(path, request);
    const auto compressed = [](const DicomImage& slice) { return slice.compressed; };
    if (std::ranges::none_of(series.slices, compressed))
        return drawn_volume(series.grid, read_slices(series));
    const ReadSamples found = read_isolated(series.name, "GDCM", [&](IsolatedLine& line) {
        return ReadSamples{series.grid, read_slices(series, &line)};
    });
    return drawn_volume(series.grid, found.samples);
}

std::vector<std::filesystem::path> files_of_dicom(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace lamina
