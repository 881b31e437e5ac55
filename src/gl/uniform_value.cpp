// SPDX-License-Identifier: Apache-2.0
#include "gl/uniform_value.h"

#include <glad/gl.h>

#include <algorithm>

#include "base/enum_words.h"
#include "gl/api.h"

namespace lamina::gl {
namespace {

std::size_t bytes_of(UniformKind kind) {
    switch (kind) {
        case UniformKind::float1:
        case UniformKind::int1:
            return 4;
        case UniformKind::float2:
        case UniformKind::int2:
        case UniformKind::double1:
            return 8;
        case UniformKind::float3:
        case UniformKind::int3:
            return 12;
        case UniformKind::float4:
        case UniformKind::double2:
            return 16;
        case UniformKind::double3:
            return 24;
        case UniformKind::double4:
            return 32;
        case UniformKind::matrix4:
            return 64;
    }
    unreachable_enum();
}

}  // namespace

void UniformValue::assign(UniformKind kind, int count, const void* data) {
    kind_ = kind;
    count_ = count;
    const auto* const first = static_cast<const std::byte*>(data);
    bytes_.assign(first, first + bytes_of(kind) * static_cast<std::size_t>(count));
}

void UniformValue::clear() {
    std::ranges::fill(bytes_, std::byte{0});
}

void upload(unsigned program, int location, const UniformValue& value) {
    const void* const data = value.bytes_.data();
    const auto* const floats = static_cast<const GLfloat*>(data);
    const auto* const doubles = static_cast<const GLdouble*>(data);
    const auto* const ints = static_cast<const GLint*>(data);
    const GLsizei count = value.count_;
    switch (value.kind_) {
        case UniformKind::float1:
            return api().ProgramUniform1fv(program, location, count, floats);
        case UniformKind::float2:
            return api().ProgramUniform2fv(program, location, count, floats);
        case UniformKind::float3:
            return api().ProgramUniform3fv(program, location, count, floats);
        case UniformKind::float4:
            return api().ProgramUniform4fv(program, location, count, floats);
        case UniformKind::double1:
            return api().ProgramUniform1dv(program, location, count, doubles);
        case UniformKind::double2:
            return api().ProgramUniform2dv(program, location, count, doubles);
        case UniformKind::double3:
            return api().ProgramUniform3dv(program, location, count, doubles);
        case UniformKind::double4:
            return api().ProgramUniform4dv(program, location, count, doubles);
        case UniformKind::int1:
            return api().ProgramUniform1iv(program, location, count, ints);
        case UniformKind::int2:
            return api().ProgramUniform2iv(program, location, count, ints);
        case UniformKind::int3:
            return api().ProgramUniform3iv(program, location, count, ints);
        case UniformKind::matrix4:
            return api().ProgramUniformMatrix4fv(program, location, count, GL_FALSE, floats);
    }
    unreachable_enum();
}

}  // namespace lamina::gl
