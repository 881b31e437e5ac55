// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "volume/labels.h"
#include "volume_files/array_axes.h"
#include "volume_files/bricked_copy.h"
#include "volume_files/foreign_files.h"
#include "volume_files/numbered_files.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// Things of which a file may hold several; the request chooses one by the key of the same name.
enum Keys : unsigned {
    has_none = 0,
    has_arrays = 1,
    has_levels = 2,
    has_channels = 4,
    has_times = 8
};

// A file format of volumes.
struct VolumeFormat {
    const char* name;  // "NIfTI"
    // Extensions in lower case, by which damaged files are recognised; null ends the list.
    const char* extensions[4];
    // Tells if a file, or a file in a folder, is of this format by its content. Never throws.
    bool (*recognizes)(const Path& path);
    // Throws Error: one line that names the file, what was found and what was expected.
    Volume (*open)(const Path& path, const VolumeRequest& request, const VolumeUse& use);
    std::vector<Path> (*files)(const Path& path);
    unsigned keys;               // sum of Keys
    bool is_read_whole = false;  // a volume never stays in such files
};

std::vector<Path> that_file(const Path& path) {
    return {path};
}

#ifdef LAMINA_HAS_GDCM
constexpr const char* dicom_name = "DICOM";
#else
constexpr const char* dicom_name = "DICOM without compression";
#endif

// Tried in this order: the first that recognizes a file reads it.
constexpr VolumeFormat formats[] = {
    {"NRRD", {".nrrd", ".nhdr"}, is_nrrd, open_nrrd, files_of_nrrd, has_channels | has_times},
    {"Zarr",
     {".zarr", ".zarr.zip"},
     is_zarr,
     open_zarr,
     files_of_zarr,
     has_arrays | has_levels | has_channels | has_times},
#ifdef LAMINA_HAS_HDF5
    {"HDF5",
     {".h5", ".hdf5", ".ims", ".vtkhdf"},
     is_hdf5,
     open_hdf5,
     files_of_hdf5,
     has_arrays | has_levels | has_channels | has_times},
#endif
    {"NetCDF",
     {".nc", ".cdf"},
     is_netcdf_classic,
     open_netcdf_classic,
     files_of_netcdf_classic,
     has_arrays | has_channels | has_times,
     true},
    {dicom_name, {".dcm"}, is_dicom, open_dicom, files_of_dicom, has_arrays | has_times, true},
    {"MetaImage",
     {".mha", ".mhd"},
     is_metaimage,
     open_metaimage,
     files_of_metaimage,
     has_channels | has_times},
    {"NIfTI",
     {".nii", ".nii.gz", ".hdr", ".img"},
     is_nifti,
     open_nifti,
     files_of_nifti,
     has_channels | has_times},
    {"VTK image data",
     {".vti", ".vtr", ".pvti", ".pvtr"},
     is_vti,
     open_vti,
     files_of_vti,
     has_arrays | has_channels | has_times,
     true},
    {"TIFF",
     {".tif", ".tiff"},
     is_tiff,
     open_tiff,
     files_of_tiff,
     has_arrays | has_channels | has_times},
    {"NumPy", {".npy", ".npz"}, is_npy, open_npy, that_file, has_arrays | has_channels | has_times},
    {"PNG or JPEG",
     {".png", ".jpg", ".jpeg"},
     is_pictures,
     open_pictures,
     files_of_pictures,
     has_channels,
     true}};

bool has_extension(const VolumeFormat& format, const Path& path) {
    const std::string name = lower_case(path.filename().string());
    return std::ranges::any_of(format.extensions, [&](const char* extension) {
        return extension != nullptr && name.size() > std::string_view(extension).size() &&
               name.ends_with(extension);
    });
}

const VolumeFormat* format_by_content(const Path& path) {
    for (const VolumeFormat& format : formats)
        if (format.recognizes(path)) return &format;
    return nullptr;
}

// Returns the format by extension in any case; null if none has it.
const VolumeFormat* format_by_name(const Path& path) {
    for (const VolumeFormat& format : formats)
        if (has_extension(format, path)) return &format;
    return nullptr;
}

const VolumeFormat* format_of(const Path& path) {
    const VolumeFormat* const format = format_by_content(path);
    return format == nullptr ? format_by_name(path) : format;
}

// Opens a file of samples without a header by the layout request.raw: x fastest, samples 1 apart
// from the origin on, as nodes. Throws Error if the file is too short.
Volume open_raw(const std::filesystem::path& path, const VolumeRequest& request,
                const VolumeUse& use) {
    const RawLayout& raw = *request.raw;
    const auto type = value_type_of(raw.type);
    if (!type) {
        fail("{}: type: found \"{}\", expected one of {}", path.string(), raw.type,
             value_type_list());
    }
    StoredData data;
    data.path = path;
    data.teller = "the layout";
    data.type = *type;
    for (const std::int64_t size : raw.size) {
        if (size < 1)
            fail("{}: size: found {}, expected three numbers above 0", path.string(), size);
        data.axes.emplace_back(size);
    }
    set_byte_order(data, raw.big_endian);
    data.files = {path};
    data.byte_skip = raw.offset;
    return open_stored(plain_grid(raw.size), data, use);
}

constexpr VolumeFormat raw_format{"raw", {}, {}, open_raw, that_file, has_none};

const VolumeFormat& expected_format(const Path& path) {
    // "FILE.h5:/ARRAY" is no file, but a format may know it; if none does, it is reported below
    // like a missing file.
    std::error_code absent;
    const auto status = std::filesystem::status(path, absent);
    if (std::filesystem::exists(status) && !std::filesystem::is_directory(status))
        expect_regular_file(path);
    const VolumeFormat* format = format_by_content(path);
    if (format == nullptr) {
        format = format_by_name(path);
        expect_no_foreign_file(path, format != nullptr);  // others use such extensions, too
    }
#ifndef LAMINA_HAS_HDF5
    if (is_hdf5(path)) {
        fail("{}: found an HDF5 file: this lamina was built without HDF5 (LAMINA_WITH_HDF5)",
             path.string());
    }
#endif
    if (format != nullptr) return *format;
    expect_no_folder(path);
    expect_regular_file(path);
    fail("{}: unknown kind of volume: expected {}, or its size and type (--raw)", path.string(),
         volume_format_names());
}

void expect_known_keys(const Path& path, const VolumeFormat& format, const VolumeRequest& request) {
    const auto expect = [&](Keys key, bool given, const char* word) {
        if (given && (format.keys & key) == 0) {
            fail("{}: {}: expected no such key: {} files hold only one", path.string(), word,
                 format.name);
        }
    };
    expect(has_arrays, !request.array.empty(), "array");
    expect(has_levels, request.level.has_value(), "level");
    expect(has_channels, request.channel.has_value(), "channel");
    expect(has_times, request.time.has_value(), "time");
}

// Tells if samples are labels that neither the request nor the file says to be or not to be.
// Samples that are read once, in order, cannot be measured.
bool are_measured_labels(const Path& path, const Volume& volume, const VolumeUse& use) {
    if (use.lookup || volume.grid().lookup == VolumeLookup::nearest) return false;
    if (!volume.in_memory() && use.residence == VolumeUse::Residence::in_order) return false;
    return taken_by_signs(path.string(), label_signs(volume));
}

// Replaces spacing and origin of the file by those of the request, if it has any, and settles the
// lookup.
Volume placed(const Path& path, const Volume& volume, const VolumeRequest& request,
              const VolumeUse& use) {
    Grid grid = volume.grid();
    if (use.lookup) grid.lookup = *use.lookup;
    if (are_measured_labels(path, volume, use)) grid.lookup = VolumeLookup::nearest;
    if (!request.spacing && !request.origin) return volume.on(grid);
    for (int axis = 0; axis < 3 && request.spacing; ++axis) {
        glm::dvec3& step = grid.step[static_cast<std::size_t>(axis)];
        step = glm::normalize(step) * (*request.spacing)[axis];
    }
    if (request.origin) grid.origin = *request.origin;
    check_grid(path.string(), grid, {"spacing", "origin"});
    return volume.on(grid);
}

}  // namespace

// Not in hdf5.cpp: builds without HDF5 name the format of such files.
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

bool is_volume_file(const Path& path) {
    return !volume_format_of(path).empty();
}

std::string_view volume_format_of(const Path& path) {
    expect_allowed(path);
    const VolumeFormat* const format = format_of(path);
    return format == nullptr ? "" : format->name;
}

Volume read_volume(const Path& path, const VolumeRequest& request) {
    return open_volume(path, request, {});
}

Volume open_volume(const Path& path, const VolumeRequest& request, const VolumeUse& asked) {
    expect_allowed(path);
    VolumeUse use = asked;
    use.lookup = request.lookup;
    const VolumeFormat& format = request.raw ? raw_format : expected_format(path);
    expect_known_keys(path, format, request);
    if (use.residence == VolumeUse::Residence::as_fits ||
        use.residence == VolumeUse::Residence::in_files) {
        if (const auto copy = open_bricked_copy(path, request, use))
            return placed(path, *copy, request, use);
    }
    if (format.is_read_whole && use.residence == VolumeUse::Residence::in_files)
        expect_room(path.string(), 0, use, fmt::format("{} is read as a whole", format.name));
    return placed(path, format.open(path, request, use), request, use);
}

std::vector<Path> files_of_volume(const Path& path, const VolumeRequest& request) {
    expect_allowed(path);
    Client quiet = ClientScope::current();  // opening the volume gives the warnings
    quiet.warnings = nullptr;
    const ClientScope scope(quiet);
    try {
        return (request.raw ? raw_format : expected_format(path)).files(path);
    } catch (const Error&) {
        return {path};  // errors are reported when the volume is read
    }
}

std::string volume_format_names() {
    std::string names;
    for (const VolumeFormat& format : formats) {
        std::string extensions;
        for (const char* const extension : format.extensions)
            if (extension != nullptr)
                extensions += (extensions.empty() ? "" : ", ") + std::string(extension);
        names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", format.name, extensions);
    }
    return names;
}

}  // namespace lamina
