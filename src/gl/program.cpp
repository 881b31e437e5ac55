// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <glad/gl.h>

#include "gl/api.h"
#include "gl/current_context.h"

namespace lamina::gl {

Program::Program(const std::string& vertex_name, const std::string& fragment_name,
                 const Defines& defines)
    : Program(compose_shader(vertex_name, defines), compose_shader(fragment_name, defines)) {}

Program::Program(const ShaderSource& vertex, const ShaderSource& fragment)
    : linked_(current_context()->programs().get(vertex, fragment)),
      user_(current_context()->programs().new_user()) {}

void Program::use() const {
    if (!linked_->belongs_to(user_)) linked_->give_to(user_, values_);
    api().UseProgram(id());
}

void Program::set(std::string_view name, UniformKind kind, std::size_t count, const void* data) {
    const int location = linked_->location(name);
    if (location < 0) return;
    UniformValue& value = values_[location];
    value.assign(kind, static_cast<int>(count), data);
    if (linked_->belongs_to(user_)) linked_->set(location, value);
}

void Program::set(std::string_view name, float value) {
    set(name, UniformKind::float1, 1, &value);
}

void Program::set(std::string_view name, double value) {
    set(name, UniformKind::double1, 1, &value);
}

void Program::set(std::string_view name, int value) {
    set(name, UniformKind::int1, 1, &value);
}

void Program::set(std::string_view name, const glm::vec2& value) {
    set(name, UniformKind::float2, 1, &value.x);
}

void Program::set(std::string_view name, const glm::vec3& value) {
    set(name, UniformKind::float3, 1, &value.x);
}

void Program::set(std::string_view name, const glm::dvec2& value) {
    set(name, UniformKind::double2, 1, &value.x);
}

void Program::set(std::string_view name, const glm::dvec3& value) {
    set(name, UniformKind::double3, 1, &value.x);
}

void Program::set(std::string_view name, const glm::vec4& value) {
    set(name, UniformKind::float4, 1, &value.x);
}

void Program::set(std::string_view name, const glm::ivec2& value) {
    set(name, UniformKind::int2, 1, &value.x);
}

void Program::set(std::string_view name, const glm::ivec3& value) {
    set(name, UniformKind::int3, 1, &value.x);
}

void Program::set(std::string_view name, const glm::mat4& value) {
    set(name, UniformKind::matrix4, 1, &value[0].x);
}

void Program::set(std::string_view name, std::span<const glm::vec2> values) {
    set(name, UniformKind::float2, values.size(), values.data());
}

void Program::set(std::string_view name, std::span<const glm::vec4> values) {
    set(name, UniformKind::float4, values.size(), values.data());
}

void Program::set(std::string_view name, std::span<const glm::dvec4> values) {
    set(name, UniformKind::double4, values.size(), values.data());
}

}  // namespace lamina::gl
