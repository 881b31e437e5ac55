// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl/api.h"

namespace lamina::gl {

// Counts the samples that pass in draws between begin() and end(), or records the time at which all
// commands before stamp() are done. Intervals from begin() to end() must not overlap.
class Query {
  public:
    enum class Kind { samples_passed, timestamp };

    explicit Query(Kind kind);

    void begin();
    void end();
    void stamp();
    // Waits for the draws and returns the count; a timestamp is in nanoseconds of OpenGL's clock.
    std::uint64_t result() const;

  private:
    Kind kind_;
    Handle<ObjectKind::query> handle_;
};

// Records OpenGL's row of a Profile (base/profile.h): when the context executed submitted commands.
// Does nothing if no Profile records, or if the context has no clock of its own.
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
    std::vector<Span> spans_;  // the first count_ are in use, the others wait to be reused
    std::size_t count_ = 0;
};

}  // namespace lamina::gl
