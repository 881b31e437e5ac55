// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "volume_files/chunked_source.h"
#include "volume_files/file_state.h"
#include "volume_files/hdf5_process.h"

namespace lamina {

// Samples in the chunks of an HDF5 file, which processes of their own decode: one for each core, up
// to most_processes. They are started first of all, because this process has few threads then.
class Hdf5Source : public ChunkedSource {
  public:
    Hdf5Source(const Hdf5Place& place, std::unique_ptr<Hdf5Process> first);

    void check_unchanged() const override { file_.check_unchanged(); }
    std::filesystem::path main_file() const override;
    std::string name() const override;
    std::string identity() const override;

  private:
    void decode(std::int64_t chunk, const SampleBox& box, void* to) const override;
    std::unique_ptr<Hdf5Process> started() const;
    std::unique_ptr<Hdf5Process> take_process() const;
    void give_back(std::unique_ptr<Hdf5Process> process) const;

    static constexpr unsigned most_processes = 16;

    Hdf5Place place_;
    FileState file_;
    Hdf5Head head_;
    mutable std::mutex access_;
    mutable std::condition_variable given_back_;
    mutable std::vector<std::unique_ptr<Hdf5Process>> idle_;
    mutable unsigned lost_ = 0;  // processes that have to be started anew
};

}  // namespace lamina
