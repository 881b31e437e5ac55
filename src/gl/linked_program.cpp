// SPDX-License-Identifier: Apache-2.0
#include "gl/linked_program.h"

#include <glad/gl.h>

#include <cctype>

#include "base/error.h"
#include "base/profile.h"
#include "gl/api.h"
#include "gl/check.h"

namespace lamina::gl {
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

}  // namespace lamina::gl
