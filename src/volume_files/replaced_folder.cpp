// SPDX-License-Identifier: Apache-2.0
#include "volume_files/replaced_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/error.h"
#include "base/output_file.h"

namespace lamina {

ReplacedFolder::ReplacedFolder(std::filesystem::path path)
    : path_(std::move(path)), temporary_(path_.string() + ".part") {
    std::error_code absent;
    if (std::filesystem::exists(path_, absent) && !std::filesystem::exists(path_ / ".zarray"))
        fail("{}: found a folder that lamina has not written, expected none", path_.string());
    make_folder(temporary_);
    lock_ = open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        if (lock_ >= 0) close(lock_);
        fail("{}: another command writes it now", temporary_.string());
    }
    for (const auto& left : std::filesystem::directory_iterator(temporary_, absent))
        std::filesystem::remove_all(left.path(), absent);
}

ReplacedFolder::~ReplacedFolder() {
    std::error_code absent;
    if (!committed_) std::filesystem::remove_all(temporary_, absent);
    close(lock_);
}

void ReplacedFolder::commit() {
    const std::filesystem::path old = path_.string() + ".old";
    std::error_code error, absent;
    std::filesystem::remove_all(old, absent);
    if (std::filesystem::exists(path_, absent)) std::filesystem::rename(path_, old, error);
    if (!error) std::filesystem::rename(temporary_, path_, error);
    if (error) fail("{}: cannot write: {}", path_.string(), error.message());
    committed_ = true;
    std::filesystem::remove_all(old, absent);
}

}  // namespace lamina
