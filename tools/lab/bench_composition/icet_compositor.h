// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/image.h"

namespace lamina {

// Composites by IceT, with its own choice of algorithm.
class IcetCompositor {
  public:
    enum class Format { float32, bytes };

    IcetCompositor(Format format, int width, int height);
    ~IcetCompositor();
    IcetCompositor(const IcetCompositor&) = delete;
    IcetCompositor& operator=(const IcetCompositor&) = delete;

    // All ranks call it; on rank 0 `picture` becomes that of all. `order`: nearer ranks first.
    void compose(const std::vector<int>& order, Image& picture);
    std::int64_t bytes_sent() const { return bytes_sent_; }  // by this rank in the last call

  private:
    struct Contexts;
    Format format_;
    Contexts* contexts_;
    std::vector<std::uint8_t> bytes_;
    std::int64_t bytes_sent_ = 0;
};

}  // namespace lamina
