// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <system_error>

namespace lamina {
namespace {

constexpr int most_links = 40;  // as Linux follows

// A link stays a link: what it leads to is written, and need not be there yet.
std::filesystem::path without_links(std::filesystem::path path) {
    std::error_code failure;
    for (int links = 0; std::filesystem::is_symlink(path, failure); ++links) {
        if (links == most_links)
            throw WriteError(path.string() + ": cannot write: links in a loop");
        const auto target = std::filesystem::read_symlink(path, failure);
        if (failure) throw WriteError(path.string() + ": cannot write: " + failure.message());
        path = path.parent_path() / target;
    }
    return path;
}

// Beside `path`; another each time, and other than those of this host's other processes.
std::filesystem::path name_beside(const std::filesystem::path& path) {
    static std::atomic<int> count = 0;
    const std::string suffix = fmt::format(".{}.{}.part", getpid(), count++);
    const std::string name = path.filename().string();
    return path.parent_path() / (name.substr(0, NAME_MAX - suffix.size()) + suffix);
}

std::string descriptor_path(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : path_(without_links(std::move(path))) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path_, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw WriteError(fmt::format(
            "{}: cannot write: it is {}, expected a regular file", path_.string(),
            std::filesystem::is_directory(status) ? "a directory" : "a device, pipe or socket"));
    }
    if (path_.filename().string().size() > NAME_MAX) give_up(ENAMETOOLONG);
    open_nameless();
    if (stream_ == nullptr) open_named();
}

AtomicFile::~AtomicFile() {
    if (stream_ != nullptr) std::fclose(stream_);
    if (nameless_ >= 0) close(nameless_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
}

// Leaves stream_ null where this cannot be done here.
void AtomicFile::open_nameless() {
    const std::string folder = path_.has_parent_path() ? path_.parent_path().string() : ".";
    nameless_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (nameless_ < 0) return;
    // Without /proc it could not get a name.
    const int copy = access(descriptor_path(nameless_).c_str(), F_OK) == 0
                         ? fcntl(nameless_, F_DUPFD_CLOEXEC, 0)
                         : -1;
    if (copy >= 0) stream_ = fdopen(copy, "wb");
    if (stream_ != nullptr) return;
    if (copy >= 0) close(copy);
    close(nameless_);
    nameless_ = -1;
}

void AtomicFile::open_named() {
    int descriptor = -1;
    do {
        temporary_ = name_beside(path_);
        descriptor = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor < 0 && errno == EEXIST);
    if (descriptor >= 0) stream_ = fdopen(descriptor, "wb");
    if (stream_ != nullptr) return;
    const int error = errno;
    if (descriptor >= 0) {
        close(descriptor);
        unlink(temporary_.c_str());
    }
    give_up(error);
}

void AtomicFile::write(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, stream_) != count) give_up(errno);
}

void AtomicFile::close_stream() {
    if (stream_ == nullptr) return;
    std::FILE* const stream = stream_;
    stream_ = nullptr;
    // Who wrote may have passed over an error: some libraries do in their destructors.
    const bool broken = std::ferror(stream) != 0;
    if (std::fclose(stream) != 0) give_up(errno);
    if (broken) give_up(EIO);
}

// A name that exists cannot be given: rename() can replace, but needs one to begin with.
void AtomicFile::give_name() {
    const std::string unnamed = descriptor_path(nameless_);
    std::filesystem::path name;
    int failure = 0;
    do {
        name = name_beside(path_);
        failure = linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
    } while (failure != 0 && errno == EEXIST);
    if (failure != 0) give_up(errno);
    temporary_ = name;
    close(nameless_);
    nameless_ = -1;
}

void AtomicFile::complete() {
    close_stream();
    if (nameless_ >= 0) give_name();
}

void AtomicFile::commit() {
    complete();
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) give_up(error.value());
    temporary_.clear();
}

void AtomicFile::give_up(int error) const {
    throw WriteError(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(error)));
}

}  // namespace lamina
