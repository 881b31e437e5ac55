// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_file.h"

#include <fmt/ranges.h>

#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/file_bytes.h"
#include "base/warning.h"
#include "volume_files/grid_check.h"
#include "volume_files/hdf5_array.h"
#include "volume_files/isolated_read.h"
#include "volume_files/stored_axes.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// "FILE.h5:/PATH" in two; the second is empty where the path is a file's.
struct ArrayPath {
    std::filesystem::path file;
    std::string array;
};

ArrayPath array_path(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::exists(path, unreadable)) return {path, ""};
    const std::string text = path.string();
    for (std::size_t at = text.find(":/"); at != std::string::npos; at = text.find(":/", at + 1)) {
        const std::filesystem::path file = text.substr(0, at);
        if (std::filesystem::is_regular_file(file, unreadable)) return {file, text.substr(at + 1)};
    }
    return {path, ""};
}

// The data sets that a volume can be, by their paths.
struct FoundArrays {
    std::vector<std::string> names;
};

herr_t note_array(hid_t file, const char* name, const H5O_info_t* info, void* data) {
    constexpr std::size_t most_names = 1000;
    auto& found = *static_cast<FoundArrays*>(data);
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Hdf5Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    if (!set.valid()) return 0;
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
    const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank >= 3 && rank <= 5 && (kind == H5T_INTEGER || kind == H5T_FLOAT))
        found.names.push_back(std::string("/") + name);
    return found.names.size() < most_names ? 0 : 1;
}

std::string only_array(hid_t file, const std::string& name) {
    FoundArrays found;
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note_array, &found);
    if (found.names.empty())
        fail("{}: found no array of three dimensions and more in it, expected one", name);
    if (found.names.size() > 1) {
        fail("{}: found the arrays {}, expected one, as in {}:{}", name,
             one_line(fmt::format("{}", fmt::join(found.names, ", "))), name,
             one_line(found.names.front()));
    }
    return found.names.front();
}

// Distance and beginning of equally spaced coordinates; nothing where they are not.
struct RegularAxis {
    double step, first;
};
std::optional<RegularAxis> regular(const std::vector<double>& coordinates) {
    // Coordinates in float32 are off by 6e-8 of themselves; what people call regular is closer.
    constexpr double tolerance = 1e-3;
    const std::size_t count = coordinates.size();
    if (count < 2) return {};
    const double step = (coordinates.back() - coordinates.front()) / static_cast<double>(count - 1);
    if (!std::isfinite(step) || step == 0) return {};
    for (std::size_t i = 0; i < count; ++i) {
        const double expected = coordinates.front() + step * static_cast<double>(i);
        if (!(std::abs(coordinates[i] - expected) <= tolerance * std::abs(step))) return {};
    }
    return RegularAxis{step, coordinates.front()};
}

Grid hdf5_grid(const Hdf5Array& array, const std::string& name) {
    Grid grid;
    const std::vector<double> sizes = array.attribute("element_size_um");  // z, y, x
    const std::size_t rank = array.shape().size();
    for (std::size_t i = 0; i < std::min<std::size_t>(3, rank); ++i) {  // x, y, z
        const std::size_t axis = rank - 1 - i;
        grid.size[i] = array.shape()[axis];
        grid.centering[i] = grid.size[i] > 1 ? Centering::node : Centering::cell;
        if (sizes.size() == 3) grid.step[i] *= sizes[2 - i];
        const std::vector<double> coordinates = array.scale_of(axis);
        if (coordinates.empty()) continue;
        if (const auto found = regular(coordinates)) {
            grid.step[i] = glm::dvec3(0);
            grid.step[i][static_cast<int>(i)] = found->step;
            grid.origin[static_cast<int>(i)] = found->first;
        } else if (coordinates.size() > 1) {
            warn(fmt::format(
                "{}: the coordinates of {} are not equally spaced: its samples are taken 1 apart",
                name, "xyz"[i]));
        }
    }
    check_grid(name, grid, {"coordinates", "coordinates"});
    return grid;
}

double attribute_or(const Hdf5Array& array, const char* key, double otherwise) {
    const std::vector<double> numbers = array.attribute(key);
    return numbers.size() == 1 && std::isfinite(numbers[0]) ? numbers[0] : otherwise;
}

// Samples that NetCDF calls missing become NaN where there is one.
void mark_missing(const Hdf5Array& array, StoredSamples& samples, std::int64_t count) {
    for (const char* const key : {"_FillValue", "missing_value"}) {
        const std::vector<double> numbers = array.attribute(key);
        if (numbers.size() != 1 || std::isnan(numbers[0])) continue;
        std::int64_t missing = 0;
        with_type(samples.type, [&](auto zero) {
            using Value = decltype(zero);
            auto* const values = static_cast<Value*>(samples.bytes.get());
            for (std::int64_t i = 0; i < count; ++i) {
                if (static_cast<double>(values[i]) != numbers[0]) continue;
                ++missing;
                if constexpr (std::is_floating_point_v<Value>)
                    values[i] = std::numeric_limits<Value>::quiet_NaN();
            }
        });
        if (missing == 0) continue;
        warn(
            fmt::format("{}: {} samples have the value {}, which \"{}\" calls missing: they are {}",
                        samples.file, missing, numbers[0], key,
                        is_integer(samples.type) ? "drawn as it" : "NaN"));
    }
}

ReadSamples read_samples(const std::filesystem::path& path, const VolumeRequest& request) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // its errors become ours
    const ArrayPath named = array_path(path);
    const std::string file_name = named.file.string();
    const Hdf5Handle file(H5Fopen(file_name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.valid()) fail("{}: truncated or damaged HDF5 file", file_name);
    std::string array_name = named.array.empty() ? request.array : named.array;
    if (array_name.empty()) array_name = only_array(file.id(), file_name);
    const std::string name = file_name + ":" + one_line(array_name);
    const Hdf5Array array(file.id(), array_name, name);

    std::vector<std::int64_t> index;
    const std::size_t rank = array.shape().size();
    const std::int64_t times = rank > 3 ? array.shape()[0] : 1;
    const std::int64_t time = taken_of(name, "time", request.time, times);
    if (rank > 3) index.push_back(time);
    const std::int64_t channels = rank > 4 ? array.shape()[1] : 1;
    const std::int64_t channel = taken_of(name, "channel", request.channel, channels);
    if (rank > 4) index.push_back(channel);

    const Grid grid = hdf5_grid(array, name);
    StoredSamples samples;
    samples.file = name;
    samples.type = array.type();
    samples.bytes = array.read(index, std::filesystem::file_size(named.file));
    mark_missing(array, samples, grid.sample_count());
    samples.scale = attribute_or(array, "scale_factor", 1);
    if (samples.scale == 0) fail("{}: scale_factor: found 0, expected another number", name);
    samples.offset = attribute_or(array, "add_offset", 0);
    return {grid, samples};
}

}  // namespace

bool is_hdf5(const std::filesystem::path& path) {
    constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
    const std::filesystem::path file = array_path(path).file;
    std::error_code unreadable;
    if (std::filesystem::is_directory(file, unreadable)) return false;
    const std::string beginning = file_beginning(file, 2048 + signature.size());
    for (const std::size_t at : {0, 512, 1024, 2048}) {
        if (beginning.size() > at && std::string_view(beginning).substr(at).starts_with(signature))
            return true;
    }
    return false;
}

Volume read_hdf5(const std::filesystem::path& path, const VolumeRequest& request) {
    const ReadSamples found =
        read_isolated(path.string(), "libhdf5", [&] { return read_samples(path, request); });
    return drawn_volume(found.grid, found.samples);
}

std::vector<std::filesystem::path> files_of_hdf5(const std::filesystem::path& path) {
    return {array_path(path).file};
}

}  // namespace lamina
