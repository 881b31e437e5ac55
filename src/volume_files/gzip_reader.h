// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include "volume_files/packed_reader.h"

namespace lamina {

// Decompresses gzip or zlib streams. (teem 1.12 does not notice a damaged or missing checksum.)
class GzipReader : public PackedReader {
  public:
    // Deflate codes at most 258 bytes in 2 bits (zlib, "Technical details").
    static constexpr std::uint64_t most_expansion = 1032;

    GzipReader(OpenedFile stream, std::string name);
    ~GzipReader() override;

  private:
    bool unpack(Input& from, Output& to) override;

    z_stream state_{};
};

}  // namespace lamina
