// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/error.h"

namespace lamina {

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code ignored;
    // A link stays a link: what it leads to is replaced.
    if (std::filesystem::is_symlink(path_, ignored))
        path_ = std::filesystem::weakly_canonical(path_, ignored);
    const auto status = std::filesystem::status(path_, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        fail("{}: cannot write: it is {}, expected a regular file", path_.string(),
             std::filesystem::is_directory(status) ? "a directory" : "a device, pipe or socket");
    }
    temporary_ = path_;
    temporary_ += fmt::format(".{}.part", getpid());
    const int descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
    stream_ = fdopen(descriptor, "wb");
    if (stream_ == nullptr) {
        close(descriptor);
        unlink(temporary_.c_str());
        fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
    }
}

AtomicFile::~AtomicFile() {
    if (stream_ != nullptr) std::fclose(stream_);
    if (!committed_) unlink(temporary_.c_str());
}

void AtomicFile::write(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, stream_) != count) {
        fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
    }
}

void AtomicFile::close_stream() {
    if (stream_ == nullptr) return;
    std::FILE* const stream = stream_;
    stream_ = nullptr;
    if (std::fclose(stream) != 0)
        fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
}

void AtomicFile::commit() {
    close_stream();
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) fail("{}: cannot write: {}", path_.string(), error.message());
    committed_ = true;
}

}  // namespace lamina
