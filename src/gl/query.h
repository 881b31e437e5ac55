// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gl/handle.h"

namespace lamina::gl {

// Counts what the draws between begin() and end() do; two queries of the same kind must not
// overlap. A timestamp has no span: stamp() asks when all that was submitted before is done.
class Query {
  public:
    enum class Kind { samples_passed, timestamp };

    explicit Query(Kind kind);

    void begin();
    void end();
    void stamp();
    std::uint64_t result() const;  // waits for the draws; nanoseconds of OpenGL's clock

  private:
    Kind kind_;
    Handle<ObjectKind::query> handle_;
};

}  // namespace lamina::gl
