// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/value_type.h"

namespace lamina {

// Owns an object of the HDF5 library and closes it at the end. A negative id stands for no object.
class Hdf5Handle {
  public:
    using Closer = herr_t (*)(hid_t);

    Hdf5Handle(hid_t id, Closer close) : id_(id), close_(close) {}
    Hdf5Handle(Hdf5Handle&& other) noexcept
        : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Hdf5Handle() {
        if (id_ >= 0) close_(id_);
    }

    hid_t id() const { return id_; }
    bool valid() const { return id_ >= 0; }

  private:
    hid_t id_;
    Closer close_;
};

// Lets libhdf5 read LZF, h5py's own compression, unless it can already: h5py in this process
// registers a filter that writes, too.
void add_lzf_filter();

// Return an attribute of a group or data set: its numbers, up to 64, and their type; its texts; its
// texts one after another, because Imaris stores each letter as one; or nothing.
std::vector<double> numbers_of(hid_t object, const std::string& key);
std::optional<ValueType> type_of(hid_t object, const std::string& key);
std::vector<std::string> texts_of(hid_t object, const std::string& key);
std::string text_of(hid_t object, const std::string& key);

// Returns the numbers of a whole data set if it has `count` of them (0: up to 64), else none.
std::vector<double> numbers_in(hid_t set, std::size_t count = 0);

// Tells if the samples of a data set are in other data sets, which may be in other files.
bool is_virtual(hid_t set);
// Tells if the samples of a data set may be in other files.
bool stores_elsewhere(hid_t set);

// Returns the type of a data set's samples, if they are numbers that lamina reads.
std::optional<ValueType> type_in(hid_t set);

// Returns the number of axes of a data set; negative if it is no array.
int rank_of(hid_t set);
// Tell if an array has as many axes as a volume has, and if it has numbers, too.
bool has_axes_of_volume(hid_t set);
bool can_be_volume(hid_t set);

// An open data set of numbers.
class Hdf5Array {
  public:
    // `name`: file and data set, for messages. Throws Error if the data set cannot be read.
    Hdf5Array(Hdf5Handle set, std::string name);

    hid_t id() const { return set_.id(); }
    const std::string& name() const { return name_; }
    const std::vector<std::int64_t>& shape() const { return shape_; }  // the last changes fastest
    ValueType type() const { return type_; }

    // Returns the samples of a chunk along each axis, or none if the array is not in chunks.
    std::vector<std::int64_t> chunk() const;

    struct RawPlace {
        std::int64_t offset;  // of the first sample, in bytes of the file
        bool big_endian;
    };
    // Returns where the samples lie in the file, if contiguous, not packed and not to be converted.
    std::optional<RawPlace> raw_place() const;

    // Throws Error if the samples cannot be read: a filter is missing here, or the files'
    // `file_bytes` cannot hold the `bytes` that are to be read.
    void expect_readable(std::uint64_t bytes, std::uint64_t file_bytes) const;

    // Reads the samples begin .. begin + count - 1 of each axis. Throws Error.
    void read(const std::vector<std::int64_t>& begin, const std::vector<std::int64_t>& count,
              void* to) const;

  private:
    std::size_t stored_chunk_bytes() const;
    void expect_filters() const;

    std::string name_;
    Hdf5Handle set_;
    std::vector<std::int64_t> shape_;
    ValueType type_ = ValueType::uint8;
    hid_t memory_type_ = H5T_NATIVE_UINT8;  // in which HDF5 stores samples of type_
};

}  // namespace lamina
