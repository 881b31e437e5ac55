// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "gl/handle.h"
#include "gl/shader_source.h"
#include "gl/uniform_value.h"

namespace lamina::gl {

// A vertex and a fragment shader, compiled and linked, which the Programs of a context share that
// have the same text: each has uniforms of its own, and OpenGL has those of one of them at a time.
class LinkedProgram {
  public:
    // Compile and link errors are Errors with the shader's name, the file and line, and the
    // defines.
    LinkedProgram(const ShaderSource& vertex, const ShaderSource& fragment);

    bool is_of(const ShaderSource& vertex, const ShaderSource& fragment) const;
    // -1 where the source names the uniform but this specialisation does not use it; a name that is
    // nowhere in the source is an Error.
    int location(std::string_view name);
    void set(int location, const UniformValue& value);
    // From now on OpenGL has the values of user number `user`, and 0 where it has set none.
    void give_to(std::uint64_t user, const std::map<int, UniformValue>& values);
    bool belongs_to(std::uint64_t user) const { return user_ == user; }

    unsigned id() const { return handle_.id(); }
    // Its context ends, which deletes it.
    void abandon() { handle_.release(); }

  private:
    Handle<ObjectKind::program> handle_;
    std::string names_;                        // of both shaders, for messages
    std::string vertex_text_, fragment_text_;  // to tell an unused uniform from a misspelt one, too
    std::map<std::string, int, std::less<>> locations_;
    std::map<int, UniformValue> values_;  // that OpenGL has, by location
    std::uint64_t user_ = 0;              // whose these are; 0: nobody's
};

}  // namespace lamina::gl
