// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "volume_files/array_axes.h"
#include "volume_files/hdf5_files.h"
#include "volume_files/packed_values.h"

namespace lamina {

// The array of an HDF5 file that a request takes, and what the program that wrote it is known to
// mean.
struct Hdf5Layout {
    explicit Hdf5Layout(std::string path, VolumeRequest rest = {}, std::string letters = "")
        : array(std::move(path)), request(std::move(rest)), labels(std::move(letters)) {}

    std::string array;                          // its path
    VolumeRequest request;                      // what is still to be taken of the array
    std::string labels;                         // the letter of each axis; empty: as the array says
    std::array<std::int64_t, 3> size{0, 0, 0};  // samples along x, y and z that count; 0: all
    std::optional<Grid> grid;                   // where samples are, without their number
    bool is_unsigned = false;                   // whatever the type says
};

// Finds the array in Imaris, BigDataViewer, VTKHDF and ITK files by what these write, and in others
// by the array that is `named`, or the only one. Fills `contents`. Throws Error.
Hdf5Layout hdf5_layout(Hdf5Files& files, const std::string& named, const VolumeRequest& request,
                       VolumeContents& contents);

// Returns what the attributes of a data set say of its samples. The arguments are those of
// PackedValues. Throws Error.
PackedValues values_in(hid_t set, const std::string& name, ValueType type, bool has_defaults);

// Describes an array by its attributes and dimension scales, and by attributes of its groups. Sets
// contents.is_colour.
DescribedArray describe_hdf5(Hdf5Files& files, const Hdf5Array& array, const Hdf5Layout& layout,
                             VolumeContents& contents);

}  // namespace lamina
