// SPDX-License-Identifier: Apache-2.0
#include "volume_files/dicom_series.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "base/client.h"
#include "base/error.h"
#include "volume_files/grid_check.h"
#include "volume_files/stored_axes.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;
using Images = std::vector<DicomImage>;

// Of a slice's place, of the distance between slices: scanners round positions to a few digits.
constexpr double place_tolerance = 1e-2;

std::map<std::string, Images> images_by_series(const Path& path) {
    std::vector<Path> files;
    if (!std::filesystem::is_directory(path)) {
        files.push_back(path);
    } else {
        for (const auto& entry : std::filesystem::directory_iterator(path)) {
            if (entry.is_regular_file()) files.push_back(entry.path());
        }
    }
    std::ranges::sort(files);
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
                        "tells another",
                        path.string(), fmt::join(list, ", "), described(largest->second)));
    }
    return std::move(largest->second);
}

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

double depth_of(const DicomImage& image, const glm::dvec3& normal) {
    return glm::dot(*image.position, normal);
}

// Sorts along the normal; of several images at each place those of one time are left.
void order(Images& images, const glm::dvec3& normal, const std::string& name,
           const VolumeRequest& request) {
    std::ranges::stable_sort(images, {}, &DicomImage::instance);
    std::ranges::stable_sort(images, {},
                             [&](const DicomImage& image) { return depth_of(image, normal); });
    constexpr double same_place = 1e-4;  // mm
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

// A place, and what to call it in messages.
struct SlicePlace {
    glm::dvec3 position;
    std::string name;
};

// From slice to slice; they must lie on a line at equal distances.
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

// Of the files, or of the frames of one.
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

// The slices of a tilted gantry are skewed.
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

}  // namespace

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
    grid.size = {first.columns, first.rows, slices > 1 ? slices : first.frames};
    // Nearly orthogonal vectors are made so: headers have few digits.
    grid.step = {first.along_row * first.spacing.x,
                 glm::cross(normal, first.along_row) * first.spacing.y,
                 normal * glm::dot(normal, step)};
    grid.origin = series.slices.front().position.value_or(glm::dvec3(0));
    grid.axes = WorldAxes::left_posterior_superior;
    for (std::size_t axis = 0; axis < 3; ++axis)
        grid.centering[axis] = grid.size[axis] > 1 ? Centering::node : Centering::cell;
    check_grid(series.name, grid, {"PixelSpacing", "ImagePositionPatient"});
    return series;
}

}  // namespace lamina
