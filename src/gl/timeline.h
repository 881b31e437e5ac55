// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl/query.h"

namespace lamina::gl {

// OpenGL's row of a Profile (base/profile.h): when the context executed submitted commands. Does
// nothing where no Profile records, or where the context has no clock of its own.
class Timeline {
  public:
    // begin() and end() enclose the commands of one span; spans do not nest. `name`: a literal.
    void begin(const char* name);
    void end();
    // Waits for all spans and hands them to the Profile.
    void collect();

  private:
    struct Span {
        const char* name;
        Query begin{Query::Kind::timestamp}, end{Query::Kind::timestamp};
    };
    std::vector<Span> spans_;  // those from count_ on are reused
    std::size_t count_ = 0;
};

}  // namespace lamina::gl
