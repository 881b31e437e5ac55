// SPDX-License-Identifier: Apache-2.0
// The targets zarr, hdf5 and dicom: formats that store arrays in folders or containers.
#include <filesystem>

#include "input_parts.h"
#include "runs.h"
#include "scratch_folder.h"
#include "violation.h"
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

}  // namespace

void run_zarr(std::string_view input) {
    const InputParts array = parts_of(input), rest = parts_of(array.second);
    if (!stays_in_folder(rest.first)) return;  // attributes may name folders
    std::filesystem::remove_all(scratch_folder() / "volume.zarr");
    scratch_in("volume.zarr/0", ".zarray", array.first);
    scratch_in("volume.zarr/0", "0.0.0", rest.second);
    scratch_in("volume.zarr/0", "0.0.0.0.0", rest.second);
    scratch_in("volume.zarr/0/0/0", "0", rest.second);
    const auto image = scratch_in("volume.zarr", ".zattrs", rest.first);
    may_fail([&] { check_volume(read_volume(rest.first.empty() ? image / "0" : image)); });
}

void run_hdf5(std::string_view input) {
    const auto file = scratch_file("volume.h5", input);
    if (!is_volume_file(file)) return;
    may_fail([&] { check_volume(read_volume(file)); });
}

void run_dicom(std::string_view input) {
    const InputParts slices = parts_of(input);
    std::filesystem::remove_all(scratch_folder() / "slices");
    const auto folder = scratch_in("slices", "1", slices.first);
    if (!slices.second.empty()) scratch_in("slices", "2", slices.second);
    if (!is_volume_file(folder)) return;
    may_fail([&] { check_volume(read_volume(folder)); });
}

}  // namespace lamina::fuzz
