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

// Tells whether a data set has its samples in other files, by HDF5's external storage or as a
// virtual data set.
bool stores_elsewhere(hid_t set);

// A data set of numbers in an open HDF5 file, with what is known of its axes.
class Hdf5Array {
  public:
    // `name`: of file and data set, for messages. Throws Error where it cannot be read, and where
    // it lies in another file though the client allows some only (base/client.h).
    Hdf5Array(hid_t file, const std::string& path, std::string name);

    const std::vector<std::int64_t>& shape() const { return shape_; }  // the last changes fastest
    ValueType type() const { return type_; }

    // A number, or several, of an attribute; nothing where there is none.
    std::vector<double> attribute(const char* key) const;
    // The coordinates of an axis that its dimension scale has; nothing where it has none.
    std::vector<double> scale_of(std::size_t axis) const;

    // Samples of a chunk along each axis; empty where the samples are not in chunks.
    std::vector<std::int64_t> chunk() const;

    struct RawPlace {
        std::int64_t offset;  // of the first sample in the file
        bool big_endian;
    };
    // Where the samples lie in the file as they are, one after the other; nothing where they do
    // not.
    std::optional<RawPlace> raw_place() const;

    // Whether the samples lie in another file than this one.
    bool lies_elsewhere(hid_t file) const;

    // Throws Error where the samples cannot be read: a filter is missing here, or the file's
    // `file_bytes` cannot hold the `bytes` that are to be read of them.
    void expect_readable(std::uint64_t bytes, std::uint64_t file_bytes) const;

    // Reads the samples begin .. begin + count - 1 of each axis. Throws Error.
    void read(std::vector<std::int64_t> begin, std::vector<std::int64_t> count, char* to) const;

  private:
    void expect_filters() const;

    std::string name_;
    Hdf5Handle set_;
    std::vector<std::int64_t> shape_;
    ValueType type_ = ValueType::uint8;
};

}  // namespace lamina
