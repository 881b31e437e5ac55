// SPDX-License-Identifier: Apache-2.0
// The targets zarr, hdf5 and dicom: formats that store arrays in folders or containers.
#include <filesystem>

#include "input_parts.h"
#include "runs.h"
#include "scratch_folder.h"
#include "volume_check.h"
#include "volume_files/volume_file.h"

namespace lamina::fuzz {
namespace {

std::filesystem::path scratch_in(const std::string& folder, const std::string& name,
                                 std::string_view bytes) {
    const std::filesystem::path place = scratch_folder() / folder;
    std::filesystem::create_directories(place);
    scratch_file(folder + "/" + name, bytes);
    return place;
}

void check_file(const std::filesystem::path& path) {
    check_volume([&](const VolumeUse& use) { return open_volume(path, {}, use); });
}

}  // namespace

void run_zarr(std::string_view input) {
    if (input.starts_with("PK")) {
        const auto file = scratch_file("volume.zarr.zip", input);
        if (!is_volume_file(file)) return;
        return check_file(file);
    }
    const InputParts array = parts_of(input), rest = parts_of(array.second);
    if (!stays_in_folder(rest.first)) return;  // attributes may name folders
    const bool is_version_3 = array.first.find("node_type") != array.first.npos;
    std::filesystem::remove_all(scratch_folder() / "volume.zarr");
    scratch_in("volume.zarr/0", is_version_3 ? "zarr.json" : ".zarray", array.first);
    for (const char* const name : {"0.0.0", "0.0.0.0.0", "c.0.0.0"})
        scratch_in("volume.zarr/0", name, rest.second);
    for (const char* const place : {"volume.zarr/0/0/0", "volume.zarr/0/c/0/0"})
        scratch_in(place, "0", rest.second);
    const auto folder = scratch_folder() / "volume.zarr";
    const bool is_image = rest.first.find_first_not_of('\n') != rest.first.npos;
    if (is_image) scratch_in("volume.zarr", is_version_3 ? "zarr.json" : ".zattrs", rest.first);
    check_file(is_image ? folder : folder / "0");
}

void run_hdf5(std::string_view input) {
    const auto file = scratch_file("volume.h5", input);
    if (!is_volume_file(file)) return;
    check_file(file);
}

void run_dicom(std::string_view input) {
    const InputParts slices = parts_of(input);
    std::filesystem::remove_all(scratch_folder() / "slices");
    const auto folder = scratch_in("slices", "1", slices.first);
    if (!slices.second.empty()) scratch_in("slices", "2", slices.second);
    if (!is_volume_file(folder)) return;
    check_file(folder);
}

}  // namespace lamina::fuzz
