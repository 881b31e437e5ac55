// SPDX-License-Identifier: Apache-2.0
#include "volume_files/dicom.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/file_bytes.h"
#include "base/interrupt.h"
#include "volume_files/dicom_series.h"
#include "volume_files/stored_axes.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

bool has_dicom_mark(const std::filesystem::path& file) {
    return file_beginning(file, 132).find("DICM", 128) == 128;
}

// Slices whose slope or intercept differ, as those of PET, are scaled one by one.
class SliceReader {
  public:
    explicit SliceReader(const DicomSeries& series) : series_(series) {
        const DicomImage& first = series.slices.front();
        samples_.file = series.name;
        scales_alike_ = std::ranges::all_of(series.slices, [&](const DicomImage& slice) {
            return slice.slope == first.slope && slice.intercept == first.intercept;
        });
        if (scales_alike_) {
            samples_.scale = first.slope;
            samples_.offset = first.intercept;
        }
    }

    StoredSamples read() {
        std::size_t done = 0;
        for (const DicomImage& slice : series_.slices) {
            check_interrupt();
            const DicomPixels pixels(slice);
            if (!type_) begin(pixels);
            if (pixels.type() != *type_) {
                fail("{}: found {} pixels, expected {}, as the other slices have",
                     slice.file.string(), name_of(pixels.type()), name_of(*type_));
            }
            char* const to = static_cast<char*>(samples_.bytes.get());
            if (scales_alike_) {
                pixels.read(to + done);
                done += pixels.byte_count();
            } else {
                done = read_scaled(slice, pixels, to, done);
            }
        }
        return samples_;
    }

  private:
    void begin(const DicomPixels& pixels) {
        type_ = pixels.type();
        samples_.type = scales_alike_ ? *type_ : ValueType::float32;
        const auto& size = series_.grid.size;
        const StoredAxis axes[] = {{size[0], {}}, {size[1], {}}, {size[2], {}}};
        samples_.bytes = sample_memory(stored_bytes(series_.name, axes, bytes_of(samples_.type)));
    }

    std::size_t read_scaled(const DicomImage& slice, const DicomPixels& pixels, char* to,
                            std::size_t done) const {
        std::string raw(pixels.byte_count(), '\0');
        pixels.read(raw.data());
        const std::size_t count = raw.size() / bytes_of(*type_);
        const auto values = values_from_bytes<double>(*type_, raw.data(), count, false);
        auto* const scaled = reinterpret_cast<float*>(to + done);
        for (std::size_t i = 0; i < count; ++i)
            scaled[i] = static_cast<float>(slice.slope * values[i] + slice.intercept);
        return done + count * sizeof(float);
    }

    const DicomSeries& series_;
    StoredSamples samples_;
    bool scales_alike_ = true;
    std::optional<ValueType> type_;
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
    return drawn_volume(series.grid, SliceReader(series).read());
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
