// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_file.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/bricked_copy.h"
#include "volume_files/grid_check.h"
#include "volume_files/raw_volume.h"
#include "volume_files/volume_format.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

constexpr VolumeFormat raw_format{"raw", {},    {},    read_raw, {},
                                  false, false, false, false,    open_raw};

const VolumeFormat& expected_format(const Path& path) {
    // A part of a file ("FILE.h5:/ARRAY") is none by itself, nor what is not there.
    std::error_code absent;
    const auto status = std::filesystem::status(path, absent);
    if (std::filesystem::exists(status) && !std::filesystem::is_directory(status))
        expect_regular_file(path);
    const VolumeFormat* const format = format_of(path);
    if (format != nullptr) return *format;
    if (!std::filesystem::is_directory(path)) expect_regular_file(path);
    fail("{}: unknown kind of volume: expected {}, or its size and type (--raw)", path.string(),
         volume_format_names());
}

void expect_known_keys(const Path& path, const VolumeFormat& format, const VolumeRequest& request) {
    const auto expect = [&](bool known, bool told, const char* key) {
        if (told && !known) {
            fail("{}: {}: expected no such key: {} files hold only one", path.string(), key,
                 format.name);
        }
    };
    expect(format.has_arrays, !request.array.empty(), "array");
    expect(format.has_levels, request.level.has_value(), "level");
    expect(format.has_channels, request.channel.has_value(), "channel");
    expect(format.has_times, request.time.has_value(), "time");
}

// With the distances and the origin that the request has in place of the file's.
Volume placed(const Path& path, const Volume& volume, const VolumeRequest& request) {
    if (!request.spacing && !request.origin) return volume;
    Grid grid = volume.grid();
    for (int axis = 0; axis < 3 && request.spacing; ++axis) {
        glm::dvec3& step = grid.step[static_cast<std::size_t>(axis)];
        step = glm::normalize(step) * (*request.spacing)[axis];
    }
    if (request.origin) grid.origin = *request.origin;
    check_grid(path.string(), grid, {"spacing", "origin"});
    return volume.on(grid);
}

}  // namespace

bool is_volume_file(const Path& path) {
    expect_allowed(path);
    return format_of(path) != nullptr;
}

Volume read_volume(const Path& path, const VolumeRequest& request) {
    return open_volume(path, request, {});
}

Volume open_volume(const Path& path, const VolumeRequest& request, const VolumeUse& use) {
    expect_allowed(path);
    const VolumeFormat& format = request.raw ? raw_format : expected_format(path);
    expect_known_keys(path, format, request);
    if (use.residence == VolumeUse::Residence::as_fits ||
        use.residence == VolumeUse::Residence::in_files) {
        if (const auto copy = open_bricked_copy(path, request, use))
            return placed(path, *copy, request);
    }
    if (format.open == nullptr && use.residence == VolumeUse::Residence::in_files)
        expect_room(path.string(), 0, use, fmt::format("{} is read as a whole", format.name));
    return placed(
        path, format.open != nullptr ? format.open(path, request, use) : format.read(path, request),
        request);
}

std::vector<Path> files_of_volume(const Path& path, const VolumeRequest& request) {
    expect_allowed(path);
    if (request.raw) return {path};
    try {
        return expected_format(path).files(path);
    } catch (const Error&) {
        return {path};  // errors are reported when the volume is read
    }
}

std::string volume_format_names() {
    std::string names;
    for (const VolumeFormat& format : volume_formats()) {
        std::string extensions;
        for (const char* const extension : format.extensions)
            if (extension != nullptr)
                extensions += (extensions.empty() ? "" : ", ") + std::string(extension);
        names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", format.name, extensions);
    }
    return names;
}

}  // namespace lamina
