// SPDX-License-Identifier: Apache-2.0
#include "base/temporary_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/error.h"

namespace lamina {
namespace {

[[noreturn]] void give_up(int error) {
    fail("{}: cannot write temporary files: {}: set TMPDIR to a folder with room for them",
         temporary_folder(), std::strerror(error));
}

int open_nameless(const std::string& folder) {
    const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0) return descriptor;
    std::string name = folder + "/lamina-XXXXXX";  // some file systems have no O_TMPFILE
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) unlink(name.c_str());
    return named;
}

}  // namespace

std::string temporary_folder() {
    const char* const named = std::getenv("TMPDIR");
    return named != nullptr && *named != '\0' ? named : "/tmp";
}

TemporaryFile::TemporaryFile() {
    const int descriptor = open_nameless(temporary_folder());
    if (descriptor < 0) give_up(errno);
    stream_ = fdopen(descriptor, "w+b");
    if (stream_ != nullptr) return;
    const int error = errno;
    close(descriptor);
    give_up(error);
}

void TemporaryFile::write(const void* bytes, std::size_t count) {
    if (std::fwrite(bytes, 1, count, stream_) != count) give_up(errno);
}

void TemporaryFile::rewind() {
    if (std::fflush(stream_) != 0 || std::fseek(stream_, 0, SEEK_SET) != 0) give_up(errno);
}

}  // namespace lamina
