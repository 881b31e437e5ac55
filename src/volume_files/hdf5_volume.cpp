// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_volume.h"

#include <fmt/ranges.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/stored_data.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

constexpr int most_rank = 5;

// Most bytes that a byte of a packed data set gives: deflate's 1032, squared for data packed twice.
constexpr std::uint64_t most_hdf5_expansion = 1 << 20;

hid_t memory_type(ValueType type) {
    const hid_t types[] = {H5T_NATIVE_INT8,  H5T_NATIVE_UINT8,  H5T_NATIVE_INT16, H5T_NATIVE_UINT16,
                           H5T_NATIVE_INT32, H5T_NATIVE_UINT32, H5T_NATIVE_INT64, H5T_NATIVE_UINT64,
                           H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE};
    return types[static_cast<std::size_t>(type)];
}

bool has_numbers(hid_t type) {
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

// Returns nothing if samples of this HDF5 type are not numbers that can be drawn.
std::optional<ValueType> type_of_hdf5(hid_t type) {
    if (!has_numbers(type)) return {};
    const bool integers = H5Tget_class(type) == H5T_INTEGER;
    const std::size_t bytes = H5Tget_size(type);
    return number_type(!integers && bytes == 2 ? 4 : bytes, integers,
                       !integers || H5Tget_sign(type) == H5T_SGN_2);
}

// Returns the numbers of a data space, which read(to) stores; none if over `most` or on failure.
template <typename Read>
std::vector<double> numbers_of(hid_t space, std::size_t most, const Read& read) {
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count < 1 || static_cast<std::size_t>(count) > most) return {};
    std::vector<double> numbers(static_cast<std::size_t>(count));
    if (read(numbers.data()) < 0) return {};
    return numbers;
}

// Refuses a link into another file. HDF5 calls this before it follows such a link.
herr_t refuse_file(const char* /*file*/, const char* /*group*/, const char* /*to*/,
                   const char* /*object*/, unsigned* /*flags*/, hid_t /*access*/,
                   void* is_refused) {
    *static_cast<bool*>(is_refused) = true;
    return -1;
}

// Opens a data set. If the client allows only some files, a link into another file is an Error.
hid_t opened_set(hid_t file, const std::string& path, const std::string& name) {
    const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    bool is_refused = false;
    if (is_restricted()) H5Pset_elink_cb(access.id(), refuse_file, &is_refused);
    const hid_t set = H5Dopen2(file, path.c_str(), access.id());
    if (is_refused) fail("{}: not opened: it is a link into another file", name);
    return set;
}

// The coordinates of an axis that read_scale() finds. `length`: how many the axis has.
struct ScaleFound {
    std::size_t length;
    std::vector<double> numbers;
};

// Takes the coordinates of a dimension scale, if there are as many as the axis needs.
// H5DSiterate_scales() calls this for each scale of the axis until it returns 1.
herr_t read_scale(hid_t /*set*/, unsigned /*axis*/, hid_t scale, void* data) {
    if (is_restricted() && stores_elsewhere(scale)) return 0;
    auto& found = *static_cast<ScaleFound*>(data);
    const Hdf5Handle space(H5Dget_space(scale), H5Sclose);
    const Hdf5Handle type(H5Dget_type(scale), H5Tclose);
    if (!space.valid() || !type.valid() || !has_numbers(type.id())) return 0;
    if (H5Dget_storage_size(scale) == 0) return 0;  // a dimension of NetCDF without coordinates
    auto numbers = numbers_of(space.id(), found.length, [&](double* to) {
        return H5Dread(scale, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
    });
    if (numbers.size() != found.length) return 0;
    found.numbers = std::move(numbers);
    return 1;  // no further one
}

struct FoundArrays {
    std::vector<std::string> names;
    bool too_deep = false;
};

// Largest searched depth of groups: real files have few, and time grows with the square of it.
constexpr std::ptrdiff_t most_groups = 64;

// Notes the path of an object that can be a volume. H5Ovisit() calls this for each object in the
// file, until it returns 1.
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
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank >= 3 && rank <= most_rank && has_numbers(type.id()))
        found.names.push_back(std::string("/") + name);
    return found.names.size() < most_names ? 0 : 1;
}

constexpr std::size_t most_of_names = 200;  // bytes that a message shows

// Returns the path of the only array that can be a volume. Throws Error if there is not one.
std::string only_array(hid_t file, const std::string& name) {
    FoundArrays found;
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note_array, &found);
    if (found.too_deep) {
        fail(
            "{}: found groups in groups more than {} deep, expected fewer, or the name of an "
            "array, as in {}:/GROUP/ARRAY",
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

// Equally spaced coordinates: their distance, and the first one.
struct RegularAxis {
    double step, first;
};

// Returns nothing unless the coordinates are equally spaced.
std::optional<RegularAxis> regular(const std::vector<double>& coordinates) {
    // A share of the step. Rounding to float32, by up to 6e-8 of a coordinate, stays below it up to
    // some 16,000 steps from 0.
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

// Returns the grid by dimension scales, else by element_size_um, else with steps of 1.
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
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown here, not printed
    Hdf5Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!handle.valid()) fail("{}: truncated or damaged HDF5 file", file);
    return handle;
}

// The attributes in which NetCDF names a value that marks missing samples.
constexpr const char* missing_keys[] = {"_FillValue", "missing_value"};

std::optional<double> missing_value(const Hdf5Array& array, const char* key) {
    const std::vector<double> numbers = array.attribute(key);
    return numbers.size() == 1 && !std::isnan(numbers[0]) ? std::optional(numbers[0])
                                                          : std::nullopt;
}

}  // namespace

bool stores_elsewhere(hid_t set) {
    const Hdf5Handle properties(H5Dget_create_plist(set), H5Pclose);
    return !properties.valid() || H5Pget_layout(properties.id()) == H5D_VIRTUAL ||
           H5Pget_external_count(properties.id()) > 0;
}

Hdf5Array::Hdf5Array(hid_t file, const std::string& path, std::string name)
    : name_(std::move(name)), set_(opened_set(file, path, name_), H5Dclose) {
    if (!set_.valid()) fail("{}: found no data set of this name", name_);
    if (is_restricted() && stores_elsewhere(set_.id()))
        fail("{}: not opened: its samples lie in other files", name_);
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.id());
    if (rank < 2 || rank > most_rank)
        fail("{}: found {} dimensions, expected 2 to {}", name_, rank, most_rank);
    hsize_t sizes[most_rank] = {};
    H5Sget_simple_extent_dims(space.id(), sizes, nullptr);
    for (int axis = 0; axis < rank; ++axis) {
        if (sizes[axis] < 1 || sizes[axis] > (hsize_t{1} << 40))
            fail("{}: dimension {}: found {} samples", name_, axis, sizes[axis]);
        shape_.push_back(static_cast<std::int64_t>(sizes[axis]));
    }
    const Hdf5Handle stored(H5Dget_type(set_.id()), H5Tclose);
    const auto type = type_of_hdf5(stored.id());
    if (!type)
        fail("{}: found a type that is none of numbers of 1, 2, 4 or 8 bytes, expected one", name_);
    type_ = *type;
}

std::vector<double> Hdf5Array::attribute(const char* key) const {
    constexpr std::size_t most_numbers = 16;
    if (H5Aexists(set_.id(), key) <= 0) return {};
    const Hdf5Handle found(H5Aopen(set_.id(), key, H5P_DEFAULT), H5Aclose);
    if (!found.valid()) return {};
    const Hdf5Handle space(H5Aget_space(found.id()), H5Sclose);
    const Hdf5Handle type(H5Aget_type(found.id()), H5Tclose);
    if (!space.valid() || !type.valid() || !has_numbers(type.id())) return {};
    return numbers_of(space.id(), most_numbers,
                      [&](double* to) { return H5Aread(found.id(), H5T_NATIVE_DOUBLE, to); });
}

std::vector<double> Hdf5Array::scale_of(std::size_t axis) const {
    constexpr std::int64_t most_coordinates = 1 << 20;
    if (shape_[axis] > most_coordinates) return {};
    ScaleFound found{static_cast<std::size_t>(shape_[axis]), {}};
    const auto number = static_cast<unsigned>(axis);
    if (H5DSget_num_scales(set_.id(), number) < 1) return {};
    if (H5DSiterate_scales(set_.id(), number, nullptr, read_scale, &found) < 0) return {};
    return found.numbers;
}

// Throws Error if the data set is packed by a filter that this machine's library does not have.
void Hdf5Array::expect_filters() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    const int count = properties.valid() ? H5Pget_nfilters(properties.id()) : 0;
    for (int i = 0; i < count; ++i) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        char word[64] = {};
        const H5Z_filter_t filter =
            H5Pget_filter2(properties.id(), static_cast<unsigned>(i), &flags, &values, nullptr,
                           sizeof word, word, &config);
        if (filter >= 0 && H5Zfilter_avail(filter) <= 0) {
            fail("{}: found the filter {} ({}), expected one that HDF5 has here", name_, filter,
                 one_line(word));
        }
    }
}

std::vector<std::int64_t> Hdf5Array::chunk() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    if (!properties.valid() || H5Pget_layout(properties.id()) != H5D_CHUNKED) return {};
    hsize_t edges[most_rank] = {};
    const int rank = static_cast<int>(shape_.size());
    if (H5Pget_chunk(properties.id(), most_rank, edges) != rank) return {};
    std::vector<std::int64_t> chunk;
    for (std::size_t axis = 0; axis < shape_.size(); ++axis)
        chunk.push_back(
            std::clamp<std::int64_t>(static_cast<std::int64_t>(edges[axis]), 1, shape_[axis]));
    return chunk;
}

bool Hdf5Array::lies_elsewhere(hid_t file) const {
    const auto name_of_file = [](hid_t id) {
        char name[4096] = {};
        return H5Fget_name(id, name, sizeof name) > 0 ? std::string(name) : std::string();
    };
    if (name_of_file(set_.id()) != name_of_file(file)) return true;
    return stores_elsewhere(set_.id());
}

std::optional<Hdf5Array::RawPlace> Hdf5Array::raw_place() const {
    const Hdf5Handle properties(H5Dget_create_plist(set_.id()), H5Pclose);
    if (!properties.valid() || H5Pget_layout(properties.id()) != H5D_CONTIGUOUS) return {};
    const haddr_t place = H5Dget_offset(set_.id());
    if (place == HADDR_UNDEF || place > (haddr_t{1} << 62)) return {};
    const Hdf5Handle stored(H5Dget_type(set_.id()), H5Tclose);
    for (const H5T_order_t order : {H5T_ORDER_LE, H5T_ORDER_BE}) {
        const Hdf5Handle plain(H5Tcopy(memory_type(type_)), H5Tclose);
        if (H5Tset_order(plain.id(), order) >= 0 && H5Tequal(stored.id(), plain.id()) > 0)
            return RawPlace{static_cast<std::int64_t>(place), order == H5T_ORDER_BE};
    }
    return {};
}

void Hdf5Array::expect_readable(std::uint64_t bytes, std::uint64_t file_bytes) const {
    const std::uint64_t stored =
        std::min<std::uint64_t>(H5Dget_storage_size(set_.id()), file_bytes);
    if (stored == 0) fail("{}: found no samples in it, expected {} bytes", name_, bytes);
    if (bytes / most_hdf5_expansion > stored) {
        fail("{}: the array promises {} bytes, the file has {}, which cannot hold them", name_,
             bytes, stored);
    }
    expect_filters();
}

void Hdf5Array::read(std::vector<std::int64_t> begin, std::vector<std::int64_t> count,
                     char* to) const {
    const Hdf5Handle space(H5Dget_space(set_.id()), H5Sclose);
    const std::vector<hsize_t> first(begin.begin(), begin.end()), sizes(count.begin(), count.end());
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, first.data(), nullptr, sizes.data(), nullptr);
    const Hdf5Handle memory(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                            H5Sclose);
    if (H5Dread(set_.id(), memory_type(type_), memory.id(), space.id(), H5P_DEFAULT, to) < 0) {
        fail("{}: damaged data: HDF5 cannot read the samples from {} on, {} of each dimension",
             name_, fmt::join(begin, ", "), fmt::join(count, ", "));
    }
}

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

// Replaces missing samples, those with the value of an attribute of missing_keys, by NaN if their
// type has it. If `reports`, warns of them and counts them.
void Hdf5Volume::mark_missing(std::int64_t count, bool reports, void* samples) const {
    if (is_integer(head_.type) && !reports) return;
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
        if (missing == 0 || !reports) continue;
        warn(fmt::format(
            "{}: {} samples have the value {}, which \"{}\" calls missing: they are {}", name_,
            missing, *number, key, is_integer(head_.type) ? "drawn as it" : "NaN"));
    }
}

}  // namespace lamina
