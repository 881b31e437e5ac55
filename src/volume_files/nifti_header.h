// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "lamina/grid.h"

namespace lamina {

// The fields of a NIfTI-1 or NIfTI-2 header that place and scale the samples
// (https://nifti.nimh.nih.gov/nifti-1, nifti1.h; nifti2.h).
struct NiftiHeader {
    std::filesystem::path path;       // of the header
    std::filesystem::path data_path;  // of the samples: the same for magic "n+1"
    bool packed = false;              // both are gzip files
    bool big_endian = false;
    std::array<std::int64_t, 8> dim{};  // dim[0]: how many of the others count
    std::array<double, 8> pixdim{};
    std::int64_t datatype = 0;
    std::int64_t data_offset = 0;
    double slope = 0, intercept = 0;
    std::int64_t qform_code = 0, sform_code = 0;
    std::array<double, 3> quaternion{}, offset{};
    std::array<std::array<double, 4>, 3> srow{};
};

// Nothing where the file holds no NIfTI header. Throws Error where it cannot be read.
std::optional<NiftiHeader> read_nifti_header(const std::filesystem::path& path);

// The grid of its first three axes: by sform, else by qform, turned to LPS; where it has neither,
// samples lie pixdim apart from the origin on, and directions are unnamed. Throws Error.
Grid nifti_grid(const NiftiHeader& header);

}  // namespace lamina
