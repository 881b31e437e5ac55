// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gl/handle.h"

namespace lamina::gl {

// Counts what the draws between begin() and end() do. Two queries of the same kind must not
// overlap.
class Query {
  public:
    enum class Kind { samples_passed, nanoseconds };

    explicit Query(Kind kind);

    void begin();
    void end();
    std::uint64_t result() const;  // waits for the draws

  private:
    Kind kind_;
    Handle<ObjectKind::query> handle_;
};

}  // namespace lamina::gl
