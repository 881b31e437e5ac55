// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_format.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "volume_files/dicom.h"
#include "volume_files/hdf5_file.h"
#include "volume_files/metaimage.h"
#include "volume_files/nifti.h"
#include "volume_files/npy_volume.h"
#include "volume_files/nrrd.h"
#include "volume_files/tiff_stack.h"
#include "volume_files/vti.h"
#include "volume_files/zarr.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

// Content decides, in this order.
constexpr VolumeFormat formats[] = {
    {"NRRD",
     {".nrrd", ".nhdr"},
     is_nrrd,
     read_nrrd,
     files_of_nrrd,
     false,
     false,
     true,
     true,
     open_nrrd},
    {"Zarr", {".zarr"}, is_zarr, read_zarr, files_of_zarr, true, true, true, true, open_zarr},
#ifdef LAMINA_HAS_HDF5
    {"HDF5",
     {".h5", ".hdf5", ".nc"},
     is_hdf5,
     read_hdf5,
     files_of_hdf5,
     true,
     false,
     true,
     true,
     open_hdf5},
#endif
#ifdef LAMINA_HAS_GDCM
    {"DICOM", {".dcm"}, is_dicom, read_dicom, files_of_dicom, true, false, false, true},
#else
    {"DICOM without compression",
     {".dcm"},
     is_dicom,
     read_dicom,
     files_of_dicom,
     true,
     false,
     false,
     true},
#endif
    {"MetaImage",
     {".mha", ".mhd"},
     is_metaimage,
     read_metaimage,
     files_of_metaimage,
     false,
     false,
     true,
     true,
     open_metaimage},
    {"NIfTI",
     {".nii", ".nii.gz", ".hdr", ".img"},
     is_nifti,
     read_nifti,
     files_of_nifti,
     false,
     false,
     true,
     true,
     open_nifti},
    {"VTK image data", {".vti"}, is_vti, read_vti, files_of_vti, true, false, true, false},
    {"TIFF",
     {".tif", ".tiff"},
     is_tiff_stack,
     read_tiff_stack,
     files_of_tiff_stack,
     false,
     false,
     true,
     true},
    {"NumPy",
     {".npy"},
     is_npy,
     read_npy_volume,
     files_of_npy,
     false,
     false,
     false,
     false,
     open_npy_volume}};

bool has_extension(const VolumeFormat& format, const Path& path) {
    std::string name = path.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return std::ranges::any_of(format.extensions, [&](const char* extension) {
        return extension != nullptr && name.size() > std::string_view(extension).size() &&
               name.ends_with(extension);
    });
}

}  // namespace

std::span<const VolumeFormat> volume_formats() {
    return formats;
}

const VolumeFormat* format_of(const Path& path) {
    for (const VolumeFormat& format : formats)
        if (format.recognizes(path)) return &format;
    for (const VolumeFormat& format : formats)
        if (has_extension(format, path)) return &format;
    return nullptr;
}

}  // namespace lamina
