// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamina::gl {

// The definitions that specialise a shader: `#define NAME VALUE` lines, in this order.
struct Defines {
    std::vector<std::pair<std::string, std::string>> list;

    Defines& set(std::string name, std::string value);
    Defines& set(std::string name, int value);

    friend bool operator==(const Defines&, const Defines&) = default;
};

// The text of a shader file, or nothing where there is none.
using ShaderFinder = std::function<std::optional<std::string>(const std::string& name)>;

// Where a line of a composed shader comes from.
struct ShaderLine {
    std::string file;
    int number;
};

// A shader ready for the compiler.
struct ShaderSource {
    std::string name;
    std::string text;
    Defines defines;
    // The origin of every line of `text`. #line directives would not do: Mesa loses their file
    // number in some of its messages.
    std::vector<ShaderLine> lines;
};

// Composes the shader `name`. Its first directive must be `#version 450 core`; a pragma
// and the defines are inserted after it. A line `#include "compositing/over.glsl"`, which may be
// under an #if, is replaced by that file (named from the root of shaders/), unless the compiler has
// already seen it. Throws Error, which names file and line, where a file is missing, includes form
// a cycle, or an include is malformed.
ShaderSource compose_shader(const std::string& name, const Defines& defines = {});
ShaderSource compose_shader(const std::string& name, const Defines& defines,
                            const ShaderFinder& find);

// A compiler's log as one line, in which positions refer to the files instead of the composed text:
// "slicing/slab.frag:12: ...".
std::string readable_log(const std::string& log, const ShaderSource& source);

}  // namespace lamina::gl
