// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace lamina {

// The bytes of a file's data from first to last, whatever way they are stored. All throw Error,
// which names the file, where there are fewer bytes than asked for or they are damaged; long work
// ends when its client requests a stop.
class ByteReader {
  public:
    ByteReader() = default;
    virtual ~ByteReader() = default;
    ByteReader(const ByteReader&) = delete;
    ByteReader& operator=(const ByteReader&) = delete;

    virtual void read(void* bytes, std::size_t count) = 0;
    virtual void skip(std::size_t count) = 0;
    // Must be called once all is read: verifies what follows, such as checksums, and returns what
    // the file has more, in words that go before "than the header promises". Mostly none.
    virtual std::vector<std::string> surplus() = 0;
};

}  // namespace lamina
