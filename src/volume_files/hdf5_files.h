// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "volume_files/hdf5_array.h"

namespace lamina {

// An open HDF5 file and those to which it leads: by external links, virtual data sets and external
// storage. libhdf5 opens no file before lamina has found that there is one and that the client
// allows it (base/client.h): lamina follows the links itself. For isolated processes.
class Hdf5Files {
  public:
    explicit Hdf5Files(const std::string& file);  // throws Error

    hid_t file() const { return files_.at(name_).id(); }
    const std::string& name() const { return name_; }
    // Returns the file and all that were found to belong to it, opened or not.
    const std::vector<std::string>& paths() const { return paths_; }

    // Open a data set by its path, and the files that its samples are in. Return an invalid handle
    // if there is none of this name. Throw Error. open_set() forgets all paths that were found
    // before.
    Hdf5Handle open_set(const std::string& path);
    Hdf5Handle open_beside(const std::string& path) { return open_in(name(), path, 0); }
    // Returns the numbers of the data set (numbers_in()), or none if there is no such data set.
    std::vector<double> numbers(const std::string& path, std::size_t count = 0) {
        const Hdf5Handle set = open_beside(path);
        return set.valid() ? numbers_in(set.id(), count) : std::vector<double>();
    }
    // Tells if a group or data set of this path is in the file itself.
    bool has(const std::string& path) const;
    // Opens a group in the file itself. Returns an invalid handle if there is none.
    Hdf5Handle group(const std::string& path) const;

    // Returns the paths of the arrays that can be a volume. Throws Error if groups are too deep.
    std::vector<std::string> arrays();
    // Finds all files that belong to the file, or to the data set `path` if it is not empty. Does
    // not open those that are missing or not allowed.
    void find_files(const std::string& path);

  private:
    Hdf5Handle open_in(const std::string& file, const std::string& path, int depth);
    std::string linked(const std::string& from, const std::string& name);
    std::string found(const std::string& from, const std::string& name);
    void expect_samples(const std::string& file, hid_t set, int depth);

    std::string name_;
    std::vector<std::string> paths_;
    std::map<std::string, Hdf5Handle> files_;
    std::set<std::pair<std::string, std::string>> checked_;  // files and paths of data sets
    Hdf5Handle access_;
};

}  // namespace lamina
