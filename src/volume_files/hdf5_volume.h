// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "lamina/grid.h"
#include "lamina/volume_request.h"
#include "volume/sample_source.h"
#include "volume_files/hdf5_array.h"

namespace lamina {

// What a process tells of a volume in an HDF5 file before it reads samples. It goes from process to
// process as it is.
struct Hdf5Head {
    Grid grid;
    ValueType type = ValueType::uint8;
    double scale = 1, offset = 0;                // of samples (StoredSamples)
    bool has_missing = false;                    // some values become NaN
    bool elsewhere = false;                      // the samples lie in another file
    std::array<std::int64_t, 3> chunk{0, 0, 0};  // samples along x, y and z; 0: not in chunks
    // Where all samples of the array, of which there may be more than the volume's, lie in the file
    // as they are; offset below 0: they do not.
    Hdf5Array::RawPlace raw{-1, false};
    std::array<std::int64_t, 2> outer{1, 1}, taken{0, 0};  // channels, times
};

// A volume in an HDF5 file, read by libhdf5.
class Hdf5Volume {
  public:
    // `array`: of the file; empty: the only one. Throws Error.
    Hdf5Volume(const std::string& file, const std::string& array, const VolumeRequest& request);

    const Hdf5Head& head() const { return head_; }
    // The bytes that libhdf5 unpacks at a time, however few are read: a chunk along all axes.
    std::size_t chunk_bytes() const { return chunk_bytes_; }
    // Reads a box of samples, in native byte order, x fastest; `is_all`: a warning counts what is
    // missing.
    void read(const SampleBox& box, bool is_all, void* to) const;

  private:
    void mark_missing(std::int64_t count, bool is_told, void* samples) const;

    Hdf5Handle file_;
    std::string path_;  // of the array, in the file
    std::string name_;
    Hdf5Array array_;
    std::vector<std::int64_t> index_;  // of the axes before the volume's
    Hdf5Head head_;
    std::size_t chunk_bytes_ = 0;
};

}  // namespace lamina
