// SPDX-License-Identifier: Apache-2.0
#include "base/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "base/printable.h"

namespace lamina {
namespace {

void write_to_stderr(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

void make_streams_safe() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
        // Opened the other way round, reading from stdin and writing to the others fails. open()
        // returns the lowest free descriptor, which is this one.
        open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

void write_result(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        fail("cannot write to stdout: {}", std::strerror(errno));
}

void flush_results() {
    const bool broken = std::ferror(stdout) != 0;
    if (std::fflush(stdout) != 0) fail("cannot write to stdout: {}", std::strerror(errno));
    if (broken) fail("cannot write to stdout: not all of it could be written");
}

void write_message(const std::string& line) {
    const std::size_t end = line.ends_with('\n') ? line.size() - 1 : line.size();
    write_to_stderr(printable(line.substr(0, end)) + line.substr(end));
}

void replace_line(const std::string& line) {
    write_to_stderr("\r\033[K" + printable(line));
}

}  // namespace lamina
