// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include "gl/api.h"
#include "gl/shader_source.h"

namespace lamina::gl {

enum class UniformKind {
    float1,
    float2,
    float3,
    float4,
    double1,
    double2,
    double3,
    double4,
    int1,
    int2,
    int3,
    matrix4
};

// The value of a uniform, or the values of an array.
class UniformValue {
  public:
    UniformValue() = default;
    // Copies `count` values.
    void assign(UniformKind kind, int count, const void* data);
    void clear();  // to 0

    friend void upload(unsigned program, int location, const UniformValue& value);

  private:
    UniformKind kind_ = UniformKind::float1;
    int count_ = 0;
    std::vector<std::byte> bytes_;
};

void upload(unsigned program, int location, const UniformValue& value);

// A vertex and a fragment shader, compiled and linked. All Programs of a context with the same text
// share it. Each Program has uniforms of its own, and OpenGL holds those of one Program at a time,
// its user.
class LinkedProgram {
  public:
    // Throws Error with the shader's name, file and line, and the defines if it does not compile or
    // link.
    LinkedProgram(const ShaderSource& vertex, const ShaderSource& fragment);

    bool is_of(const ShaderSource& vertex, const ShaderSource& fragment) const;
    // Returns a uniform's location, or -1 if the source names the uniform but this specialisation
    // does not use it. Throws Error for a name that is nowhere in the source.
    int location(std::string_view name);
    void set(int location, const UniformValue& value);
    // Gives OpenGL the values of user number `user`, and 0 for uniforms that it has not set.
    void give_to(std::uint64_t user, const std::map<int, UniformValue>& values);
    bool belongs_to(std::uint64_t user) const { return user_ == user; }

    unsigned id() const { return handle_.id(); }
    // Gives the program up without deleting it: the end of its context deletes it.
    void abandon() { handle_.release(); }

  private:
    Handle<ObjectKind::program> handle_;
    std::string names_;                        // names of both shaders, for messages
    std::string vertex_text_, fragment_text_;  // also tell an unused uniform from a misspelt one
    std::map<std::string, int, std::less<>> locations_;
    std::map<int, UniformValue> values_;  // values that OpenGL has, by location
    std::uint64_t user_ = 0;              // the user whose values these are; 0: none
};

// The linked programs that a context has used lately, so that a program that is made again is not
// compiled again.
class ProgramCache {
  public:
    static constexpr std::size_t most_programs = 64;

    ProgramCache() = default;
    // Gives the programs up without deleting them: the end of their context deletes them.
    ~ProgramCache();
    ProgramCache(const ProgramCache&) = delete;
    ProgramCache& operator=(const ProgramCache&) = delete;

    // Returns a program, compiling it if it is not there. If there are too many, the one used
    // longest ago goes.
    std::shared_ptr<LinkedProgram> get(const ShaderSource& vertex, const ShaderSource& fragment);
    std::uint64_t new_user() { return ++last_user_; }

    int compiled() const { return compiled_; }  // programs compiled so far

  private:
    std::list<std::shared_ptr<LinkedProgram>> programs_;  // last used first
    std::uint64_t last_user_ = 0;
    int compiled_ = 0;
};

// A linked vertex and fragment shader with uniforms of its own, 0 at first. Throws Error with the
// shader's name, file and line, and the defines if it does not compile or link. Nothing is compiled
// if the context has lately had a program with the same text (ProgramCache).
class Program {
  public:
    // `vertex_name`, `fragment_name`: files in shaders/. Both are specialised by the same defines.
    Program(const std::string& vertex_name, const std::string& fragment_name,
            const Defines& defines = {});
    Program(const ShaderSource& vertex, const ShaderSource& fragment);

    // Makes this the program of the draws that follow, with its uniforms.
    void use() const;

    // Set a uniform; the program need not be in use. A uniform that the source names but this
    // specialisation does not use (optimised out, or under another #if) is ignored. Throw Error for
    // a name that is nowhere in the source.
    void set(std::string_view name, float value);
    void set(std::string_view name, double value);  // for a uniform double
    void set(std::string_view name, int value);     // also a sampler's texture unit
    void set(std::string_view name, const glm::vec2& value);
    void set(std::string_view name, const glm::vec3& value);
    void set(std::string_view name, const glm::dvec2& value);
    void set(std::string_view name, const glm::dvec3& value);
    void set(std::string_view name, std::span<const glm::vec2> values);  // for an array
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
    std::uint64_t user_;  // this one's number among the linked program's users
    std::map<int, UniformValue> values_;
};

}  // namespace lamina::gl
