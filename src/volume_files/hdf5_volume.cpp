// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_volume.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "volume_files/grid_check.h"
#include "volume_files/stored_axes.h"

namespace lamina {
namespace {

// The data sets that a volume can be, by their paths.
struct FoundArrays {
    std::vector<std::string> names;
    bool too_deep = false;
};

// Groups in groups that are searched: real files have a few, and the time that the library takes
// grows with the square of the depth.
constexpr std::ptrdiff_t most_groups = 64;

herr_t note_array(hid_t file, const char* name, const H5O_info_t* info, void* data) {
    constexpr std::size_t most_names = 1000;
    auto& found = *static_cast<FoundArrays*>(data);
    found.too_deep = std::count(name, name + std::strlen(name), '/') > most_groups;
    if (found.too_deep) return 1;
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Hdf5Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    if (!set.valid() || (is_restricted() && stores_elsewhere(set.id()))) return 0;
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
    const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank >= 3 && rank <= 5 && (kind == H5T_INTEGER || kind == H5T_FLOAT))
        found.names.push_back(std::string("/") + name);
    return found.names.size() < most_names ? 0 : 1;
}

constexpr std::size_t most_of_names = 200;  // bytes that a message shows

std::string only_array(hid_t file, const std::string& name) {
    FoundArrays found;
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note_array, &found);
    if (found.too_deep) {
        fail(
            "{}: found groups in groups more than {} deep, expected fewer, or the name of an "
            "array, as "
            "in {}:/GROUP/ARRAY",
            name, most_groups, name);
    }
    if (found.names.empty())
        fail("{}: found no array of three dimensions and more in it, expected one", name);
    if (found.names.size() > 1) {
        fail("{}: found the arrays {}, expected one, as in {}:{}", name,
             shortened(one_line(fmt::format("{}", fmt::join(found.names, ", "))), most_of_names),
             name, shortened(one_line(found.names.front()), most_of_names));
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

Hdf5Handle opened(const std::string& file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // its errors become ours
    Hdf5Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!handle.valid()) fail("{}: truncated or damaged HDF5 file", file);
    return handle;
}

constexpr const char* missing_keys[] = {"_FillValue", "missing_value"};

std::optional<double> missing_value(const Hdf5Array& array, const char* key) {
    const std::vector<double> numbers = array.attribute(key);
    if (numbers.size() != 1 || std::isnan(numbers[0])) return {};
    return numbers[0];
}

}  // namespace

Hdf5Volume::Hdf5Volume(const std::string& file, const std::string& array,
                       const VolumeRequest& request)
    : file_(opened(file)),
      path_(array.empty() ? only_array(file_.id(), file) : array),
      name_(file + ":" + one_line(path_)),
      array_(file_.id(), path_, name_) {
    const std::size_t rank = array_.shape().size();
    head_.outer = {rank > 4 ? array_.shape()[1] : 1, rank > 3 ? array_.shape()[0] : 1};
    head_.taken[1] = taken_of(name_, "time", request.time, head_.outer[1]);
    head_.taken[0] = taken_of(name_, "channel", request.channel, head_.outer[0]);
    if (rank > 3) index_.push_back(head_.taken[1]);
    if (rank > 4) index_.push_back(head_.taken[0]);

    head_.grid = hdf5_grid(array_, name_);
    head_.type = array_.type();
    head_.scale = attribute_or(array_, "scale_factor", 1);
    if (head_.scale == 0) fail("{}: scale_factor: found 0, expected another number", name_);
    head_.offset = attribute_or(array_, "add_offset", 0);
    for (const char* const key : missing_keys)
        head_.has_missing |= !is_integer(head_.type) && missing_value(array_, key).has_value();
    const std::vector<std::int64_t> chunk = array_.chunk();
    for (std::size_t i = 0; i < 3 && !chunk.empty(); ++i)
        head_.chunk[i] = i < rank ? chunk[rank - 1 - i] : 1;
    chunk_bytes_ = chunk.empty() ? 0 : bytes_of(head_.type);
    for (const std::int64_t edge : chunk) chunk_bytes_ *= static_cast<std::size_t>(edge);
    head_.elsewhere = array_.lies_elsewhere(file_.id());
    if (const auto raw = array_.raw_place()) head_.raw = *raw;

    std::vector<StoredAxis> axes;
    for (const std::int64_t size : head_.grid.size) axes.emplace_back(size);
    array_.expect_readable(stored_bytes(name_, axes, bytes_of(head_.type)),
                           std::filesystem::file_size(file));
}

void Hdf5Volume::read(const SampleBox& box, bool is_all, void* to) const {
    std::vector<std::int64_t> begin = index_, count(index_.size(), 1);
    for (std::size_t axis = array_.shape().size() - index_.size(); axis-- > 0;) {
        begin.push_back(box.first[axis]);
        count.push_back(box.size[axis]);
    }
    array_.read(begin, count, static_cast<char*>(to));
    mark_missing(box.count(), is_all, to);
}

// Samples that NetCDF calls missing become NaN where there is one.
void Hdf5Volume::mark_missing(std::int64_t count, bool is_told, void* samples) const {
    if (is_integer(head_.type) && !is_told) return;
    for (const char* const key : missing_keys) {
        const std::optional<double> number = missing_value(array_, key);
        if (!number) continue;
        std::int64_t missing = 0;
        with_type(head_.type, [&](auto zero) {
            using Value = decltype(zero);
            auto* const values = static_cast<Value*>(samples);
            for (std::int64_t i = 0; i < count; ++i) {
                if (static_cast<double>(values[i]) != *number) continue;
                ++missing;
                if constexpr (std::is_floating_point_v<Value>)
                    values[i] = std::numeric_limits<Value>::quiet_NaN();
            }
        });
        if (missing == 0 || !is_told) continue;
        warn(fmt::format(
            "{}: {} samples have the value {}, which \"{}\" calls missing: they are {}", name_,
            missing, *number, key, is_integer(head_.type) ? "drawn as it" : "NaN"));
    }
}

}  // namespace lamina
