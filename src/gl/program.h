// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "gl/linked_program.h"
#include "gl/shader_source.h"

namespace lamina::gl {

// A linked vertex and fragment shader with uniforms of its own, 0 at first. Compile and link errors
// are Errors with the shader's name, the file and line, and the defines. Where the context has
// lately had one with the same text, nothing is compiled (gl/program_cache.h).
class Program {
  public:
    // `vertex_name`, `fragment_name`: files in shaders/. Both are specialised by the same defines.
    Program(const std::string& vertex_name, const std::string& fragment_name,
            const Defines& defines = {});
    Program(const ShaderSource& vertex, const ShaderSource& fragment);

    // For the draws that follow, with its uniforms.
    void use() const;

    // Set a uniform; the program need not be in use. A uniform that the source names but this
    // specialisation does not use (optimised out, or under another #if) is ignored. A name that is
    // nowhere in the source throws Error.
    void set(std::string_view name, float value);
    void set(std::string_view name, double value);  // of a uniform double
    void set(std::string_view name, int value);     // also a sampler's texture unit
    void set(std::string_view name, const glm::vec2& value);
    void set(std::string_view name, const glm::vec3& value);
    void set(std::string_view name, const glm::dvec2& value);
    void set(std::string_view name, const glm::dvec3& value);
    void set(std::string_view name, std::span<const glm::vec2> values);  // of an array
    void set(std::string_view name, std::span<const glm::vec4> values);
    void set(std::string_view name, std::span<const glm::dvec4> values);
    void set(std::string_view name, const glm::vec4& value);
    void set(std::string_view name, const glm::ivec2& value);
    void set(std::string_view name, const glm::ivec3& value);
    void set(std::string_view name, const glm::mat4& value);

    unsigned id() const { return linked_->id(); }

  private:
    void set(std::string_view name, UniformKind kind, std::size_t count, const void* data);

    std::shared_ptr<LinkedProgram> linked_;
    std::uint64_t user_;  // of the linked program
    std::map<int, UniformValue> values_;
};

}  // namespace lamina::gl
