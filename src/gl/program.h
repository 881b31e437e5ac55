// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/input_file.h"
#include "gl/api.h"

namespace lamina::gl {

// Lists the embedded files of shaders/, relative to it, by name (cmake/EmbedFiles.cmake).
std::span<const EmbeddedFile> embedded_shaders();

// Returns the text of shader file `name`, or nothing. A file in the folder that the environment
// variable LAMINA_SHADER_DIR names goes first, so that shaders can be edited without a build.
std::optional<std::string> find_shader(const std::string& name);

// The definitions that specialise a shader: `#define NAME VALUE` lines, in this order.
struct Defines {
    std::vector<std::pair<std::string, std::string>> list;

    Defines& set(std::string name, std::string value);
    Defines& set(std::string name, int value);

    friend bool operator==(const Defines&, const Defines&) = default;
};

// A function that returns the text of a shader file, or nothing if there is none.
using ShaderFinder = std::function<std::optional<std::string>(const std::string& name)>;

// The origin of a line of a composed shader.
struct ShaderLine {
    std::string file;
    int number;
};

// A composed shader, as compose_shader() returns it.
struct ShaderSource {
    std::string name;
    std::string text;
    Defines defines;
    // The origin of every line of `text`: Mesa loses the files of #line directives in messages.
    std::vector<ShaderLine> lines;
};

// Composes the shader `name`. Its first directive must be `#version 450 core`; a pragma and the
// defines follow it. A line `#include "compositing/over.glsl"` is replaced by that file (named from
// the root of shaders/) unless the compiler has seen it already. Throws Error, which names file and
// line, if a file is missing, includes form a cycle, or an include is malformed.
ShaderSource compose_shader(const std::string& name, const Defines& defines = {});
ShaderSource compose_shader(const std::string& name, const Defines& defines,
                            const ShaderFinder& find);

// Returns a compiler's log on one line, with places in shader files: "slicing/slab.frag:12: ...".
std::string readable_log(const std::string& log, const ShaderSource& source);

// The values of a uniform or of an array of them. An int is also a sampler's texture unit.
using UniformValue =
    std::variant<std::vector<float>, std::vector<glm::vec2>, std::vector<glm::vec3>,
                 std::vector<glm::vec4>, std::vector<glm::mat4>, std::vector<double>,
                 std::vector<glm::dvec2>, std::vector<glm::dvec3>, std::vector<glm::dvec4>,
                 std::vector<int>, std::vector<glm::ivec2>, std::vector<glm::ivec3>>;

// The shaders of a program: a vertex and a fragment shader, or a compute shader. The ending of a
// name says which it is: .vert, .frag or .comp.
using ShaderSources = std::vector<ShaderSource>;

// Linked shaders, shared by all Program objects of a context that have the same source text. OpenGL
// holds the uniform values of one of these Programs at a time, the user.
class LinkedProgram {
  public:
    // Throws Error with the shader's name, file, line and defines if it does not compile or link.
    explicit LinkedProgram(const ShaderSources& sources);

    bool is_of(const ShaderSources& sources) const;
    // Returns a uniform's location, or -1 if the source names the uniform but this specialisation
    // does not use it. Throws Error for a name that is nowhere in the source.
    int location(std::string_view name);
    void set(int location, const UniformValue& value);
    // Makes Program `user` the user: sets its uniform `values`, and 0 for those it has not set.
    void give_to(std::uint64_t user, const std::map<int, UniformValue>& values);
    bool belongs_to(std::uint64_t user) const { return user_ == user; }

    unsigned id() const { return handle_.id(); }
    // Gives the program up without deleting it: the end of its context deletes it.
    void abandon() { handle_.release(); }

  private:
    Handle<ObjectKind::program> handle_;
    std::string names_;               // names of the shaders, for messages
    std::vector<std::string> texts_;  // also tell an unused uniform from a misspelt one
    std::map<std::string, int, std::less<>> locations_;
    std::map<int, UniformValue> values_;  // values that OpenGL has, by location
    std::uint64_t user_ = 0;              // the user whose values these are; 0: none
};

// The linked programs that a context has used lately: none of them is compiled again.
class ProgramCache {
  public:
    static constexpr std::size_t most_programs = 64;

    ProgramCache() = default;
    ~ProgramCache();  // abandons the programs
    ProgramCache(const ProgramCache&) = delete;
    ProgramCache& operator=(const ProgramCache&) = delete;

    // Returns the program of these sources, and compiles it if it is not cached. Beyond
    // most_programs, the one that was asked for longest ago is dropped.
    std::shared_ptr<LinkedProgram> get(const ShaderSources& sources);
    std::uint64_t new_user() { return ++last_user_; }

    int compiled() const { return compiled_; }  // programs compiled so far

  private:
    std::list<std::shared_ptr<LinkedProgram>> programs_;  // the last used one first
    std::uint64_t last_user_ = 0;
    int compiled_ = 0;
};

// Linked shaders with uniforms of their own, 0 at first. Throws Error with the shader's name, file,
// line and defines if one does not compile or link.
class Program {
  public:
    // `vertex_name`, `fragment_name`: files in shaders/. Both are specialised by the same defines.
    Program(const std::string& vertex_name, const std::string& fragment_name,
            const Defines& defines = {});
    // `compute_name`: a file in shaders/.
    explicit Program(const std::string& compute_name, const Defines& defines = {});
    explicit Program(const ShaderSources& sources);

    // Makes this the program of the draws that follow, with its uniforms.
    void use() const;
    // Runs `columns` times `rows` workgroups of a compute shader, at most 65535 each. Later
    // dispatches see what it writes to storage blocks, and so does Buffer::read().
    void dispatch(int columns, int rows = 1) const;

    // Set a uniform, or an array; the program need not be in use. A uniform of the source that this
    // specialisation does not use is ignored. Throw Error for a name that is not in the source.
    template <typename Value>
    void set(std::string_view name, const Value& value) {
        if constexpr (std::is_enum_v<Value>)
            set(name, int{value});  // a texture unit
        else
            set(name, std::span<const Value>(&value, 1));
    }
    template <typename Value>
    void set(std::string_view name, std::span<const Value> values) {
        const int location = linked_->location(name);
        if (location < 0) return;
        UniformValue& value = values_[location];
        if (!std::holds_alternative<std::vector<Value>>(value)) value.emplace<std::vector<Value>>();
        std::get<std::vector<Value>>(value).assign(values.begin(), values.end());
        if (linked_->belongs_to(user_)) linked_->set(location, value);
    }

    unsigned id() const { return linked_->id(); }

  private:
    std::shared_ptr<LinkedProgram> linked_;
    std::uint64_t user_;  // this one's number among the linked program's users
    std::map<int, UniformValue> values_;
};

}  // namespace lamina::gl
