// SPDX-License-Identifier: Apache-2.0
#include "volume_files/dicom.h"

#include <algorithm>

#include "base/client.h"
#include "base/error.h"
#include "base/memory.h"
#include "volume_files/dicom_elements.h"
#include "volume_files/dicom_series.h"
#include "volume_files/isolated_read.h"
#include "volume_files/stored_axes.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// Slices whose slope or intercept differ, as those of PET, are scaled one by one.
class SliceReader {
  public:
    explicit SliceReader(const DicomSeries& series) : series_(series) {
        const DicomImage& first = series.slices.front();
        samples_.file = series.name;
        type_ = first.type;
        scales_alike_ = std::ranges::all_of(series.slices, [&](const DicomImage& slice) {
            return slice.slope == first.slope && slice.intercept == first.intercept;
        });
        if (scales_alike_) {
            samples_.scale = first.slope;
            samples_.offset = first.intercept;
        }
    }

    // Where compressed slices are read, by a library in a process of its own, `line` is that
    // process's.
    StoredSamples read(IsolatedLine* line = nullptr) {
        expect_room();
        const auto& size = series_.grid.size;
        const StoredAxis axes[] = {{size[0], {}}, {size[1], {}}, {size[2], {}}};
        samples_.type = scales_alike_ ? type_ : ValueType::float32;
        const std::size_t bytes = stored_bytes(series_.name, axes, bytes_of(samples_.type));
        if (line != nullptr) line->allow_bytes(bytes);
        samples_.bytes = line != nullptr ? line->shared_memory(bytes) : filled_memory(bytes);
        std::size_t done = 0;
        for (const DicomImage& slice : series_.slices) {
            check_interrupt();
            if (slice.type != type_) {
                fail("{}: found {} pixels, expected {}, as the other slices have",
                     slice.file.string(), name_of(slice.type), name_of(type_));
            }
            char* const to = static_cast<char*>(samples_.bytes.get());
            if (scales_alike_) {
                read_dicom_pixels(slice, to + done);
                done += slice.byte_count();
            } else {
                done = read_scaled(slice, to, done);
            }
        }
        return samples_;
    }

  private:
    // Before memory is taken; the pixels of other images were found to be there.
    void expect_room() const {
        constexpr std::uint64_t most_expansion = 1 << 16;
        for (const DicomImage& slice : series_.slices) {
            const std::uint64_t there = std::filesystem::file_size(slice.file);
            if (slice.compressed && slice.byte_count() / most_expansion > there) {
                fail("{}: the header promises {} bytes of pixels, the file has {} in all",
                     slice.file.string(), slice.byte_count(), there);
            }
        }
    }

    std::size_t read_scaled(const DicomImage& slice, char* to, std::size_t done) const {
        std::string raw(slice.byte_count(), '\0');
        read_dicom_pixels(slice, raw.data());
        const std::size_t count = raw.size() / bytes_of(type_);
        const auto values = values_from_bytes<double>(type_, raw.data(), count, false);
        auto* const scaled = reinterpret_cast<float*>(to + done);
        for (std::size_t i = 0; i < count; ++i)
            scaled[i] = static_cast<float>(slice.slope * values[i] + slice.intercept);
        return done + count * sizeof(float);
    }

    const DicomSeries& series_;
    StoredSamples samples_;
    bool scales_alike_ = true;
    ValueType type_ = ValueType::uint8;
};

}  // namespace

bool is_dicom(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::is_regular_file(path, unreadable)) return has_dicom_mark(path);
    int left = 64;
    for (const auto& entry : std::filesystem::directory_iterator(path, unreadable)) {
        if (left-- == 0) break;
        if (entry.is_regular_file(unreadable) && has_dicom_mark(entry.path())) return true;
    }
    return false;
}

Volume read_dicom(const std::filesystem::path& path, const VolumeRequest& request) {
    const DicomSeries series = read_dicom_series(path, request);
    const auto compressed = [](const DicomImage& slice) { return slice.compressed; };
    if (std::ranges::none_of(series.slices, compressed))
        return drawn_volume(series.grid, SliceReader(series).read());
    const ReadSamples found = read_isolated(series.name, "GDCM", [&](IsolatedLine& line) {
        return ReadSamples{series.grid, SliceReader(series).read(&line)};
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
