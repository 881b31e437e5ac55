// SPDX-License-Identifier: Apache-2.0
#include "base/piped_file.h"

#include <array>
#include <cerrno>

#include "base/standard_streams.h"

namespace lamina {

PipedFile::PipedFile() : OutputFile("stdout") {
    stream_ = file_.stream();
}

void PipedFile::commit() {
    // Some libraries write in their destructors and pass over errors there, so the stream is asked.
    if (std::ferror(stream_) != 0) give_up(EIO);
    file_.rewind();
    std::array<char, 1 << 16> bytes{};
    for (std::size_t count = bytes.size(); count == bytes.size();) {
        count = std::fread(bytes.data(), 1, bytes.size(), stream_);
        write_result({bytes.data(), count});
    }
    if (std::ferror(stream_) != 0) give_up(errno);
    flush_results();
}

}  // namespace lamina
