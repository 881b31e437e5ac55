// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "volume_files/hdf5_volume.h"
#include "volume_files/isolated_process.h"

namespace lamina {

// A volume in an HDF5 file: `array` as in the constructor of Hdf5Volume.
struct Hdf5Place {
    std::string file, array;
    VolumeRequest request;
};

// A process that reads an HDF5 file with libhdf5 (volume_files/isolated_process.h). One thread at a
// time asks it.
class Hdf5Process {
  public:
    explicit Hdf5Process(const Hdf5Place& place);  // throws Error

    const Hdf5Head& head() const { return head_; }
    // All samples, in memory that nothing is read into any more: not before or after read().
    std::shared_ptr<void> read_all();
    // A box of samples.
    void read(const SampleBox& box, void* to);

  private:
    // Memory that both processes see. Both take it alike, by what is asked.
    struct Shared {
        std::shared_ptr<void> memory;
        std::size_t bytes = 0;

        template <typename Taker>
        void* room(std::size_t wanted, Taker& taker) {
            if (wanted > bytes) {
                memory = taker.shared_memory(wanted);
                bytes = wanted;
            }
            return memory.get();
        }
    };

    static void serve(IsolatedLine& line, const Hdf5Place& place);
    void* read_shared(const SampleBox& box, bool is_all);

    IsolatedProcess process_;
    Hdf5Head head_;
    Shared shared_;
};

}  // namespace lamina
