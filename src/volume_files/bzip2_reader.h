// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bzlib.h>

#include "volume_files/packed_reader.h"

namespace lamina {

// Decompresses bzip2 streams. (teem 1.12 does not notice where the end is missing.)
class Bzip2Reader : public PackedReader {
  public:
    Bzip2Reader(OpenedFile stream, std::string name);
    ~Bzip2Reader() override;

  private:
    bool unpack(Input& from, Output& to) override;
    void begin_member();

    bz_stream state_{};
};

}  // namespace lamina
