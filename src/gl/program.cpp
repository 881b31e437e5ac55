// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <algorithm>
#include <cctype>

#include <glad/gl.h>
#include "base/enum_words.h"
#include "base/error.h"
#include "base/profile.h"
#include "gl/api.h"
#include "gl/context.h"

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

namespace {

using Shader = Handle<ObjectKind::shader>;

std::string describe(const Defines& defines) {
    std::string text;
    for (const auto& [name, value] : defines.list) {
        text += (text.empty() ? "" : " ") + name + '=' + value;
    }
    return text.empty() ? "no defines" : "defines " + text;
}

std::string compile_log(const Shader& shader) {
    GLint length = 0;
    api().GetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    api().GetShaderInfoLog(shader.id(), length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

std::string link_log(unsigned program) {
    GLint length = 0;
    api().GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    api().GetProgramInfoLog(program, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

Shader compile(GLenum stage, const ShaderSource& source) {
    Shader shader(api().CreateShader(stage));
    const char* text = source.text.c_str();
    api().ShaderSource(shader.id(), 1, &text, nullptr);
    api().CompileShader(shader.id());
    GLint compiled = GL_FALSE;
    api().GetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        fail("shader {} does not compile: {} ({})", source.name,
             readable_log(compile_log(shader), source), describe(source.defines));
    }
    return shader;
}

bool is_word_character(char c) {
    return c == '_' || std::isalnum(static_cast<unsigned char>(c));
}

bool mentions(const std::string& text, std::string_view word) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        const bool begins = at == 0 || !is_word_character(text[at - 1]);
        const bool ends = end == text.size() || !is_word_character(text[end]);
        if (begins && ends) return true;
    }
    return false;
}

std::string names_of(const ShaderSource& vertex, const ShaderSource& fragment) {
    return vertex.name + " + " + fragment.name;
}

}  // namespace

LinkedProgram::LinkedProgram(const ShaderSource& vertex, const ShaderSource& fragment)
    : handle_(api().CreateProgram()),
      names_(names_of(vertex, fragment)),
      vertex_text_(vertex.text),
      fragment_text_(fragment.text) {
    const Stage compiling("compile");
    const Shader vertex_shader = compile(GL_VERTEX_SHADER, vertex);
    const Shader fragment_shader = compile(GL_FRAGMENT_SHADER, fragment);
    api().AttachShader(id(), vertex_shader.id());
    api().AttachShader(id(), fragment_shader.id());
    api().LinkProgram(id());
    api().DetachShader(id(), vertex_shader.id());
    api().DetachShader(id(), fragment_shader.id());
    GLint linked = GL_FALSE;
    api().GetProgramiv(id(), GL_LINK_STATUS, &linked);
    if (!linked) {
        fail("shaders {} do not link: {} ({})", names_, one_line(link_log(id())),
             describe(fragment.defines));
    }
    check("making the program " + names_);
}

bool LinkedProgram::is_of(const ShaderSource& vertex, const ShaderSource& fragment) const {
    return fragment_text_ == fragment.text && vertex_text_ == vertex.text &&
           names_ == names_of(vertex, fragment);
}

int LinkedProgram::location(std::string_view name) {
    const auto known = locations_.find(name);
    if (known != locations_.end()) return known->second;
    const std::string owned(name);
    const int found = api().GetUniformLocation(id(), owned.c_str());
    const std::string_view base = name.substr(0, name.find_first_of(".["));
    if (found < 0 && !mentions(vertex_text_, base) && !mentions(fragment_text_, base))
        fail("shaders {} have no uniform {}", names_, name);
    locations_.emplace(owned, found);
    return found;
}

void LinkedProgram::set(int location, const UniformValue& value) {
    upload(id(), location, value);
    values_[location] = value;
}

void LinkedProgram::give_to(std::uint64_t user, const std::map<int, UniformValue>& values) {
    user_ = user;
    for (auto& [location, value] : values_) {
        if (values.contains(location)) continue;
        value.clear();
        upload(id(), location, value);
    }
    for (const auto& [location, value] : values) set(location, value);
}

ProgramCache::~ProgramCache() {
    for (const auto& program : programs_) program->abandon();
}

std::shared_ptr<LinkedProgram> ProgramCache::get(const ShaderSource& vertex,
                                                 const ShaderSource& fragment) {
    const auto found = std::ranges::find_if(
        programs_, [&](const auto& program) { return program->is_of(vertex, fragment); });
    if (found != programs_.end()) {
        programs_.splice(programs_.begin(), programs_, found);
        return programs_.front();
    }
    programs_.push_front(std::make_shared<LinkedProgram>(vertex, fragment));
    ++compiled_;
    if (programs_.size() > most_programs) programs_.pop_back();
    return programs_.front();
}

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
