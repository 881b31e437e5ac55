// SPDX-License-Identifier: Apache-2.0
// NRRD files written by hand, byte by byte, for the reader's tests.
#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "support/expect_error.h"
#include "support/samples_of.h"
#include "support/temporary_folder.h"
#include "volume/nrrd_writer.h"
#include "volume_files/volume_formats.h"

namespace lamina::testing {

class WrittenFiles : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) {
        write_bytes_to(folder_ / name, bytes);
        return folder_ / name;
    }

    const std::filesystem::path& folder() const { return folder_.path(); }

    TemporaryFolder folder_;
};

template <typename T>
std::string bytes_of_values(const std::vector<T>& values, bool big_endian = false) {
    std::string bytes;
    for (const T& value : values) {
        char word[sizeof(T)];
        std::memcpy(word, &value,
                    sizeof(T));  // the tests, unlike the library, need a little-endian machine
        if (big_endian) std::reverse(word, word + sizeof(T));
        bytes.append(word, sizeof(T));
    }
    return bytes;
}

inline std::string gzip(const std::string& bytes) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, bytes.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

inline std::string bzip2(const std::string& bytes) {
    std::string packed(bytes.size() + bytes.size() / 100 + 600, '\0');  // libbz2's manual, 3.5.1
    auto size = static_cast<unsigned>(packed.size());
    BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()), 9, 0, 0);
    packed.resize(size);
    return packed;
}

inline void expect_bad(const std::filesystem::path& path,
                       std::initializer_list<std::string> parts) {
    expect_error([&] { open_nrrd(path); }, parts);
}

}  // namespace lamina::testing
