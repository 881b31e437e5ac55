// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "volume/sample_source.h"
#include "volume_files/hdf5_layout.h"
#include "volume_files/packed_values.h"

namespace lamina {

// Describes a volume in an HDF5 file.
struct Hdf5Head {
    ArrayPlace place;
    std::vector<std::int64_t> shape;  // of the array
    ValueType type = ValueType::uint8;
    double scale = 1, offset = 0;                // as in StoredSamples
    std::array<std::int64_t, 3> chunk{0, 0, 0};  // samples along x, y and z; 0: not in chunks
    // Result of Hdf5Array::raw_place() for the whole array, if its samples are those of the volume
    // in the file's order. Its offset is -1 if there is no such place.
    Hdf5Array::RawPlace raw{-1, false};
    std::vector<std::string> files;  // the file itself, and those that the samples are in
    VolumeContents contents;
    Quantity quantity;

    // Return the head as bytes, by which an isolated process sends it, and the head of them.
    std::string bytes() const;
    static Hdf5Head of(std::string_view bytes);
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
    void place();
    void find_chunks();

    Hdf5Files files_;
    VolumeContents contents_;
    Hdf5Layout layout_;
    Hdf5Array array_;
    PackedValues values_;
    Hdf5Head head_;
    std::size_t chunk_bytes_ = 0;
};

}  // namespace lamina
