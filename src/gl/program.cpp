// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <fmt/ranges.h>
#include <glad/gl.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "base/error.h"
#include "base/profile.h"
#include "gl/context.h"

namespace lamina::gl {

namespace {

std::optional<std::string> find_in_override(const std::string& name) {
    const char* directory = std::getenv("LAMINA_SHADER_DIR");
    if (!directory || !*directory) return std::nullopt;
    std::error_code ignored;
    if (!std::filesystem::is_directory(directory, ignored))
        fail("{}: no such folder (LAMINA_SHADER_DIR)", directory);
    const std::filesystem::path path = std::filesystem::path(directory) / name;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) fail("{}: cannot be read (LAMINA_SHADER_DIR)", path.string());
    return text;
}

// Returns the word after the line's '#', such as "include", or "" if it is no directive. A regular
// expression for each line would take more time than all else that composes a shader.
std::string directive_of(const std::string& line) {
    constexpr const char* space = " \t\v\f\r\n";
    const std::size_t sign = line.find_first_not_of(space);
    if (sign == std::string::npos || line[sign] != '#') return {};
    const std::size_t first = line.find_first_not_of(space, sign + 1);
    if (first == std::string::npos) return {};
    const auto is_of_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    return {line.begin() + static_cast<std::ptrdiff_t>(first),
            std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(first), line.end(),
                             is_of_word)};
}

// Composes one shader (compose_shader()).
struct Composer {
    const ShaderFinder& find;
    ShaderSource& source;
    std::vector<std::string> open = {};  // files being included, each by the one before
    std::map<std::string, std::size_t> guards = {};
    bool has_version = false;

    void append_main() {
        append_file(source.name, "shader");
        if (!has_version) fail_without_version();
    }

    // `wanted_by` begins the message if the file is missing.
    void append_file(const std::string& name, const std::string& wanted_by) {
        const std::optional<std::string> text = find(name);
        if (!text) fail("{}: no such shader file: {}", wanted_by, name);
        open.push_back(name);
        std::istringstream lines(*text);
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) append_line(line, {name, number});
        open.pop_back();
    }

    void append_line(const std::string& line, const ShaderLine& place) {
        const std::string directive = directive_of(line);
        if (!has_version && !directive.empty()) {
            append_version(line, place);
        } else if (directive == "include") {
            append_include(line, place);
        } else {
            append_text(line, place);
        }
    }

    void append_text(const std::string& line, const ShaderLine& place) {
        source.text += line + '\n';
        source.lines.push_back(place);
    }

    void append_version(const std::string& line, const ShaderLine& place) {
        static const std::regex pattern("^\\s*#\\s*version\\s+450\\s+core\\s*(//.*)?$");
        if (!std::regex_match(line, pattern)) fail_without_version();
        has_version = true;
        append_text("#version 450 core", place);
        // Without this pragma NVIDIA's compiler turns (1 - p) - q into 1 - (p + q), and small
        // opacities lose their digits. Other compilers ignore it (GLSL 4.50, 3.3).
        append_text("#pragma optionNV(fastmath off)", place);
        // Extensions stand in front of all else. A driver that has one defines its name.
        append_text("#ifdef GL_ARB_shader_group_vote", place);
        append_text("#extension GL_ARB_shader_group_vote : enable", place);
        append_text("#endif", place);
        for (const auto& [name, value] : source.defines.list)
            append_text("#define " + name + ' ' + value, place);
    }

    [[noreturn]] void fail_without_version() const {
        fail("shader {}: expected '#version 450 core' as the first directive", source.name);
    }

    void append_include(const std::string& line, const ShaderLine& place) {
        static const std::regex pattern("^\\s*#\\s*include\\s*\"([^\"]+)\"\\s*(//.*)?$");
        const std::string where = fmt::format("shader {}:{}", place.file, place.number);
        std::smatch match;
        if (!std::regex_match(line, match, pattern))
            fail("{}: expected #include \"FILE\", found '{}'", where, one_line(line));
        const std::string name = match[1];
        if (std::find(open.begin(), open.end(), name) != open.end())
            fail("{}: {} includes itself: {} -> {}", where, name, fmt::join(open, " -> "), name);
        // The preprocessor drops repeated includes: only it knows which #if branches are taken.
        const std::string guard = guard_of(name);
        append_text("#ifndef " + guard, place);
        append_text("#define " + guard, place);
        append_file(name, where);
        append_text("#endif", place);
    }

    std::string guard_of(const std::string& name) {
        const auto number = guards.try_emplace(name, guards.size()).first->second;
        return fmt::format("INCLUDED_FILE_{}", number);
    }
};

// Tables of OpenGL's functions that set a uniform, by its number of components.
using Gl = GladGLContext;
constexpr std::array float_setters{&Gl::ProgramUniform1fv, &Gl::ProgramUniform2fv,
                                   &Gl::ProgramUniform3fv, &Gl::ProgramUniform4fv};
constexpr std::array double_setters{&Gl::ProgramUniform1dv, &Gl::ProgramUniform2dv,
                                    &Gl::ProgramUniform3dv, &Gl::ProgramUniform4dv};
constexpr std::array int_setters{&Gl::ProgramUniform1iv, &Gl::ProgramUniform2iv,
                                 &Gl::ProgramUniform3iv};

template <typename Number>
constexpr const auto& setters_of() {
    if constexpr (std::is_same_v<Number, float>)
        return float_setters;
    else if constexpr (std::is_same_v<Number, double>)
        return double_setters;
    else
        return int_setters;
}

void upload(unsigned program, int location, const UniformValue& value) {
    const auto set = [&]<typename Value>(const std::vector<Value>& values) {
        const auto count = static_cast<GLsizei>(values.size());
        const void* const data = values.data();
        if constexpr (std::is_same_v<Value, glm::mat4>) {
            const auto* const numbers = static_cast<const GLfloat*>(data);
            api().ProgramUniformMatrix4fv(program, location, count, GL_FALSE, numbers);
        } else if constexpr (std::is_arithmetic_v<Value>) {
            (api().*setters_of<Value>()[0])(program, location, count, values.data());
        } else {
            using Number = typename Value::value_type;
            const auto setter = setters_of<Number>()[std::size_t{Value::length()} - 1];
            (api().*setter)(program, location, count, static_cast<const Number*>(data));
        }
    };
    std::visit(set, value);
}

using Shader = Handle<ObjectKind::shader>;

std::string describe(const Defines& defines) {
    std::string text;
    for (const auto& [name, value] : defines.list)
        text += (text.empty() ? "" : " ") + name + '=' + value;
    return text.empty() ? "no defines" : "defines " + text;
}

// Returns an object's log. `get`, `get_log`: OpenGL's queries for shaders or for programs.
std::string log_of(unsigned object, PFNGLGETSHADERIVPROC get, PFNGLGETSHADERINFOLOGPROC get_log) {
    GLint length = 0;
    get(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    get_log(object, length, &length, log.data());
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
             readable_log(log_of(shader.id(), api().GetShaderiv, api().GetShaderInfoLog), source),
             describe(source.defines));
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

GLenum stage_of(const ShaderSource& source) {
    if (source.name.ends_with(".vert")) return GL_VERTEX_SHADER;
    if (source.name.ends_with(".frag")) return GL_FRAGMENT_SHADER;
    if (source.name.ends_with(".comp")) return GL_COMPUTE_SHADER;
    fail("shader {}: expected a name that ends in .vert, .frag or .comp", source.name);
}

std::string names_of(const ShaderSources& sources) {
    std::string names;
    for (const ShaderSource& source : sources) names += (names.empty() ? "" : " + ") + source.name;
    return names;
}

}  // namespace

std::optional<std::string> find_shader(const std::string& name) {
    if (auto text = find_in_override(name)) return text;
    for (const EmbeddedFile& shader : embedded_shaders()) {
        if (shader.name == name) return std::string(shader.text);
    }
    return std::nullopt;
}

Defines& Defines::set(std::string name, std::string value) {
    list.emplace_back(std::move(name), std::move(value));
    return *this;
}

Defines& Defines::set(std::string name, int value) {
    return set(std::move(name), std::to_string(value));
}

ShaderSource compose_shader(const std::string& name, const Defines& defines) {
    return compose_shader(name, defines, find_shader);
}

ShaderSource compose_shader(const std::string& name, const Defines& defines,
                            const ShaderFinder& find) {
    ShaderSource source{name, {}, defines, {}};
    Composer{find, source}.append_main();
    return source;
}

std::string readable_log(const std::string& log, const ShaderSource& source) {
    // Mesa: "0:12(3): error: ...", NVIDIA: "0(12) : error ...", else "ERROR: 0:12: ...".
    static const std::regex place(
        "^(?:ERROR: |WARNING: )?\\d+[:(](\\d{1,8})(?:\\(\\d+\\)|\\))?\\s*:\\s*");
    std::string text;
    std::istringstream lines(log);
    std::string line;
    while (std::getline(lines, line)) {
        std::smatch match;
        if (std::regex_search(line, match, place)) {
            const std::size_t number = std::stoul(match[1]);
            if (number >= 1 && number <= source.lines.size()) {
                const ShaderLine& origin = source.lines[number - 1];
                line = fmt::format("{}:{}: {}", origin.file, origin.number, match.suffix().str());
            }
        }
        text += line + ' ';
    }
    return one_line(text);
}

LinkedProgram::LinkedProgram(const ShaderSources& sources)
    : handle_(api().CreateProgram()), names_(names_of(sources)) {
    const Stage compiling("compile");
    std::vector<Shader> shaders;
    for (const ShaderSource& source : sources) {
        texts_.push_back(source.text);
        shaders.push_back(compile(stage_of(source), source));
        api().AttachShader(id(), shaders.back().id());
    }
    api().LinkProgram(id());
    for (const Shader& shader : shaders) api().DetachShader(id(), shader.id());
    GLint linked = GL_FALSE;
    api().GetProgramiv(id(), GL_LINK_STATUS, &linked);
    if (!linked) {
        fail("shaders {} do not link: {} ({})", names_,
             one_line(log_of(id(), api().GetProgramiv, api().GetProgramInfoLog)),
             describe(sources.back().defines));
    }
    check("making the program " + names_);
}

bool LinkedProgram::is_of(const ShaderSources& sources) const {
    return std::ranges::equal(texts_, sources, {}, {}, &ShaderSource::text) &&
           names_ == names_of(sources);
}

int LinkedProgram::location(std::string_view name) {
    const auto known = locations_.find(name);
    if (known != locations_.end()) return known->second;
    const std::string owned(name);
    const int found = api().GetUniformLocation(id(), owned.c_str());
    const std::string_view base = name.substr(0, name.find_first_of(".["));
    const auto has_name = [&](const std::string& text) { return mentions(text, base); };
    if (found < 0 && std::ranges::none_of(texts_, has_name))
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
        std::visit([](auto& kept) { kept.assign(kept.size(), {}); }, value);
        upload(id(), location, value);
    }
    for (const auto& [location, value] : values) set(location, value);
}

ProgramCache::~ProgramCache() {
    for (const auto& program : programs_) program->abandon();
}

std::shared_ptr<LinkedProgram> ProgramCache::get(const ShaderSources& sources) {
    const auto found = std::ranges::find_if(
        programs_, [&](const auto& program) { return program->is_of(sources); });
    if (found != programs_.end()) {
        programs_.splice(programs_.begin(), programs_, found);
        return programs_.front();
    }
    programs_.push_front(std::make_shared<LinkedProgram>(sources));
    ++compiled_;
    if (programs_.size() > most_programs) programs_.pop_back();
    return programs_.front();
}

Program::Program(const std::string& vertex_name, const std::string& fragment_name,
                 const Defines& defines)
    : Program(ShaderSources{compose_shader(vertex_name, defines),
                            compose_shader(fragment_name, defines)}) {}

Program::Program(const std::string& compute_name, const Defines& defines)
    : Program(ShaderSources{compose_shader(compute_name, defines)}) {}

Program::Program(const ShaderSources& sources)
    : linked_(current_context()->programs().get(sources)),
      user_(current_context()->programs().new_user()) {}

void Program::use() const {
    if (!linked_->belongs_to(user_)) linked_->give_to(user_, values_);
    api().UseProgram(id());
}

void Program::dispatch(int columns, int rows) const {
    use();
    api().DispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>(rows), 1);
    api().MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace lamina::gl
