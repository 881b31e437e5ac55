// SPDX-License-Identifier: Apache-2.0
// The targets metaimage, netcdf, nifti, npy_volume, pictures, tiff and vti: volumes are read,
// measured and planned.
#include <algorithm>

#include "input_parts.h"
#include "runs.h"
#include "scratch_folder.h"
#include "volume_check.h"
#include "volume_files/volume_formats.h"

namespace lamina::fuzz {
namespace {

// Tells whether every line that may be the field ElementDataFile names only files in the scratch
// folder. After LIST all lines are names of files.
bool element_file_stays_in_folder(std::string_view header) {
    constexpr std::string_view field = "ElementDataFile";
    for (std::size_t at = header.find(field); at != header.npos; at = header.find(field, at + 1)) {
        const std::size_t end = std::min(header.find('\n', at), header.size());
        const std::string_view line = header.substr(at, end - at);
        const bool list = line.find("LIST") != line.npos;
        if (!stays_in_folder(list ? header.substr(at) : line)) return false;
    }
    return true;
}

void run_reader(std::string_view input, const char* name,
                Volume (*open)(const std::filesystem::path&, const VolumeRequest&,
                               const VolumeUse&)) {
    const auto file = scratch_file(name, input);
    check_volume([&](const VolumeUse& use) { return open(file, {}, use); });
}

}  // namespace

void run_metaimage(std::string_view input) {
    const InputParts parts = parts_of(input);
    if (!element_file_stays_in_folder(parts.first)) return;
    scratch_file("data", parts.second);
    run_reader(parts.first, "volume.mhd", open_metaimage);
}

void run_netcdf(std::string_view input) {
    run_reader(input, "volume.nc", open_netcdf_classic);
}

void run_nifti(std::string_view input) {
    const InputParts parts = parts_of(input);
    scratch_file("volume.img", parts.second);
    run_reader(parts.first, "volume.hdr", open_nifti);
}

void run_npy_volume(std::string_view input) {
    run_reader(input, "volume.npy", open_npy);
}

void run_pictures(std::string_view input) {
    run_reader(input, "volume.picture", open_pictures);
}

void run_tiff(std::string_view input) {
    run_reader(input, "volume.tif", open_tiff);
}

void run_vti(std::string_view input) {
    const InputParts parts = parts_of(input);
    if (!names_stay_in_folder(parts.first)) return;
    scratch_file("piece.vti", parts.second);
    run_reader(parts.first, "volume.vti", open_vti);
}

}  // namespace lamina::fuzz
