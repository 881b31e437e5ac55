// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/value_type.h"
#include "lamina/volume.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// The file and the array ("/PATH") of a path "FILE.h5:/PATH". `array` is empty for a plain file.
struct ArrayPath {
    std::filesystem::path file;
    std::string array;
};

ArrayPath array_path(const std::filesystem::path& path);

// An axis of an array of HDF5 or NetCDF, as the file describes it.
struct ArrayAxis {
    std::int64_t size = 1;
    std::string name;                 // empty: the file does not name it
    std::vector<std::string> kinds;   // other words for what it is, such as a "standard_name"
    std::string unit;                 // its coordinates' unit
    std::vector<double> coordinates;  // one a sample, or none
};

// An array as the file describes it. `steps` and `firsts` are for the axes in space, in the array's
// order: the distance of samples and the place of the first one; one number is for all; empty: 1
// and 0.
struct DescribedArray {
    std::string name;  // file and array, for messages
    std::vector<ArrayAxis> axes;
    std::vector<double> steps, firsts;
    std::string unit;         // of steps and firsts
    std::string coordinates;  // the attribute with names of coordinates that several axes share
};

// Adds what attributes of an axis's coordinates say (CF conventions, sections 4 and 4.1 to 4.4).
// `text` returns an attribute, or nothing.
void add_attributes(ArrayAxis& axis, const std::function<std::string(const char* key)>& text);

// Attributes that name the axes of an array, in its order.
constexpr const char* axis_name_keys[] = {"_ARRAY_DIMENSIONS", "axes", "axis_names", "axisLabels",
                                          "axis_labels",       "dims", "dimorder"};

// The attributes of an array, or of a group that it is in; each returns nothing if there is none.
struct ArrayAttributes {
    std::function<std::vector<double>(const std::string& key)> numbers;
    std::function<std::string(const std::string& key)> text;
    bool is_own;  // the array's
};

// Adds the distances and places that attributes give under the names that common programs use,
// unless the array has some already. Says how they are taken.
void add_lengths(DescribedArray& array, const ArrayAttributes& attributes);

// Tells how a volume lies in an array.
struct ArrayPlace {
    std::array<int, 3> axes{-1, -1, -1};  // the array's axes along x, y and z; -1: none, one sample
    std::vector<std::int64_t> index;      // on each axis of the array; those in `axes` do not count
    Grid grid;

    // Tells if the array's axes along x, y and z are its fastest, next and slowest one.
    bool is_in_order() const;
};

// Tells if the last of four or five axes that a file does not name counts channels: it has 2 to 4
// entries, and the one that would count them otherwise has not: the first of four, unless the
// request names a time, or the second of five. Says so. Else unnamed_axis() takes the first of
// four, and five are said by say_five_axes(). `file`: for messages.
bool ends_with_channels(const std::string& file, const std::vector<std::int64_t>& shape,
                        const VolumeRequest& request);
void say_five_axes(const std::string& file);

// Finds x, y, z, channel and time by the names and attributes of axes (CF conventions, section 4),
// else by their order, z y x with times and channels before them; takes channel and time of the
// request; places the samples. Fills `contents`. Says what it had to assume. Throws Error.
ArrayPlace place_array(const DescribedArray& array, const VolumeRequest& request,
                       VolumeContents& contents);

// Copies samples of an array's box, whose axes have `counts` samples each, the last one fastest, so
// that x is fastest, then y, then z. `index` is taken on the axes that are not in space.
void copy_in_order(ValueType type, const std::array<int, 3>& axes,
                   const std::vector<std::int64_t>& counts, const std::vector<std::int64_t>& index,
                   const void* from, void* to);

// Returns names of arrays as messages list them, and the only one. Throws Error if there is not
// one. `file`: for messages.
std::string names_text(const std::vector<std::string>& arrays);
std::string only_array(const std::vector<std::string>& arrays, const std::string& file);

[[noreturn]] void fail_as_minc(const std::string& file);

}  // namespace lamina
