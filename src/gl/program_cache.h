// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <list>
#include <memory>

#include "gl/linked_program.h"

namespace lamina::gl {

// The linked programs that a context has lately used: what is made again is not compiled again.
class ProgramCache {
  public:
    static constexpr std::size_t most_programs = 64;

    ProgramCache() = default;
    // Its context ends, which deletes them.
    ~ProgramCache();
    ProgramCache(const ProgramCache&) = delete;
    ProgramCache& operator=(const ProgramCache&) = delete;

    // Compiles it where it is not there; the one used longest ago goes where there are too many.
    std::shared_ptr<LinkedProgram> get(const ShaderSource& vertex, const ShaderSource& fragment);
    std::uint64_t new_user() { return ++last_user_; }

    int compiled() const { return compiled_; }  // so many until now

  private:
    std::list<std::shared_ptr<LinkedProgram>> programs_;  // last used first
    std::uint64_t last_user_ = 0;
    int compiled_ = 0;
};

}  // namespace lamina::gl
