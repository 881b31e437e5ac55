// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/value_type.h"
#include "volume_files/hdf5_handle.h"

namespace lamina {

// A data set of numbers in an open HDF5 file, with what is known of its axes.
class Hdf5Array {
  public:
    // `name`: of file and data set, for messages. Throws Error where it cannot be read.
    Hdf5Array(hid_t file, const std::string& path, std::string name);

    const std::vector<std::int64_t>& shape() const { return shape_; }  // the last changes fastest
    ValueType type() const { return type_; }

    // A number, or several, of an attribute; nothing where there is none.
    std::vector<double> attribute(const char* key) const;
    // The coordinates of an axis that its dimension scale has; nothing where it has none.
    std::vector<double> scale_of(std::size_t axis) const;

    // The last axes from `index` on: of the axes before these the index, of these all samples.
    // `file_bytes`: the length of the file. Throws Error.
    std::shared_ptr<void> read(const std::vector<std::int64_t>& index,
                               std::uint64_t file_bytes) const;

  private:
    void expect_filters() const;
    void read_slabs(const std::vector<std::int64_t>& index, char* to) const;
    std::int64_t slab_thickness(std::size_t axis, std::size_t slice_bytes) const;

    std::string name_;
    Hdf5Handle set_;
    std::vector<std::int64_t> shape_;
    ValueType type_ = ValueType::uint8;
};

}  // namespace lamina
