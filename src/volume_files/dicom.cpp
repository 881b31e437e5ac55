// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <new>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "volume_files/dicom_image.h"
#include "volume_files/dicom_places.h"
#include "volume_files/isolated_process.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;
using Images = std::vector<DicomImage>;
using Slices = std::vector<DicomSlice>;

// The slices of one volume, from the first to the last, and its grid.
struct DicomSeries {
    std::string name;  // for messages
    Images images;
    Slices slices;  // of `images`
    Grid grid;
};

// Returns the names of up to three slices.
std::string some_names(const Slices& slices) {
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(slices.size(), 3); ++i)
        names += (i == 0 ? "" : ", ") + slices[i].name();
    return names + (slices.size() > 3 ? ", ..." : "");
}

// Returns the DICOM images of a file or folder by their SeriesInstanceUID. Says which files are
// not used.
std::map<std::string, Images> images_by_series(const Path& path) {
    const std::vector<Path> files = files_of_dicom(path);
    std::map<std::string, Images> series;
    Images refused;
    std::size_t others = 0;
    for (const Path& file : files) {
        check_interrupt();
        auto image = read_dicom_image(file);
        if (!image) {
            ++others;
        } else if (image->refusal.empty()) {
            series[image->series].push_back(std::move(*image));
        } else {
            refused.push_back(std::move(*image));
        }
    }
    if (series.empty() && !refused.empty())
        fail("{}: {}", refused[0].file.string(), refused[0].refusal);
    if (series.empty()) {
        fail("{}: found no DICOM images in it", path.string());
    }
    if (others > 0) {
        say("{}: {} of {} files are no DICOM images, and not used", path.string(), others,
            files.size());
    }
    if (!refused.empty()) {
        say("{}: {} of {} files are set aside: {}: {}", path.string(), refused.size(), files.size(),
            refused[0].file.filename().string(), refused[0].refusal);
    }
    return series;
}

std::size_t slices_in(const Images& images) {
    std::size_t count = 0;
    for (const DicomImage& image : images) count += image.frames.size();
    return count;
}

std::string described(const Images& images) {
    return fmt::format("\"{}\" ({} images)",
                       images[0].description.empty() ? images[0].series : images[0].description,
                       slices_in(images));
}

// Returns the images of the series that request.array names, else those of the largest series.
Images chosen_series(const Path& path, const VolumeRequest& request, VolumeContents* contents) {
    std::map<std::string, Images> all = images_by_series(path);
    std::vector<std::string> list;
    for (const auto& [uid, images] : all) {
        list.push_back(described(images));
        if (contents != nullptr)
            contents->arrays.push_back(images[0].description.empty() ? uid : images[0].description);
    }
    if (!request.array.empty()) {
        Images* found = nullptr;
        for (auto& [uid, images] : all) {
            if (uid == request.array) return std::move(images);
            if (images[0].description != request.array) continue;
            if (found != nullptr) {
                fail(
                    "{}: array: found \"{}\", the name of several series, expected a UID: {} or {}",
                    path.string(), request.array, found->front().series, uid);
            }
            found = &images;
        }
        if (found != nullptr) return std::move(*found);
        fail("{}: array: found \"{}\", expected one of the series {}", path.string(), request.array,
             fmt::join(list, ", "));
    }
    const auto largest = std::ranges::max_element(
        all, {}, [](const auto& entry) { return slices_in(entry.second); });
    if (all.size() > 1) {
        say("{}: of the series {} the largest, {}, is drawn: {}", path.string(),
            fmt::join(list, ", "), described(largest->second), names_another("array", "NAME"));
    }
    return std::move(largest->second);
}

// Removes images with the SOPInstanceUID and place of an earlier one: copies of its file.
void remove_copies(Images& images, const std::string& name) {
    std::map<std::string, std::optional<glm::dvec3>> places;
    const std::size_t count = images.size();
    std::erase_if(images, [&](const DicomImage& image) {
        const auto& place = image.frames[0].position;
        const auto [earlier, is_new] = places.emplace(image.instance_uid, place);
        return !is_new && !image.instance_uid.empty() && earlier->second == place;
    });
    if (images.size() < count) {
        say("{}: {} of {} files are copies of others, with the same SOPInstanceUID, "
            "and not used",
            name, count - images.size(), count);
    }
}

bool differ(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b) > 1e-3;
}

bool differ_in_orientation(const DicomSlice& a, const DicomSlice& b) {
    return differ(a.frame->along_row, b.frame->along_row) ||
           differ(a.frame->along_column, b.frame->along_column);
}

// Returns the slices of most images, without localizers and, if at least three slices remain, so
// that their distances can be checked, without those that few others have the orientation of.
Slices without_localizers(const Images& images, const std::string& name) {
    constexpr std::size_t most_orientations = 64, least_slices = 3;
    std::vector<Slices> groups;  // by orientation
    Slices localizers;
    for (const DicomImage& image : images) {
        for (const DicomFrame& frame : image.frames) {
            const DicomSlice slice{&image, &frame};
            if (image.is_localizer) {
                localizers.push_back(slice);
                continue;
            }
            auto group = std::ranges::find_if(groups, [&](const Slices& other) {
                return !differ_in_orientation(slice, other[0]);
            });
            if (group == groups.end()) group = groups.insert(groups.end(), Slices{});
            group->push_back(slice);
            if (groups.size() > most_orientations)
                fail("{}: ImageOrientationPatient: found more than {} orientations, expected one",
                     name, most_orientations);
        }
    }
    if (groups.empty()) groups.push_back(std::exchange(localizers, {}));
    std::ranges::stable_sort(groups, std::greater{}, &Slices::size);
    Slices kept = std::move(groups[0]);
    for (auto group = groups.begin() + 1; group != groups.end(); ++group) {
        if (kept.size() < least_slices || group->size() == kept.size()) {
            fail("{}: ImageOrientationPatient: found another than in {}, expected the same",
                 (*group)[0].image->file.string(), kept[0].name());
        }
        localizers.insert(localizers.end(), group->begin(), group->end());
    }
    if (!localizers.empty()) {
        say("{}: set aside {} of {} slices, localizers or of another "
            "ImageOrientationPatient: {}",
            name, localizers.size(), localizers.size() + kept.size(), some_names(localizers));
    }
    return kept;
}

// Throws Error unless all slices have one size and pixel spacing and, if several, positions.
void expect_alike(const Slices& slices) {
    const auto& [first, first_frame] = slices.front();
    for (const auto& [image, frame] : slices) {
        const std::string name = image->file.string();
        if (image->slice_columns != first->slice_columns ||
            image->slice_rows != first->slice_rows) {
            fail("{}: found {} x {} pixels, expected {} x {}, as {} has", name,
                 image->slice_columns, image->slice_rows, first->slice_columns, first->slice_rows,
                 first->file.filename().string());
        }
        if (std::abs(frame->column_spacing / first_frame->column_spacing - 1) > 1e-3 ||
            std::abs(frame->row_spacing / first_frame->row_spacing - 1) > 1e-3) {
            fail("{}: PixelSpacing: found {} x {}, expected {} x {}, as {} has", name,
                 frame->column_spacing, frame->row_spacing, first_frame->column_spacing,
                 first_frame->row_spacing, first->file.filename().string());
        }
        if (slices.size() > 1 && !frame->position)
            fail(
                "{}: ImagePositionPatient: found none, expected one in each file, or in none and "
                "SliceLocation or InstanceNumber, which tell slices apart",
                name);
    }
}

// Returns the slices at each place along the normal, from the lowest to the highest.
std::vector<Slices> by_place(const Slices& slices, const glm::dvec3& normal) {
    std::vector<std::pair<double, DicomSlice>> sorted;  // with their depths in mm
    for (const DicomSlice& slice : slices) {
        const double depth = glm::dot(slice.frame->position.value_or(glm::dvec3(0)), normal);
        if (!std::isfinite(depth)) {
            fail("{}: {}: found a place that is too far away", slice.image->file.string(),
                 slice.image->place_words);
        }
        sorted.emplace_back(depth, slice);
    }
    std::ranges::stable_sort(sorted, {}, [](const auto& entry) { return entry.first; });
    // Places of two phases may differ by what headers' digits, or a scanner's table, explain.
    const double same_place = std::max(1e-4, 1e-2 * (sorted.back().first - sorted.front().first) /
                                                 static_cast<double>(sorted.size()));
    std::vector<Slices> places;
    double depth = 0;  // of the last place
    for (const auto& [slice_depth, slice] : sorted) {
        if (places.empty() || slice_depth > depth + same_place) {
            places.emplace_back();
            depth = slice_depth;
        }
        places.back().push_back(slice);
    }
    return places;
}

// Throws Error unless the step between slices is normal to them (it is not if a gantry is tilted).
void expect_straight(const glm::dvec3& step, const DicomFrame& frame, const std::string& name) {
    constexpr double mended = 1.75e-3;  // cosine: .1 degree from a right angle, as check_grid() has
    for (const glm::dvec3& axis : {frame.along_row, frame.along_column}) {
        const double cosine = glm::dot(axis, step) / glm::length(step);
        if (std::abs(cosine) <= mended) continue;
        fail(
            "{}: the slices are shifted against each other by {:.3g} of their distance (a tilted "
            "gantry), expected none: dcm2niix writes them to NIfTI without the tilt",
            name, cosine);
    }
}

// Sets the grid of sorted slices; says what the file does not tell and what is taken instead, and
// that shades are not used.
void set_grid(DicomSeries& series) {
    const auto& [image, frame] = series.slices.front();
    std::vector<std::string> missing = image->missing;
    if (!frame->position) missing.emplace_back("ImagePositionPatient (0, 0, 0 is taken)");
    if (!missing.empty()) say("{}: found no {}", series.name, fmt::join(missing, ", no "));
    if (!image->inverse.empty()) {
        say("{}: it says that its lowest value is white ({}): values are as they are "
            "stored",
            series.name, image->inverse);
    }
    SliceLine line{
        frame->position.value_or(glm::dvec3(0)),
        glm::cross(frame->along_row, frame->along_column) * std::abs(image->frame_spacing)};
    if (series.slices.size() > 1) {
        std::vector<SlicePlace> places;
        for (const DicomSlice& slice : series.slices)
            places.push_back({*slice.frame->position, slice.name()});
        line = fitted_line(places, series.name, image->place_words);
        expect_straight(line.step, *frame, series.name);
    }
    Grid& grid = series.grid;
    grid = plain_grid({image->slice_columns, image->slice_rows, std::ssize(series.slices)});
    grid.step = {frame->along_row * frame->column_spacing, frame->along_column * frame->row_spacing,
                 line.step};
    grid.origin = line.first;
    grid.axes = WorldAxes::left_posterior_superior;
    if (image->has_spacing) grid.unit = "mm";
    check_grid(series.name, grid, {"ImageOrientationPatient", "ImagePositionPatient"});
}

// Finds the slices that open_dicom() reads: chooses the series, checks that its images are alike,
// sorts them along the normal, and takes those of one time.
DicomSeries read_dicom_series(const Path& path, const VolumeRequest& request,
                              VolumeContents* contents) {
    DicomSeries series;
    series.name = path.string();
    series.images = chosen_series(path, request, contents);
    remove_copies(series.images, series.name);
    place_by_numbers(series.images, series.name);
    const Slices slices = without_localizers(series.images, series.name);
    expect_alike(slices);
    const DicomFrame& first = *slices[0].frame;
    series.slices =
        slices_of_time(by_place(slices, glm::cross(first.along_row, first.along_column)),
                       series.name, request, contents);
    set_grid(series);
    return series;
}

// Throws Error if a compressed image has more pixels than its file can hold, before taking memory.
void expect_pixels(const DicomSeries& series) {
    for (const DicomImage& image : series.images) {
        const std::uint64_t there = std::filesystem::file_size(image.file);
        if (image.compressed && image.byte_count() / most_dicom_expansion > there) {
            fail("{}: the header promises {} bytes of pixels, the file has {} in all",
                 image.file.string(), image.byte_count(), there);
        }
    }
}

// Reads the samples of a series. If slopes or intercepts differ, as in PET, or if images have
// tables of values, scales each slice to floats.
class SliceReader {
  public:
    explicit SliceReader(const DicomSeries& series)
        : series_(series), first_(*series.slices[0].image) {
        expect_pixels(series);
        const DicomFrame& frame = *series.slices[0].frame;
        samples_ = {series.name, first_.type, nullptr, frame.slope, frame.intercept};
        is_scaled_ = std::ranges::any_of(series.slices, [&](const DicomSlice& slice) {
            return !slice.image->lut.empty() || slice.frame->slope != frame.slope ||
                   slice.frame->intercept != frame.intercept;
        });
        if (is_scaled_) samples_ = {series.name, ValueType::float32, nullptr};
        const auto& size = series.grid.size;
        const StoredAxis axes[] = {{size[0], {}}, {size[1], {}}, {size[2], {}}};
        bytes_ = stored_bytes(series.name, axes, bytes_of(samples_.type));
        slice_values_ = static_cast<std::size_t>(size[0] * size[1]);
    }

    // Reads uncompressed slices here, others in an isolated process.
    StoredSamples read() {
        const auto compressed = [](const DicomSlice& slice) { return slice.image->compressed; };
        if (std::ranges::none_of(series_.slices, compressed)) {
            samples_.bytes = filled_memory(bytes_);
            read_images(0, series_.images.size(), static_cast<char*>(samples_.bytes.get()));
            say_padding(padded_);
            return samples_;
        }
        std::size_t largest = 0;  // image that is decoded as a whole
        for (const DicomImage& image : series_.images)
            largest = std::max(largest, image.byte_count());
        const std::shared_ptr<void> counted = memory_for_processes(sizeof(Count));
        Count& padded = *new (counted.get()) Count(0);
        samples_.bytes =
            isolated_bytes(series_.name, "GDCM", bytes_, bytes_, largest, series_.images.size(),
                           [&](std::size_t first, std::size_t end, char* to) {
                               read_images(first, end, to);
                               padded += padded_;
                           });
        say_padding(padded);
        return samples_;
    }

  private:
    using Count = std::atomic<std::size_t>;
    static_assert(Count::is_always_lock_free);  // else processes would not share it

    // Reads the slices of the images [first, end) to their places in `samples`.
    void read_images(std::size_t first, std::size_t end, char* const samples) {
        for (std::size_t i = first; i < end; ++i) {
            const DicomImage& image = series_.images[i];
            std::optional<DicomPixels> pixels;
            char* to = samples;
            for (const auto& [its_image, frame] : series_.slices) {
                if (its_image == &image) {
                    check_interrupt();
                    if (!pixels) pixels.emplace(image);
                    read_slice(*pixels, image, *frame, to);
                }
                to += slice_values_ * bytes_of(samples_.type);
            }
        }
    }

    void say_padding(std::size_t samples) const {
        if (samples == 0) return;
        say("{}: PixelPaddingValue: found it {} times: these samples hold no data, and are drawn "
            "like others",
            series_.name, samples);
    }

    void read_slice(const DicomPixels& pixels, const DicomImage& image, const DicomFrame& frame,
                    char* to) {
        if (image.type != first_.type) {
            fail("{}: found {} pixels, expected {}, as the other slices have", image.file.string(),
                 name_of(image.type), name_of(first_.type));
        }
        char* raw = to;
        if (is_scaled_) {
            raw_.resize(slice_values_ * bytes_of(image.type));
            raw = raw_.data();
        }
        if (slice_values_ * bytes_of(image.type) == image.frame_bytes()) {
            pixels.read(frame.index, raw);
        } else {
            read_tile(pixels, image, frame, raw);
        }
        if (image.padding) count_padding(image, raw);
        if (is_scaled_) scale(image, frame, reinterpret_cast<float*>(to));
    }

    void read_tile(const DicomPixels& pixels, const DicomImage& image, const DicomFrame& frame,
                   char* to) {
        if (mosaic_of_ != &image) {
            mosaic_.resize(image.frame_bytes());
            pixels.read(frame.index, mosaic_.data());
            mosaic_of_ = &image;
        }
        const std::size_t each = bytes_of(image.type);
        const std::size_t row_bytes = static_cast<std::size_t>(image.slice_columns) * each;
        for (std::int64_t row = 0; row < image.slice_rows; ++row, to += row_bytes) {
            const auto first = static_cast<std::size_t>((frame.first_row + row) * image.columns +
                                                        frame.first_column);
            std::memcpy(to, mosaic_.data() + first * each, row_bytes);
        }
    }

    void count_padding(const DicomImage& image, const char* raw) {
        with_type(image.type, [&](auto zero) {
            for (std::size_t i = 0; i < slice_values_; ++i) {
                std::memcpy(&zero, raw + i * sizeof zero, sizeof zero);
                const auto value = static_cast<double>(zero);
                if (value >= image.padding->first && value <= image.padding->second) ++padded_;
            }
        });
    }

    void scale(const DicomImage& image, const DicomFrame& frame, float* to) const {
        const double last = static_cast<double>(image.lut.size()) - 1;
        for (const double value :
             values_from_bytes<double>(image.type, raw_.data(), slice_values_, false)) {
            if (image.lut.empty()) {
                *to++ = static_cast<float>(frame.slope * value + frame.intercept);
            } else {
                const double at = std::clamp(value - image.lut_first, 0.0, last);
                *to++ = static_cast<float>(image.lut[static_cast<std::size_t>(at)]);
            }
        }
    }

    const DicomSeries& series_;
    const DicomImage& first_;
    StoredSamples samples_;
    bool is_scaled_ = false;
    std::size_t bytes_ = 0, slice_values_ = 0, padded_ = 0;
    std::string raw_, mosaic_;  // pixels of a slice; of an image with tiles
    const DicomImage* mosaic_of_ = nullptr;
};

// Returns the files of a folder, but no hidden ones, or, if it has none but a DICOMDIR, the list of
// a medium's files (PS3.10, 8.6), those of the folders inside it, down to the first that have
// files.
std::vector<Path> files_in(const Path& path) {
    constexpr int most_deep = 4;  // patient, study, series, images
    std::vector<Path> files, folders{path};
    for (int depth = 0; depth <= most_deep && files.empty(); ++depth) {
        std::vector<Path> inner;
        for (const Path& folder : folders) {
            std::error_code unreadable;
            for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
                if (entry.is_regular_file(unreadable)) {
                    const std::string name = entry.path().filename().string();
                    if (name != "DICOMDIR" && !name.starts_with('.')) files.push_back(entry.path());
                } else if (entry.is_directory(unreadable) && !entry.is_symlink(unreadable)) {
                    inner.push_back(entry.path());
                }
            }
        }
        folders = std::move(inner);
    }
    return files;
}

}  // namespace

bool is_dicom(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::is_regular_file(path, unreadable)) return has_dicom_mark(path);
    constexpr std::size_t most = 64;  // files that are looked at
    std::vector<Path> files = files_in(path);
    files.resize(std::min(files.size(), most));
    return std::ranges::any_of(files, has_dicom_mark);
}

Volume open_dicom(const std::filesystem::path& path, const VolumeRequest& request,
                  const VolumeUse& use) {
    const DicomSeries series = read_dicom_series(path, request, use.contents);
    return drawn_volume(series.grid, SliceReader(series).read(), use.lookup);
}

std::vector<std::filesystem::path> files_of_dicom(const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) return {path};
    std::vector<Path> files = files_in(path);
    std::ranges::sort(files);
    return files;
}

}  // namespace lamina
