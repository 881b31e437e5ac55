// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl/query.h"

namespace lamina::gl {

// OpenGL's row of a Profile (base/profile.h): when the context did what was submitted. Does nothing
// where none records, or where the context has no clock of its own.
class Timeline {
  public:
    // Around what one span is to cover; spans do not nest. `name`: a literal.
    void begin(const char* name);
    void end();
    // Waits for all of it and hands it to the Profile.
    void collect();

  private:
    struct Span {
        const char* name;
        Query begin{Query::Kind::timestamp}, end{Query::Kind::timestamp};
    };
    std::vector<Span> spans_;  // those after count_ are to be used again
    std::size_t count_ = 0;
};

}  // namespace lamina::gl
