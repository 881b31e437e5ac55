// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include "volume/packed_reader.h"

namespace lamina {

// Decompresses gzip or zlib streams. (teem 1.12 does not notice a damaged or missing checksum.)
class GzipReader : public PackedReader {
  public:
    GzipReader(std::FILE* stream, std::string file);
    ~GzipReader() override;

  private:
    bool unpack(Input& from, Output& to) override;

    z_stream state_{};
};

}  // namespace lamina
