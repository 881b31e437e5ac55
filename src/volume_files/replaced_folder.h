// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace lamina {

// A folder that is written beside its destination, as NAME.part, and takes its place when it is
// complete; without commit() it disappears.
class ReplacedFolder {
  public:
    // Throws Error where the destination is a folder that is no Zarr array, or another command
    // writes it now. What a killed command has left is removed.
    explicit ReplacedFolder(std::filesystem::path path);
    ~ReplacedFolder();
    ReplacedFolder(const ReplacedFolder&) = delete;
    ReplacedFolder& operator=(const ReplacedFolder&) = delete;

    const std::filesystem::path& temporary() const { return temporary_; }
    void commit();  // throws Error

  private:
    std::filesystem::path path_, temporary_;
    int lock_ = -1;
    bool committed_ = false;
};

}  // namespace lamina
