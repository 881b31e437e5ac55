// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <cerrno>
#include <cstring>

namespace lamina {

void OutputFile::write(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, stream_) != count) give_up(errno);
}

void OutputFile::give_up(int error) const {
    throw WriteError(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(error)));
}

}  // namespace lamina
