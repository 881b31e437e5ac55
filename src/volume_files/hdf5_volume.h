// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/value_type.h"
#include "lamina/volume.h"
#include "volume/sample_source.h"

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
    ~Hdf5Handle() {
        if (id_ >= 0) close_(id_);
    }

    hid_t id() const { return id_; }
    bool valid() const { return id_ >= 0; }

  private:
    hid_t id_;
    Closer close_;
};

// Tells if a data set has its samples in other files: external storage, or a virtual data set.
bool stores_elsewhere(hid_t set);

// A data set of numbers in an open HDF5 file, with what is known of its axes.
class Hdf5Array {
  public:
    // `name`: file and data set, for messages. Throws Error if the data set cannot be read, or if
    // it lies in another file and the client allows only some files (base/client.h).
    Hdf5Array(hid_t file, const std::string& path, std::string name);

    const std::vector<std::int64_t>& shape() const { return shape_; }  // the last changes fastest
    ValueType type() const { return type_; }

    // Returns the numbers of an attribute, or none.
    std::vector<double> attribute(const char* key) const;
    // Returns the coordinates that the dimension scale of an axis has, or none.
    std::vector<double> scale_of(std::size_t axis) const;

    // Returns the samples of a chunk along each axis, or none if the array is not in chunks.
    std::vector<std::int64_t> chunk() const;

    struct RawPlace {
        std::int64_t offset;  // of the first sample, in bytes of the file
        bool big_endian;
    };
    // Returns where the samples lie in the file, if contiguous, not packed and not to be converted.
    std::optional<RawPlace> raw_place() const;

    bool lies_elsewhere(hid_t file) const;

    // Throws Error if the samples cannot be read: a filter is missing here, or the file's
    // `file_bytes` cannot hold the `bytes` that are to be read.
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

// Describes a volume. The isolated process sends it first, byte for byte as it lies in memory.
struct Hdf5Head {
    Grid grid;
    ValueType type = ValueType::uint8;
    double scale = 1, offset = 0;                // as in StoredSamples
    bool has_missing = false;                    // values that mark missing samples become NaN
    bool elsewhere = false;                      // the samples lie in another file
    std::array<std::int64_t, 3> chunk{0, 0, 0};  // samples along x, y and z; 0: not in chunks
    // Result of Hdf5Array::raw_place(), for all samples of the array: the volume's, and those of
    // other channels and times. Its offset is -1 if there is no such place.
    Hdf5Array::RawPlace raw{-1, false};
    // Number of channels [0] and times [1], and the index of each that is read.
    std::array<std::int64_t, 2> outer{1, 1}, taken{0, 0};
};

// A volume in an HDF5 file, read by libhdf5.
class Hdf5Volume {
  public:
    // `array`: its path in the file; empty: the only one. Throws Error.
    Hdf5Volume(const std::string& file, const std::string& array, const VolumeRequest& request);

    const Hdf5Head& head() const { return head_; }
    // Returns the bytes of a chunk along all axes of the array, which libhdf5 unpacks at once even
    // if few samples are read; 0 if the array is not in chunks.
    std::size_t chunk_bytes() const { return chunk_bytes_; }
    // Reads a box, in native byte order, x fastest. `is_all`: a warning counts missing samples.
    void read(const SampleBox& box, bool is_all, void* to) const;

  private:
    void mark_missing(std::int64_t count, bool reports, void* samples) const;

    Hdf5Handle file_;
    std::string path_;  // the array's, in the file
    std::string name_;
    Hdf5Array array_;
    std::vector<std::int64_t> index_;  // indices on the axes before z: time, channel
    Hdf5Head head_;
    std::size_t chunk_bytes_ = 0;
};

}  // namespace lamina
