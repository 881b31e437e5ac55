// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nifti.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/nifti_header.h"
#include "volume_files/stored_data.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

struct NiftiType {
    std::int64_t code;  // nifti1.h, NIFTI_TYPE_*
    ValueType type;
    std::int64_t colors;  // samples of a voxel
};

constexpr NiftiType types[] = {
    {2, ValueType::uint8, 1},    {4, ValueType::int16, 1},     {8, ValueType::int32, 1},
    {16, ValueType::float32, 1}, {64, ValueType::float64, 1},  {128, ValueType::uint8, 3},
    {256, ValueType::int8, 1},   {512, ValueType::uint16, 1},  {768, ValueType::uint32, 1},
    {1024, ValueType::int64, 1}, {1280, ValueType::uint64, 1}, {2304, ValueType::uint8, 4}};

// "a.img" of a pair is told as its header.
Path header_path(const Path& path) {
    std::string name = path.filename().string();
    const std::size_t at = name.rfind(".img");
    if (at == std::string::npos || (at + 4 != name.size() && name.substr(at + 4) != ".gz"))
        return path;
    return path.parent_path() / name.replace(at, 4, ".hdr");
}

NiftiHeader expected_header(const Path& path) {
    const auto header = read_nifti_header(header_path(path));
    if (!header) {
        fail("{}: no NIfTI header: expected 348 or 540 in its first 4 bytes, and its magic",
             header_path(path).string());
    }
    return *header;
}

NiftiType type_of(const NiftiHeader& header) {
    const auto* const found = std::ranges::find(types, header.datatype, &NiftiType::code);
    if (found == std::end(types)) {
        fail("{}: datatype: found {}, expected integers or floats of up to 64 bits, RGB or RGBA",
             header.path.string(), header.datatype);
    }
    return *found;
}

void check_dimensions(const NiftiHeader& header) {
    const std::string file = header.path.string();
    if (header.dim[0] < 3 || header.dim[0] > 7)
        fail("{}: dim[0]: found {}, expected 3 axes to 7", file, header.dim[0]);
    for (std::size_t i = 1; i <= static_cast<std::size_t>(header.dim[0]); ++i) {
        const std::int64_t most = i > 5 ? 1 : std::int64_t{1} << 40;
        if (header.dim[i] < 1 || header.dim[i] > most)
            fail("{}: dim[{}]: found {}, expected a number from 1 to {}", file, i, header.dim[i],
                 most);
    }
}

std::vector<StoredAxis> axes_of(const NiftiHeader& header, std::int64_t colors,
                                const VolumeRequest& request) {
    const std::string file = header.path.string();
    const std::int64_t times = header.dim[0] > 3 ? header.dim[4] : 1;
    const std::int64_t vectors = header.dim[0] > 4 ? header.dim[5] : 1;
    if (colors > 1 && vectors > 1)
        fail("{}: dim[5]: found {} vectors of colours, expected 1", file, vectors);
    const StoredAxis channel =
        taken_axis(file, "channel", request.channel, std::max(colors, vectors));
    std::vector<StoredAxis> axes;
    if (colors > 1) axes.push_back(channel);
    for (std::size_t i = 1; i <= 3; ++i) axes.emplace_back(header.dim[i]);
    axes.push_back(taken_axis(file, "time", request.time, times));
    if (vectors > 1) axes.push_back(channel);
    return axes;
}

}  // namespace

bool is_nifti(const Path& path) {
    try {
        return read_nifti_header(header_path(path)).has_value();
    } catch (const Error&) {
        return false;  // its reader says why, where its name tells that it is one
    }
}

Volume read_nifti(const Path& path, const VolumeRequest& request) {
    return open_nifti(path, request, {});
}

Volume open_nifti(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    const NiftiHeader header = expected_header(path);
    check_dimensions(header);
    const NiftiType type = type_of(header);
    const Grid grid = nifti_grid(header);
    expect_allowed(header.data_path);
    if (!std::filesystem::exists(header.data_path)) {
        fail("{}: data file of {}: no such file", header.data_path.string(), header.path.string());
    }
    StoredData data;
    data.path = header.path;
    data.type = type.type;
    data.axes = axes_of(header, type.colors, request);
    data.encoding = header.packed ? DataEncoding::gzip : DataEncoding::raw;
    set_byte_order(data, header.big_endian);
    data.files = {header.data_path};
    data.byte_skip = header.data_offset;
    // No slope, 0, means that samples are values (nifti1.h, "Data scaling").
    if (type.colors == 1 && header.slope != 0 && std::isfinite(header.slope)) {
        if (!std::isfinite(header.intercept))
            fail("{}: scl_inter: found {}, expected a finite number", header.path.string(),
                 header.intercept);
        data.scale = header.slope;
        data.shift = header.intercept;
    }
    return open_stored(grid, data, use);
}

std::vector<Path> files_of_nifti(const Path& path) {
    const NiftiHeader header = expected_header(path);
    if (header.path == header.data_path) return {header.path};
    return {header.path, header.data_path};
}

}  // namespace lamina
