// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gl/handle.h"

namespace lamina::gl {

// Counts events of the draws between begin() and end(). Two queries of the same kind must not
// overlap. A timestamp has no span: stamp() records when all commands submitted before it are done.
class Query {
  public:
    enum class Kind { samples_passed, timestamp };

    explicit Query(Kind kind);

    void begin();
    void end();
    void stamp();
    // Waits for the draws; a timestamp is in nanoseconds of OpenGL's clock.
    std::uint64_t result() const;

  private:
    Kind kind_;
    Handle<ObjectKind::query> handle_;
};

}  // namespace lamina::gl
